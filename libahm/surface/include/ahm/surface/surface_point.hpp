/// \file
/// A point of a surface in terms of the input (rows, faces, edges), never of the graph.
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
  /// Weights of the corners in the input's order: one per corner, >= 0, sum 1 (each to 1e-9; made exact).
  std::vector<double> barycentric;
};

/// A point of the tangent plane of a row, near the row. For surfaces without faces.
struct TangentPoint {
  Row row;
  Vec3 position{};  ///< world units; the component along the normal is ignored
};

using SurfacePoint = std::variant<Row, EdgePoint, FacePoint, TangentPoint>;

/// The point of a surface nearest to a position in space.
struct ClosestPoint {
  SurfacePoint point;
  Vec3 position{};      ///< position of `point`, world units
  double distance = 0;  ///< distance in space from the query, world units
};

}  // namespace ahm
