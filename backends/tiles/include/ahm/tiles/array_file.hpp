/// \file
/// Named arrays in one file, memory-mapped, with checksums: the form of everything on disk.
///
/// \code
/// ahm::tiles::write_arrays("a.ahm", "example", {ahm::tiles::array("lengths", lengths)});
/// const ahm::tiles::ArrayFile file("a.ahm", "example");
/// for (double length : file.get<double>("lengths")) std::cout << length << '\n';
/// \endcode
///
/// A file is a header of 64 bytes, a table of 48 bytes per array, and the arrays, each from a multiple of 64 bytes on, in the
/// byte order of the machine. Header: magic "AHMTILES", version, byte order mark, kind (16 characters), number of arrays,
/// size of the file, checksum of header and table. Table: name (16 characters), bytes per element, place, bytes, checksum. Checksums are
/// XXH3 of 64 bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace ahm::tiles {

/// The version of all files; others are refused.
inline constexpr std::uint32_t format_version = 1;

/// An array to be written.
struct NamedArray {
  std::string_view name;  ///< at most 15 characters
  std::size_t element;    ///< bytes per element
  std::span<const std::byte> bytes;
};

template <class T>
NamedArray array(std::string_view name, std::span<const T> values) {
  static_assert(std::is_trivially_copyable_v<T>);
  return {name, sizeof(T), std::as_bytes(values)};
}
template <class T>
NamedArray array(std::string_view name, const std::vector<T>& values) {
  return array(name, std::span<const T>(values));
}

/// Writes a file that is whole or not there. @throws IoError
void write_arrays(const std::filesystem::path& path, std::string_view kind, const std::vector<NamedArray>& arrays);

/// XXH3 of 64 bits.
std::uint64_t checksum(std::span<const std::byte> bytes);

/// A file mapped into memory. Views into it live as long as it does.
class ArrayFile {
 public:
  /// @throws IoError where the file is missing, is of another kind or version, is cut short, or its header is damaged
  ArrayFile(const std::filesystem::path& path, std::string_view kind);
  ~ArrayFile();
  ArrayFile(ArrayFile&& other) noexcept;
  ArrayFile& operator=(ArrayFile&& other) noexcept;

  /// The array of this name. Its checksum is tested when it is first asked for.
  /// @throws IoError where there is none, its elements are of another size, or its bytes are damaged
  template <class T>
  std::span<const T> get(std::string_view name) const {
    const std::span<const std::byte> bytes = find(name, sizeof(T));
    return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
  }
  bool has(std::string_view name) const;
  /// Bytes of the file.
  std::size_t size() const noexcept { return size_; }
  const std::filesystem::path& path() const noexcept { return path_; }
  /// Gives the memory of what was read back; views stay what they are, and read it again.
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
  mutable std::uint64_t verified_ = 0;  ///< a bit per array
};

}  // namespace ahm::tiles
