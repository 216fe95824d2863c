/// \file
/// Points of a surface as the algorithms take them.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/surface/exact/polyhedral_surface.hpp"
#include "ahm/util/text.hpp"

namespace ahm::exact {

/// The point with weights that sum to 1, those below 1e-14 made zero.
/// @throws InvalidArgument
inline MeshPoint checked(const PolyhedralSurface& surface, MeshPoint point, const std::string& name) {
  auto& b = point.barycentric;
  if (point.face < 0 || point.face >= surface.face_count())
    throw InvalidArgument(name + ": face " + std::to_string(point.face) + " is outside [0, " +
                          std::to_string(surface.face_count()) + ")");
  if (!(std::abs(b[0] + b[1] + b[2] - 1) <= 1e-9) || !(std::min({b[0], b[1], b[2]}) >= -1e-9))
    throw InvalidArgument(name + ": barycentric coordinates (" + detail::number(b[0]) + ", " + detail::number(b[1]) +
                          ", " + detail::number(b[2]) + ") in face " + std::to_string(point.face) +
                          " must be >= 0 and sum to 1");
  for (double& w : b) w = w < 1e-14 ? 0.0 : w;
  const double sum = b[0] + b[1] + b[2];
  for (double& w : b) w /= sum;
  return point;
}

/// The vertex of a checked point with two zero weights; else -1.
inline Index vertex_of(const PolyhedralSurface& surface, const MeshPoint& point) {
  Index vertex = -1;
  for (int s = 0; s < 3; ++s) {
    if (!(point.barycentric[s] > 0)) continue;
    if (vertex >= 0) return -1;
    vertex = surface.record(3 * point.face + s).tail;
    if (point.barycentric[s] < 1) return -1;
  }
  return vertex;
}

}  // namespace ahm::exact
