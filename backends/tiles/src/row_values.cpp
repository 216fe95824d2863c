#include "row_values.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include "ahm/error.hpp"

static_assert(std::endian::native == std::endian::little, "NumPy files are read without conversion of the byte order");

namespace ahm::tiles {
namespace {

/// The text of the header's dictionary after a key; empty if there is no such key.
std::string_view after(std::string_view header, std::string_view key) {
  const auto at = header.find(key);
  if (at == std::string_view::npos) return {};
  header.remove_prefix(at + key.size());
  header.remove_prefix(std::min(header.size(), header.find_first_not_of(": ")));
  return header;
}

/// Reads the length from a one-dimensional shape such as (5,). @return whether the shape has one dimension
bool read_length(std::string_view shape, std::size_t& length) {
  if (!shape.starts_with('(')) return false;
  const auto [end, error] = std::from_chars(shape.data() + 1, shape.data() + shape.size(), length);
  return error == std::errc() && std::string_view(end, shape.data() + shape.size()).starts_with(",)");
}

}  // namespace

RowValues::RowValues(const std::filesystem::path& path) {
  const auto fail = [&](const std::string& what) { throw IoError("cannot read '" + path.string() + "': " + what); };
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail(std::generic_category().message(errno));
  struct stat info {};
  const bool is_file = ::fstat(file, &info) == 0 && S_ISREG(info.st_mode);
  bytes_ = is_file ? static_cast<std::size_t>(info.st_size) : 0;
  void* data = bytes_ > 0 ? ::mmap(nullptr, bytes_, PROT_READ, MAP_SHARED, file, 0) : MAP_FAILED;
  ::close(file);
  if (data == MAP_FAILED) fail("it is not a .npy file");
  data_ = data;
  try {
    // Format: magic, version, length of the header (2 bytes; 4 from version 2), a dictionary in Python syntax, the values.
    const std::string_view all(static_cast<const char*>(data), bytes_);
    if (!all.starts_with("\x93NUMPY") || bytes_ < 12) fail("it is not a .npy file");
    const std::size_t digits = all[6] == 1 ? 2 : 4;
    std::uint32_t length = 0;
    std::memcpy(&length, all.data() + 8, digits);
    begin_ = 8 + digits + length;
    if (begin_ > bytes_) fail("it is truncated");
    const std::string_view header = all.substr(8 + digits, length);
    if (!after(header, "'descr'").starts_with("'<f8'")) fail("its values are not float64");
    if (!read_length(after(header, "'shape'"), size_)) fail("it does not have exactly one dimension");
    if (size_ > (bytes_ - begin_) / sizeof(double)) fail("it is truncated");
  } catch (...) {
    ::munmap(data_, bytes_);
    throw;
  }
}

RowValues::~RowValues() {
  if (data_) ::munmap(data_, bytes_);
}

RowValues::RowValues(RowValues&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), bytes_(other.bytes_), begin_(other.begin_), size_(other.size_) {}

double RowValues::operator[](std::size_t row) const {
  double value = 0;
  std::memcpy(&value, static_cast<const char*>(data_) + begin_ + row * sizeof(double), sizeof(double));
  return value;
}

}  // namespace ahm::tiles
