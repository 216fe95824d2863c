/// \file
/// Files of named arrays with checksums, memory-mapped. All data of tiles have this format.
///
/// \code
/// ahm::tiles::write_arrays("a.ahm", "example", {ahm::tiles::array("lengths", lengths)});
/// const ahm::tiles::ArrayFile file("a.ahm", "example");
/// for (double length : file.get<double>("lengths")) std::cout << length << '\n';
/// \endcode
///
/// A file consists of a header of 64 bytes, a table of 48 bytes per array, and the arrays. Each array starts at a multiple of 64 bytes.
/// The byte order is that of the machine. Header: magic "AHMTILES", version, byte order mark, kind (16 characters), number of arrays,
/// size of the file, checksum of header and table. Table: name (16 characters), bytes per element, offset, bytes, checksum. Checksums
/// are 64-bit XXH3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace ahm::tiles {

/// Version of the file format. Files of other versions are errors.
inline constexpr std::uint32_t format_version = 1;

/// An array for `write_arrays`.
struct NamedArray {
  std::string_view name;  ///< at most 15 characters
  std::size_t element;    ///< bytes per element
  std::span<const std::byte> bytes;
};

/// A view of values as a named array. The values must outlive it.
template <class T>
NamedArray array(std::string_view name, std::span<const T> values) {
  static_assert(std::is_trivially_copyable_v<T>);
  return {name, sizeof(T), std::as_bytes(values)};
}
template <class T>
NamedArray array(std::string_view name, const std::vector<T>& values) {
  return array(name, std::span<const T>(values));
}

/// Writes a file atomically: it is complete or does not exist. @throws IoError, InvalidArgument (more than 64 arrays, a long name)
void write_arrays(const std::filesystem::path& path, std::string_view kind, const std::vector<NamedArray>& arrays);

/// The 64-bit XXH3 checksum of some bytes.
std::uint64_t checksum(std::span<const std::byte> bytes);

/// A file mapped into memory. Views of its arrays are valid during its lifetime.
class ArrayFile {
 public:
  /// @throws IoError (the file is missing, of another kind or version, truncated, or its header is damaged)
  ArrayFile(const std::filesystem::path& path, std::string_view kind);
  ~ArrayFile();
  ArrayFile(ArrayFile&& other) noexcept;
  ArrayFile& operator=(ArrayFile&& other) noexcept;

  /// The array of this name. The first call for an array checks its checksum.
  /// @throws IoError (no such array, elements of another size, damaged bytes)
  template <class T>
  std::span<const T> get(std::string_view name) const {
    const std::span<const std::byte> bytes = find(name, sizeof(T));
    return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
  }
  bool has(std::string_view name) const;
  /// Size of the file, bytes.
  std::size_t size() const noexcept { return size_; }
  const std::filesystem::path& path() const noexcept { return path_; }
  /// Releases the memory of the pages that were read. Views stay valid; the system reads the pages again.
  void release() const noexcept;

 private:
  std::size_t place_of(std::string_view name) const;
  std::span<const std::byte> find(std::string_view name, std::size_t element) const;
  void check_header(std::string_view kind) const;
  void unmap() noexcept;
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path path_;
  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  mutable std::uint64_t verified_ = 0;  ///< one bit per array whose checksum was checked
};

}  // namespace ahm::tiles
