/// \file
/// Reader of VTK's XML files of polygonal data.
#pragma once

#include "ahm/io/geometry.hpp"
#include "read/input.hpp"

namespace ahm::io {

/// Reads arrays as text, base64 or appended data (raw or base64), uncompressed or compressed with zlib. @throws IoError
Geometry read_vtp(const Input& in);

}  // namespace ahm::io
