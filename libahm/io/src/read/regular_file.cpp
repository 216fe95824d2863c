// Free memory, and regular files, from the operating system. With AHM_WITH_FILES=OFF, memory_files.cpp replaces this file.
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
#include "read/bytes.hpp"

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

}  // namespace ahm::io
