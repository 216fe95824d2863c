/// \file
/// Layout of the points of a binary file: consecutive records of equal size.
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
  std::uint64_t begin = 0, count = 0;  ///< position of the first record, bytes; number of records
  std::size_t stride = 0;              ///< size of a record, bytes
  std::array<std::size_t, 3> at{};     ///< offsets of x, y, z in a record, bytes
  std::array<PlyType, 3> type{};
  bool is_swapped = false;  ///< the byte order differs from that of the memory
  bool is_scaled = false;   ///< coordinates are stored numbers * `scale` + `offset`
  Vec3 scale{}, offset{};
  bool has_normals = false;  ///< every point has a normal
};

/// Receives points one at a time.
using TakePoint = std::function<void(const Vec3&)>;

/// The layout of the points, from the beginning of a PLY, LAS or PCD file; nullopt for text, compressed data, points of unequal sizes,
/// and coordinates that doubles may not represent. @throws IoError
std::optional<PointRecords> ply_records(const Input& in);
std::optional<PointRecords> las_records(const Input& in);
std::optional<PointRecords> pcd_records(const Input& in);
/// Reads a PCD file with text or compressed data and passes its points to `take`. @return whether they have normals
/// @throws IoError
bool take_pcd_points(const ByteStream& file, const TakePoint& take);

}  // namespace ahm::io
