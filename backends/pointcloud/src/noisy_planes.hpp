/// \file
/// Neighbors, tangent planes and noise of a cloud, each of its parts as if it were alone.
#pragma once

#include <memory>
#include <span>

#include "cloud_parts.hpp"
#include "offset_noise.hpp"
#include "tangent_planes.hpp"

namespace ahm::pointcloud {

inline constexpr Index default_neighbors = 30;

struct NoisyPlanes {
  Neighborhoods neighborhoods;
  TangentPlanes planes;
  std::unique_ptr<const CloudParts> parts;
  PerPart noise;        ///< its deviation
  Noise typical_noise;  ///< of the largest part, before smoothing
  Index merged = 0;     ///< points merged into a near one
};

/// Neighbors and planes of distinct points: merges near points, smooths noisy parts, and finds all again, until smoothing makes
/// no more parts quiet.
/// @param cloud, search  changed where points merge or move
NoisyPlanes find_noisy_planes(CleanPoints& cloud, std::span<const Vec3> normals,
                              std::unique_ptr<NeighborSearch>& search, const CloudOptions& options);

}  // namespace ahm::pointcloud
