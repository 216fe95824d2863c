/// \file
/// Arrays of VTK's XML files as bytes.
#pragma once

#include <string>
#include <string_view>

#include "read/input.hpp"

namespace ahm::io {

/// How the binary arrays of a file are stored.
struct VtpEncoding {
  bool big_endian = false;
  bool wide_header = false;  ///< lengths of 8 bytes instead of 4
  bool compressed = false;   ///< by zlib, block by block
};

/// The bytes of one array, which begin where `text` begins and may be followed by others.
/// @param base64  or else raw
/// @param what    the array's name, for messages
/// @throws IoError where they do not fit into the text, or are damaged
/// @throws ResourceExhausted where unpacked they would fill more than a third of the memory that is free
std::string decode_vtp_array(const Input& in, std::string_view text, bool base64, const VtpEncoding& encoding,
                             const std::string& what);

}  // namespace ahm::io
