/// \file
/// What zlib compresses: files with gzip, and blocks within files.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "read/input.hpp"

namespace ahm::io {

bool is_gzip(const Input& in);

/// What a gzip file holds, all members one after the other, in blocks.
class Gunzip {
 public:
  /// @param more  the next bytes of the file, valid until it is called again; none at the end
  /// @throws IoError where this build is without zlib
  Gunzip(const Input& in, std::function<std::string_view()> more);
  ~Gunzip();
  Gunzip(const Gunzip&) = delete;
  Gunzip& operator=(const Gunzip&) = delete;

  /// Fills room. @return how many bytes there were; fewer than fit only at the end
  /// @throws IoError when the data is cut short or damaged
  std::size_t read(std::span<char> room);

 private:
  class Inflater;
  std::unique_ptr<Inflater> inflater_;
};

/// Puts what a gzip file holds in its place, all members one after the other.
/// @throws IoError when the data is cut short or damaged, or this build is without zlib
/// @throws ResourceExhausted when it would fill more than a third of the memory that is free
void gunzip(Input& in);

/// Unpacks one block of zlib's own format, which fills `room` exactly.
/// @param what  what the block is a part of, for messages
/// @throws IoError when it does not, or this build is without zlib
void inflate_block(const Input& in, std::string_view packed, std::span<char> room, const std::string& what);

}  // namespace ahm::io
