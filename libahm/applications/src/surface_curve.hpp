/// \file
/// Shortest paths between points of a surface, over flat faces if there are any.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ahm/surface/exact/exact_geodesics.hpp"

namespace ahm {

/// Geodesics over the flat faces of a surface; none, and the reason, if it has no flat faces or no positions.
struct FlatFaces {
  explicit FlatFaces(const Surface& surface);

  std::optional<ExactGeodesics> geodesics;
  std::string reason;  ///< message of `Surface::flat_triangles`; empty for a surface without faces or positions
};

/// The points in space where a path bends, with its first and last point. Points on the straight line between their
/// neighbors are left out.
std::vector<Vec3> bends(const ExactGeodesics& geodesics, const exact::GeodesicPath& path);

}  // namespace ahm
