/// \file
/// Where the points of a binary file are: records of one size, one after the other.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "ahm/types.hpp"
#include "read/bytes.hpp"
#include "read/input.hpp"
#include "read/ply_header.hpp"

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

/// Gets points one after the other.
using TakePoint = std::function<void(const Vec3&)>;

/// Of these formats, from the beginning of a file; nullopt where it is text or compressed. @throws IoError
std::optional<PointRecords> ply_records(const Input& in);
std::optional<PointRecords> las_records(const Input& in);
std::optional<PointRecords> pcd_records(const Input& in);
/// Of PCD files that are text or compressed. @return whether points have normals @throws IoError
bool take_pcd_points(const ByteStream& file, const TakePoint& take);

}  // namespace ahm::io
