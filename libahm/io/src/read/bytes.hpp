/// \file
/// How much memory there is to take.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "read/gunzip.hpp"
#include "read/input.hpp"

namespace ahm::io {

/// Bytes this process can still fill: what the machine has, its control group allows and the limit of its address space
/// leaves, whichever is least.
std::uint64_t free_memory();
/// How much of that one input whose size is not known before may fill; see `fail_too_large`.
inline std::uint64_t room_for_input() { return free_memory() / 3; }

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

/// Reads a file from its beginning to its end, and unpacks what is compressed with gzip, whatever its name.
class ByteStream {
 public:
  /// Reads as much as headers may take, and what is compressed once, to know its size.
  /// @throws IoError as `load`
  explicit ByteStream(const std::filesystem::path& path);
  /// Of the same file, from this byte on.
  ByteStream(const ByteStream& other, std::uint64_t position);
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// The beginning of the file.
  const Input& head() const noexcept { return *head_; }
  bool is_packed() const noexcept { return is_packed_; }
  /// Fills room with the next bytes. @return how many there were; fewer than fit only at the end
  std::size_t read(std::span<char> room);
  /// Passes over so many bytes.
  void skip(std::uint64_t bytes);

 private:
  void begin();

  std::shared_ptr<const RegularFile> file_;
  std::shared_ptr<const Input> head_;
  bool is_packed_ = false;
  std::uint64_t position_ = 0;  ///< in the file
  std::string block_;           ///< of what is packed
  std::unique_ptr<Gunzip> gunzip_;
};

}  // namespace ahm::io
