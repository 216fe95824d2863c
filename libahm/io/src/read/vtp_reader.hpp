/// \file
/// VTK's XML files of polygonal data.
#pragma once

#include "ahm/io/geometry.hpp"
#include "read/input.hpp"

namespace ahm::io {

/// Arrays as text, base64 or appended (raw or base64), as they are or compressed by zlib. @throws IoError
Geometry read_vtp(const Input& in);

}  // namespace ahm::io
