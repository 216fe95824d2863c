/// \file
/// One reader per format; `read` chooses among them.
#pragma once

#include "ahm/io/geometry.hpp"
#include "read/input.hpp"

namespace ahm::io {

Geometry read_ply(const Input& in);
Geometry read_off(const Input& in);
Geometry read_obj(const Input& in);
/// Text or binary. Corners at exactly equal positions become one vertex, numbered in the order of their first appearance.
Geometry read_stl(const Input& in);
/// Columns separated by blanks (.xyz, .txt).
Geometry read_xyz(const Input& in);
/// Columns separated by commas, semicolons or tabs, perhaps with names in the first line.
Geometry read_csv(const Input& in);
/// @throws IoError when built without PCL
Geometry read_pcd(const Input& in);

/// @throws IoError when `count` vertices cannot be numbered with `Index`
void check_vertex_count(const Input& in, std::uint64_t count);

}  // namespace ahm::io
