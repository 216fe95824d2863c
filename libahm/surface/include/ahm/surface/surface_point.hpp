/// \file
/// A point of a surface, as a user names it: in terms of the input, never of the graph.
///
/// \code
/// ahm::SurfacePoint at_row = ahm::Row{42};                                 // row 42 of the input
/// ahm::SurfacePoint middle = ahm::EdgePoint{ahm::Row{3}, ahm::Row{4}, 0.5};
/// ahm::SurfacePoint inside = ahm::FacePoint{7, {0.2, 0.3, 0.5}};
/// ahm::SurfacePoint picked = surface.closest_point({0.1, 0.2, 1.4}).point;
/// \endcode
#pragma once

#include <variant>
#include <vector>

#include "ahm/types.hpp"

namespace ahm {

/// A point on an edge of the input, at (1 - t) from + t to; t in [0, 1].
struct EdgePoint {
  Row from, to;
  double t = 0;
};

/// A point of a face of the input.
struct FacePoint {
  Index face = 0;
  /// Weights of the face's corners in the order given: one per corner, >= 0, sum 1 (each to 1e-9; made exact).
  std::vector<double> barycentric;
};

/// A point of the tangent plane of a row, near it: where a surface has no faces.
struct TangentPoint {
  Row row;
  Vec3 position{};  ///< world units; its part along the normal does not count
};

using SurfacePoint = std::variant<Row, EdgePoint, FacePoint, TangentPoint>;

/// The point of a surface nearest to a position in space.
struct ClosestPoint {
  SurfacePoint point;
  Vec3 position{};      ///< of the point, world units
  double distance = 0;  ///< in space, world units
};

}  // namespace ahm
