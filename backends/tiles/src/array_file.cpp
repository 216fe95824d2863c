#include "ahm/tiles/array_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"

namespace ahm::tiles {
namespace {

constexpr std::size_t alignment = 64, most_arrays = 64;
constexpr std::array<char, 8> magic{'A', 'H', 'M', 'T', 'I', 'L', 'E', 'S'};
constexpr std::uint32_t order_mark = 0x01020304;

using Name = std::array<char, 16>;

struct Header {
  std::array<char, 8> magic;
  std::uint32_t version, order;
  Name kind;
  std::uint64_t arrays, size;
  std::uint64_t unused;
  std::uint64_t checksum;  ///< checksum of the preceding header fields and the table
};
static_assert(sizeof(Header) == 64);

struct Entry {
  Name name;
  std::uint64_t element, place, bytes, checksum;
};
static_assert(sizeof(Entry) == 48);

Name name_of(std::string_view text) {
  if (text.size() >= Name().size()) throw InvalidArgument("the name '" + std::string(text) + "' is too long");
  Name name{};
  std::copy(text.begin(), text.end(), name.begin());
  return name;
}

std::size_t padded(std::size_t bytes) { return (bytes + alignment - 1) / alignment * alignment; }

std::uint64_t checksum_of(const Header& header, std::span<const Entry> table) {
  const std::uint64_t parts[] = {XXH3_64bits(&header, offsetof(Header, checksum)),
                                 XXH3_64bits(table.data(), table.size_bytes())};
  return XXH3_64bits(parts, sizeof(parts));
}

std::string_view text(const void* bytes, std::size_t size) { return {static_cast<const char*>(bytes), size}; }

}  // namespace

std::uint64_t checksum(std::span<const std::byte> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

void write_arrays(const std::filesystem::path& path, std::string_view kind, const std::vector<NamedArray>& arrays) {
  if (arrays.size() > most_arrays) throw InvalidArgument("at most 64 arrays fit into a file");
  std::vector<Entry> table;
  std::size_t place = padded(sizeof(Header) + arrays.size() * sizeof(Entry));
  for (const NamedArray& a : arrays) {
    table.push_back({name_of(a.name), a.element, place, a.bytes.size(), checksum(a.bytes)});
    place += padded(a.bytes.size());
  }
  Header header{magic, format_version, order_mark, name_of(kind), arrays.size(), place, 0, 0};
  header.checksum = checksum_of(header, table);

  static constexpr std::array<char, alignment> zeros{};
  io::AtomicFile file(path);
  const auto pad = [&](std::size_t bytes) { file.write({zeros.data(), padded(bytes) - bytes}); };
  file.write(text(&header, sizeof(header)));
  file.write(text(table.data(), table.size() * sizeof(Entry)));
  pad(sizeof(header) + table.size() * sizeof(Entry));
  for (const NamedArray& a : arrays) {
    file.write(text(a.bytes.data(), a.bytes.size()));
    pad(a.bytes.size());
  }
  file.commit();
}

ArrayFile::ArrayFile(const std::filesystem::path& path, std::string_view kind) : path_(path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail(std::generic_category().message(errno));
  struct stat info {};
  if (::fstat(file, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size < static_cast<off_t>(sizeof(Header))) {
    ::close(file);
    fail("it is truncated, or not a file of tiles");
  }
  size_ = static_cast<std::size_t>(info.st_size);
  void* data = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, file, 0);
  const int error = errno;
  ::close(file);
  if (data == MAP_FAILED) fail(std::generic_category().message(error));
  data_ = static_cast<const std::byte*>(data);
  try {
    check_header(kind);
  } catch (...) {
    unmap();
    throw;
  }
}

ArrayFile::~ArrayFile() { unmap(); }

ArrayFile::ArrayFile(ArrayFile&& other) noexcept
    : path_(std::move(other.path_)),
      data_(std::exchange(other.data_, nullptr)),
      size_(other.size_),
      verified_(other.verified_) {}

ArrayFile& ArrayFile::operator=(ArrayFile&& other) noexcept {
  if (this == &other) return *this;
  unmap();
  path_ = std::move(other.path_);
  data_ = std::exchange(other.data_, nullptr);
  size_ = other.size_;
  verified_ = other.verified_;
  return *this;
}

void ArrayFile::unmap() noexcept {
  if (data_) ::munmap(const_cast<std::byte*>(data_), size_);
  data_ = nullptr;
}

void ArrayFile::release() const noexcept { ::madvise(const_cast<std::byte*>(data_), size_, MADV_DONTNEED); }

void ArrayFile::fail(const std::string& what) const { throw IoError("cannot read '" + path_.string() + "': " + what); }

void ArrayFile::check_header(std::string_view kind) const {
  Header header;
  std::memcpy(&header, data_, sizeof(header));
  if (header.magic != magic) fail("it is not a file of tiles");
  if (header.order != order_mark)
    fail("it was written on a machine with another byte order; build the tiles on this machine");
  if (header.version != format_version)
    fail("its version is " + std::to_string(header.version) + ", and this program requires " +
         std::to_string(format_version) + "; build the tiles again");
  if (header.size != size_) fail("it is truncated; remove its folder and make it again");
  if (header.arrays > most_arrays || sizeof(Header) + header.arrays * sizeof(Entry) > size_)
    fail("its header is damaged; remove its folder and make it again");
  const std::span table(reinterpret_cast<const Entry*>(data_ + sizeof(Header)), header.arrays);
  if (header.checksum != checksum_of(header, table)) fail("its header is damaged; remove its folder and make it again");
  if (header.kind != name_of(kind)) fail("it does not contain " + std::string(kind));
  for (const Entry& entry : table)
    if (entry.place > size_ || entry.bytes > size_ - entry.place)
      fail("its header is damaged; remove its folder and make it again");
}

/// Index of an array in the table; the number of arrays if there is no such array.
std::size_t ArrayFile::place_of(std::string_view name) const {
  Header header;
  std::memcpy(&header, data_, sizeof(header));
  const std::span table(reinterpret_cast<const Entry*>(data_ + sizeof(Header)), header.arrays);
  const Name wanted = name_of(name);
  return static_cast<std::size_t>(std::ranges::find(table, wanted, &Entry::name) - table.begin());
}

bool ArrayFile::has(std::string_view name) const {
  Header header;
  std::memcpy(&header, data_, sizeof(header));
  return place_of(name) < header.arrays;
}

std::span<const std::byte> ArrayFile::find(std::string_view name, std::size_t element) const {
  if (!has(name)) fail("it has no array '" + std::string(name) + "'");
  const std::size_t k = place_of(name);
  const Entry& entry = reinterpret_cast<const Entry*>(data_ + sizeof(Header))[k];
  if (entry.element != element) fail("array '" + std::string(name) + "' has elements of another size");
  const std::span bytes(data_ + entry.place, entry.bytes);
  if (!(verified_ >> k & 1) && checksum(bytes) != entry.checksum)
    fail("array '" + std::string(name) + "' is damaged (its checksum is wrong); remove its folder and make it again");
  verified_ |= std::uint64_t{1} << k;
  return bytes;
}

}  // namespace ahm::tiles
