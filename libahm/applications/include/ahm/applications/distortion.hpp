/// \file
/// Metric distortion: how much a map of triangles to the plane differs from an isometry (Eq. 18).
///
/// \code
/// std::vector<ahm::TriangleDistortion> d = ahm::distortion(positions, triangles, map.coordinates());
/// ahm::DistortionSummary s = ahm::summary(d);                          // s.mean, s.percentile_95, s.flipped
/// \endcode
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "ahm/types.hpp"

namespace ahm {

/// Distortion of one triangle under a map.
struct TriangleDistortion {
  /// Singular values of the gradient, sigma1 <= sigma2: the factors by which lengths change in the least and the most
  /// stretched direction. NaN where a corner has no coordinates or no position, or where the triangle has no area.
  double sigma1 = std::numeric_limits<double>::quiet_NaN();
  double sigma2 = std::numeric_limits<double>::quiet_NaN();
  double side = 0;       ///< square root of the area in space, world units; the area itself may overflow
  bool flipped = false;  ///< clockwise in the plane

  /// D = max(1/sigma1, sigma2) (Eq. 18): 1 for an isometry, infinite where the triangle collapses, NaN where sigma1 and
  /// sigma2 are.
  double value() const noexcept;
};

/// Areas of the triangles relative to the largest one.
std::vector<double> relative_areas(std::span<const TriangleDistortion> triangles);

/// Distortion of a map with coordinates per vertex.
/// @param positions    n positions, world units
/// @param triangles    corners of each triangle, counter-clockwise as seen from the side of the source's normal
/// @param coordinates  n x 2, row major, world units; NaN where unknown, as in `LogMap::coordinates`
/// @return one entry per triangle
/// @throws InvalidArgument (lengths, indices)
std::vector<TriangleDistortion> distortion(std::span<const Vec3> positions,
                                           std::span<const std::array<Index, 3>> triangles,
                                           std::span<const double> coordinates);

/// Distortion of a map with coordinates per corner, such as an atlas.
/// @param corner_coordinates  triangles x 3 x 2, row major
/// @throws InvalidArgument (lengths, indices)
std::vector<TriangleDistortion> corner_distortion(std::span<const Vec3> positions,
                                                  std::span<const std::array<Index, 3>> triangles,
                                                  std::span<const double> corner_coordinates);

/// Statistics of the triangles that have a distortion. They are weighted by area, so they do not depend on the
/// triangulation. NaN where there is no such triangle.
struct DistortionSummary {
  /// Mean over the triangles that do not collapse; a single collapsed one would dominate it.
  double mean = std::numeric_limits<double>::quiet_NaN();
  double median = std::numeric_limits<double>::quiet_NaN();
  double percentile_95 = std::numeric_limits<double>::quiet_NaN();  ///< 95 % of the area has at most this distortion
  double largest = std::numeric_limits<double>::quiet_NaN();
  /// Share of the area that collapses, D > 1e6. Exact maps collapse the area behind a vertex that its shortest paths pass
  /// through.
  double collapsed_area = std::numeric_limits<double>::quiet_NaN();
  double flipped = std::numeric_limits<double>::quiet_NaN();       ///< share of the number of triangles
  double flipped_area = std::numeric_limits<double>::quiet_NaN();  ///< share of the area
  Offset measured = 0;                                             ///< number of triangles that have a distortion
  Offset unmeasured = 0;                                           ///< number of triangles without coordinates or area
};

DistortionSummary summary(std::span<const TriangleDistortion> triangles);

}  // namespace ahm
