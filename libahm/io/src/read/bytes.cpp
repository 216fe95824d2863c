#include "read/bytes.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include "ahm/error.hpp"

namespace ahm::io {
namespace {

constexpr std::uint64_t unbounded = std::numeric_limits<std::uint64_t>::max();

std::uint64_t difference(std::uint64_t limit, std::uint64_t used) { return limit - std::min(limit, used); }

/// The first number in a file of the operating system; nullopt if there is none.
std::optional<std::uint64_t> number_in(const char* path) {
  std::ifstream file(path);
  std::uint64_t number = 0;
  if (file >> number) return number;
  return std::nullopt;
}

std::uint64_t free_in_machine() {
  std::ifstream file("/proc/meminfo");
  std::string name, unit;
  for (std::uint64_t kilobytes = 0; file >> name >> kilobytes; std::getline(file, unit))
    if (name == "MemAvailable:") return kilobytes * 1024;
  const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
  return pages > 0 && size > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size) : unbounded;
}

std::uint64_t free_in_control_group() {
  const auto limit = number_in("/sys/fs/cgroup/memory.max"), used = number_in("/sys/fs/cgroup/memory.current");
  return limit && used ? difference(*limit, *used) : unbounded;
}

std::uint64_t free_in_address_space() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unbounded;
  const long size = ::sysconf(_SC_PAGESIZE);
  return difference(limit.rlim_cur, number_in("/proc/self/statm").value_or(0) * static_cast<std::uint64_t>(size));
}

}  // namespace

std::uint64_t free_memory() { return std::min({free_in_machine(), free_in_control_group(), free_in_address_space()}); }

namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
  throw IoError("cannot read " + quoted_path(path) + ": " + what);
}

std::string reason(int error) { return std::generic_category().message(error); }

}  // namespace

RegularFile::RegularFile(const std::filesystem::path& path) : RegularFile() {  // delegates for cleanup
  path_ = path;
  // Non-blocking: opening a named pipe without a writer would otherwise wait.
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat info {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &info) != 0) refuse(path, reason(errno));
  if (S_ISDIR(info.st_mode)) refuse(path, "it is a folder, not a file");
  if (!S_ISREG(info.st_mode)) refuse(path, "not a regular file (a pipe or device); copy its contents to a file first");
  if (info.st_size == 0) refuse(path, "the file is empty (0 bytes)");
  size_ = static_cast<std::uint64_t>(info.st_size);
}

RegularFile RegularFile::without_name(const std::filesystem::path& folder) {
  RegularFile file;
  file.path_ = folder;
  std::string name = (folder / "points.XXXXXX").string();
  file.descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (file.descriptor_ < 0 || ::unlink(name.c_str()) != 0)
    throw IoError("cannot write a file in " + quoted_path(folder) + ": " + reason(errno));
  return file;
}

RegularFile::~RegularFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

RegularFile::RegularFile(RegularFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}

std::size_t RegularFile::read(std::uint64_t position, std::span<char> room) const {
  std::size_t done = 0;
  while (done < room.size()) {
    const ssize_t got =
        ::pread(descriptor_, room.data() + done, room.size() - done, static_cast<off_t>(position + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(path_, reason(errno));
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

void RegularFile::append(std::span<const char> bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(size_));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) throw IoError("cannot write a file in " + quoted_path(path_) + ": " + reason(errno));
    size_ += static_cast<std::uint64_t>(put);
    bytes = bytes.subspan(static_cast<std::size_t>(put));
  }
}

namespace {

constexpr std::size_t block = std::size_t{1} << 18, longest_head = std::size_t{1} << 20;

}  // namespace

ByteStream::ByteStream(const std::filesystem::path& path) : file_(std::make_shared<RegularFile>(path)) {
  auto head = std::make_shared<Input>(Input{path, {}});
  head_ = head;
  head->bytes.resize(std::min<std::uint64_t>(file_->size(), longest_head));
  head->bytes.resize(file_->read(0, head->bytes));
  head->beyond = file_->size() - head->bytes.size();
  check_gzip_name(*head);
  is_packed_ = is_gzip(*head);
  begin();
  const auto check_text = [&] {
    if (is_utf16(head->bytes))
      fail(*head, "it is text in UTF-16, which is not read block by block; convert it with iconv -f UTF-16 -t UTF-8");
  };
  if (!is_packed_) {
    check_text();
    return;
  }
  std::string bytes(longest_head, '\0');
  bytes.resize(read(bytes));
  std::string more(block, '\0');
  head->beyond = 0;
  while (const std::size_t count = read(more)) head->beyond += count;
  head->bytes = std::move(bytes);
  if (head->bytes.empty()) fail(*head, "the file is empty (0 bytes) when unpacked");
  check_text();
  begin();
}

ByteStream::ByteStream(const ByteStream& other, std::uint64_t position)
    : file_(other.file_), head_(other.head_), is_packed_(other.is_packed_) {
  begin();
  skip(position);
}

void ByteStream::begin() {
  position_ = 0;
  if (!is_packed_) return;
  block_.resize(block);
  gunzip_ = std::make_unique<Gunzip>(*head_, [this] {
    const std::size_t count = file_->read(position_, block_);
    position_ += count;
    return std::string_view(block_).substr(0, count);
  });
}

std::size_t ByteStream::read(std::span<char> room) {
  if (gunzip_) return gunzip_->read(room);
  const std::size_t count = file_->read(position_, room);
  position_ += count;
  return count;
}

void ByteStream::skip(std::uint64_t bytes) {
  if (!gunzip_) {
    position_ += bytes;
    return;
  }
  std::string room(block, '\0');
  while (bytes > 0) {
    const std::size_t count = read(std::span(room).first(std::min<std::uint64_t>(bytes, block)));
    if (count == 0) return;
    bytes -= count;
  }
}

}  // namespace ahm::io
