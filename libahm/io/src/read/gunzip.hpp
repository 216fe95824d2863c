/// \file
/// Decompression with zlib: gzip files, and blocks within files.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "read/input.hpp"

namespace ahm::io {

bool is_gzip(const Input& in);

/// Unpacks a gzip file in blocks; concatenates its members.
class Gunzip {
 public:
  /// @param more  returns the next bytes of the file, valid until its next call; empty at the end
  /// @throws IoError if this build has no zlib
  Gunzip(const Input& in, std::function<std::string_view()> more);
  ~Gunzip();
  Gunzip(const Gunzip&) = delete;
  Gunzip& operator=(const Gunzip&) = delete;

  /// Fills `room` with unpacked bytes. @return their number, less than the size of `room` only at the end
  /// @throws IoError when the data is truncated or damaged
  std::size_t read(std::span<char> room);

 private:
  class Inflater;
  std::unique_ptr<Inflater> inflater_;
};

/// Replaces the bytes of a gzip file by its unpacked contents; concatenates its members.
/// @throws IoError when the data is truncated or damaged, or this build has no zlib
/// @throws ResourceExhausted when the contents would use more than a third of the free memory
void gunzip(Input& in);

/// Unpacks one block in zlib format.
/// @param what  name of the data that contains the block, for messages
/// @throws IoError when the contents do not fill `room` exactly, or this build has no zlib
void inflate_block(const Input& in, std::string_view packed, std::span<char> room, const std::string& what);

}  // namespace ahm::io
