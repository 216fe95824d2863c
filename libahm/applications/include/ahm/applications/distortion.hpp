/// \file
/// How far a map of triangles to the plane is from an isometry (Eq. 18).
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

/// What a map does to one triangle.
struct TriangleDistortion {
  /// Singular values of the gradient, sigma1 <= sigma2: the factors by which lengths change in the least and in the
  /// most stretched direction. NaN where a corner has no coordinates or no position, or the triangle no area.
  double sigma1 = std::numeric_limits<double>::quiet_NaN();
  double sigma2 = std::numeric_limits<double>::quiet_NaN();
  double side = 0;       ///< square root of its area in space, world units: the area itself may not fit a double
  bool flipped = false;  ///< clockwise in the plane

  /// D = max(1/sigma1, sigma2): 1 for an isometry, infinite where the triangle collapses, NaN as above (Eq. 18).
  double value() const noexcept;
};

/// Areas as shares of the largest.
std::vector<double> relative_areas(std::span<const TriangleDistortion> triangles);

/// Of a map given per vertex.
/// @param positions    n, world units
/// @param triangles    of these vertices, counter-clockwise as seen from the side that the map sees
/// @param coordinates  n x 2, row major, world units; NaN where unknown, as in `LogMap::coordinates`
/// @return one per triangle
/// @throws InvalidArgument (lengths, indices)
std::vector<TriangleDistortion> distortion(std::span<const Vec3> positions,
                                           std::span<const std::array<Index, 3>> triangles,
                                           std::span<const double> coordinates);

/// Of a map given per corner, as of an atlas.
/// @param corner_coordinates  triangles x 3 x 2, row major
/// @throws InvalidArgument (lengths, indices)
std::vector<TriangleDistortion> corner_distortion(std::span<const Vec3> positions,
                                                  std::span<const std::array<Index, 3>> triangles,
                                                  std::span<const double> corner_coordinates);

/// Figures over the triangles that have a distortion; weighted by area, so that they do not depend on how a surface is
/// cut into triangles. NaN where there is no such triangle.
struct DistortionSummary {
  /// Of the triangles that do not collapse: one of those would hide all others.
  double mean = std::numeric_limits<double>::quiet_NaN();
  double median = std::numeric_limits<double>::quiet_NaN();
  double percentile_95 = std::numeric_limits<double>::quiet_NaN();  ///< 95 % of the area have no more
  double largest = std::numeric_limits<double>::quiet_NaN();
  /// Share of the area that collapses, D > 1e6: exact maps do so behind corners, all that lies in the shade of a vertex.
  double collapsed_area = std::numeric_limits<double>::quiet_NaN();
  double flipped = std::numeric_limits<double>::quiet_NaN();       ///< share of the number of triangles
  double flipped_area = std::numeric_limits<double>::quiet_NaN();  ///< share of the area
  Offset measured = 0;                                             ///< triangles that have a distortion
  Offset unmeasured = 0;                                           ///< triangles without coordinates or area
};

DistortionSummary summary(std::span<const TriangleDistortion> triangles);

}  // namespace ahm
