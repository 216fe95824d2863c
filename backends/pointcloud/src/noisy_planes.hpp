/// \file
/// Neighbours, tangent planes and noise of a cloud, each of its parts as if it were alone.
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
  Index k = 0;          ///< the largest number of neighbours asked for in a part ...
  Noise typical_noise;  ///< ... and the noise there: that of the largest of such parts
};

/// Neighbours and planes. Where nobody fixed their number, noisy parts get more neighbours, since the error of a plane is
/// that of its points over the number of them; but only as long as that makes neighbourhoods flatter, which sets noise apart
/// from branches and volumes.
NoisyPlanes find_noisy_planes(const CleanPoints& cloud, std::span<const Vec3> normals, const NeighborSearch& search,
                              const CloudOptions& options);

}  // namespace ahm::pointcloud
