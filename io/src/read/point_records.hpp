/// \file
/// Where the points of a binary file are: records of one size, one after the other.
#pragma once

#include <array>
#include <cstdint>

#include "ahm/types.hpp"
#include "read/input.hpp"
#include "read/ply_value.hpp"

namespace ahm::io {

struct PointRecords {
  std::uint64_t begin = 0, count = 0;  ///< bytes before the first one; how many
  std::size_t stride = 0;              ///< bytes of one
  std::array<std::size_t, 3> at{};     ///< of x, y, z in it
  std::array<PlyType, 3> type{};
  bool is_swapped = false;  ///< `ahm::io::is_swapped`
  bool is_scaled = false;   ///< coordinates are numbers times `scale` plus `offset`
  Vec3 scale{}, offset{};
  bool has_normals = false;  ///< every point has one
};

/// Of these formats, from the beginning of a file. @throws IoError, also where points are no such records
PointRecords ply_records(const Input& in);
PointRecords las_records(const Input& in);
PointRecords pcd_records(const Input& in);

}  // namespace ahm::io
