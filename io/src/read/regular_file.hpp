/// \file
/// Bytes of a file on disk, wherever they stand in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace ahm::io {

/// An open file; closed where it goes out of scope.
class RegularFile {
 public:
  /// For reading. @throws IoError with the system's reason; pipes, devices and empty files are refused
  explicit RegularFile(const std::filesystem::path& path);
  /// An empty file without a name on the disk of this folder, which is gone however the process ends. @throws IoError
  static RegularFile without_name(const std::filesystem::path& folder);
  ~RegularFile();
  RegularFile(RegularFile&& other) noexcept;
  RegularFile& operator=(RegularFile&&) = delete;

  /// Bytes, when it was opened and with what was appended since.
  std::uint64_t size() const noexcept { return size_; }
  /// Fills room with the bytes from `position` on. @return how many there were @throws IoError
  std::size_t read(std::uint64_t position, std::span<char> room) const;
  /// @throws IoError where the disk is full
  void append(std::span<const char> bytes);

 private:
  RegularFile() = default;

  std::filesystem::path path_;  ///< or the folder
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace ahm::io
