/// \file
/// The bytes of a file that need not fit into memory.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "read/gunzip.hpp"
#include "read/input.hpp"
#include "read/regular_file.hpp"

namespace ahm::io {

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
