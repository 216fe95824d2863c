/// \file
/// Reader of glTF 2.0 files, text or binary.
#pragma once

#include "ahm/io/geometry.hpp"
#include "read/input.hpp"

namespace ahm::io {

Geometry read_gltf(const Input& in);

}  // namespace ahm::io
