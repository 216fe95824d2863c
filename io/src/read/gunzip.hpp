/// \file
/// What zlib compresses: files with gzip, and blocks within files.
#pragma once

#include <span>
#include <string_view>

#include "read/input.hpp"

namespace ahm::io {

bool is_gzip(const Input& in);

/// Puts what a gzip file holds in its place, all members one after the other.
/// @throws IoError when the data is cut short or damaged, or this build is without zlib
/// @throws ResourceExhausted when it would fill more than a third of the memory that is free
void gunzip(Input& in);

/// Unpacks one block of zlib's own format, which fills `room` exactly.
/// @param what  what the block is a part of, for messages
/// @throws IoError when it does not, or this build is without zlib
void inflate_block(const Input& in, std::string_view packed, std::span<char> room, const std::string& what);

}  // namespace ahm::io
