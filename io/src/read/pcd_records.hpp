/// \file
/// Where coordinates are in the points of a PCD file.
#pragma once

#include <optional>

#include "read/pcd_header.hpp"
#include "read/point_records.hpp"

namespace ahm::io {

/// 0 of the field x, 1 of y, 2 of z.
std::optional<std::size_t> axis_of(const PcdField& field);
bool has_normals(const PcdHeader& header);
/// Of uncompressed points. @throws IoError (types that are not read)
PointRecords records_of(const Input& in, const PcdHeader& header);

}  // namespace ahm::io
