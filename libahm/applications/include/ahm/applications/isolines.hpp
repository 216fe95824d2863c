/// \file
/// Isolines: the curves on a surface where a function has a value.
///
/// \code
/// std::vector<double> levels = ahm::level_multiples(heights, 0.5);          // ..., 0, 0.5, 1, ... within the heights
/// for (const ahm::Isoline& line : ahm::isolines(surface, heights, levels)) draw(line.points, line.closed);
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/surface/surface.hpp"

namespace ahm {

/// A polyline on the faces of a surface. It has a point on every edge that it crosses.
struct Isoline {
  double level = 0;
  std::vector<Vec3> points;  ///< at least 2; a closed line does not repeat its first point. World units
  bool closed = false;
  double length = 0;  ///< world units
};

/// The isolines of a function that is linear in every triangle. Larger values are on their left, as seen from the side
/// on which the faces are counterclockwise. Lines end at the boundary and at triangles with a value that is NaN.
/// Flat polygons are triangulated as for exact geodesics, twisted polygons as fans from their first corner, and clouds have
/// the triangles of `Surface::flat_approximation`. A vertex whose value equals a level counts as above it.
/// @param values  one per row of the surface
/// @param levels  finite, in any order
/// @return the lines of the first level, then those of the next one
/// @throws InvalidArgument (number of values, a level that is not finite, a surface without positions; a cloud without
/// triangles: as `Surface::flat_approximation`)
std::vector<Isoline> isolines(const Surface& surface, std::span<const double> values, std::span<const double> levels);

/// The multiples of a step between the smallest and the largest finite value, in ascending order.
/// @param step  > 0
/// @throws InvalidArgument (step, no finite value, more than a million multiples)
std::vector<double> level_multiples(std::span<const double> values, double step);

}  // namespace ahm
