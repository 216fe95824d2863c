/// \file
/// LZF, which compresses the points of PCD files: literal bytes, and repetitions of what stood at most 8 KB before.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "read/byte_stream.hpp"

namespace ahm::io {

/// What compressed data stands for, in blocks.
class LzfStream {
 public:
  /// @param begin  of the data in the file, which has `packed` bytes there that stand for `plain` bytes
  LzfStream(const ByteStream& file, std::uint64_t begin, std::uint64_t packed, std::uint64_t plain);

  /// Fills room with the next bytes. @throws IoError where the data is damaged
  void read(std::span<char> room);
  /// Passes over so many bytes.
  void skip(std::uint64_t bytes);
  /// That the data ends here as it should. @throws IoError
  void finish();

 private:
  bool unpack();
  unsigned char next();
  [[noreturn]] void damaged() const;

  ByteStream file_;
  std::string packed_, plain_;              ///< blocks
  std::size_t at_packed_ = 0, at_ = 0;      ///< in them
  std::uint64_t packed_left_, plain_left_;  ///< bytes that are not in the blocks yet
};

}  // namespace ahm::io
