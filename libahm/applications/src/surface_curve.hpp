/// \file
/// Shortest paths between points of a surface: over flat faces where it has them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ahm/surface/exact/exact_geodesics.hpp"

namespace ahm {

/// The layout of a surface's faces; none where it has none that are flat, or no positions, and why.
struct FlatFaces {
  explicit FlatFaces(const Surface& surface);

  std::optional<ExactGeodesics> geodesics;
  std::string reason;  ///< the message of `Surface::flat_triangles`; empty: of a surface without faces or positions
};

/// The points of a path in space, without those on the straight line between their neighbours. The first and the last
/// stay.
std::vector<Vec3> bends(const ExactGeodesics& geodesics, const exact::GeodesicPath& path);

}  // namespace ahm
