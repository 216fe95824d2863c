/// \file
/// Free memory, and reading of regular files in blocks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "read/gunzip.hpp"
#include "read/input.hpp"

namespace ahm::io {

/// Memory that this process can still use, bytes: the minimum of the free memory of the machine, the limit of its control group, and
/// the limit of its address space.
std::uint64_t free_memory();
/// Limit for an input of unknown size, bytes: a third of the free memory. See `fail_too_large`.
inline std::uint64_t room_for_input() { return free_memory() / 3; }

/// An open file. The destructor closes it.
class RegularFile {
 public:
  /// Opens a file for reading. @throws IoError with the system's reason, or for pipes, devices and empty files
  explicit RegularFile(const std::filesystem::path& path);
  /// Creates an empty file without a name on the disk of a folder. The file disappears when the process ends. @throws IoError
  static RegularFile without_name(const std::filesystem::path& folder);
  ~RegularFile();
  RegularFile(RegularFile&& other) noexcept;
  RegularFile& operator=(RegularFile&&) = delete;

  /// Size when the file was opened plus the size of appended data, bytes.
  std::uint64_t size() const noexcept { return size_; }
  /// Fills `room` with the bytes from `position` on. @return number of bytes read, less only at the end of the file
  /// @throws IoError
  std::size_t read(std::uint64_t position, std::span<char> room) const;
  /// Appends bytes. @throws IoError if the disk is full
  void append(std::span<const char> bytes);

 private:
  RegularFile() = default;

  std::filesystem::path path_;            ///< the file, or the folder of a file without a name
  [[maybe_unused]] int descriptor_ = -1;  ///< not used by files in memory
  std::uint64_t size_ = 0;
};

/// Reads a file from beginning to end, and unpacks it if it is compressed with gzip, independently of its name.
class ByteStream {
 public:
  /// Reads the beginning of the file, which is long enough for any header. Unpacks a compressed file once to determine its size.
  /// @throws IoError as `load`
  explicit ByteStream(const std::filesystem::path& path);
  /// Reads the same file as `other`, from the byte `position` on.
  ByteStream(const ByteStream& other, std::uint64_t position);
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// The beginning of the file.
  const Input& head() const noexcept { return *head_; }
  bool is_packed() const noexcept { return is_packed_; }
  /// Fills `room` with the next bytes. @return their number, less than the size of `room` only at the end
  std::size_t read(std::span<char> room);
  /// Skips bytes.
  void skip(std::uint64_t bytes);

 private:
  void begin();

  std::shared_ptr<const RegularFile> file_;
  std::shared_ptr<const Input> head_;
  bool is_packed_ = false;
  std::uint64_t position_ = 0;  ///< position in the (compressed) file
  std::string block_;           ///< block of a compressed file
  std::unique_ptr<Gunzip> gunzip_;
};

}  // namespace ahm::io
