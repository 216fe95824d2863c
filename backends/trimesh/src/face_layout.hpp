/// \file
/// Triangles laid out in the plane.
#pragma once

#include <array>

#include "planar.hpp"

namespace ahm::trimesh {

/// The three sides of a face as vectors of the plane, counter-clockwise, side 0 along the x axis. Each side is kept by
/// itself, so that short sides and flat caps have vectors accurate to their own length: lengths alone determine the
/// height y of a cap only to eps / y.
using FaceLayout = std::array<Vec2, 3>;

FaceLayout layout_of_positions(const Vec3& a, const Vec3& b, const Vec3& c);
/// @param l0, l1, l2  lengths of the sides; beyond the triangle inequality the face is flat
FaceLayout layout_of_lengths(double l0, double l1, double l2);

/// Height over the longest side, divided by that side: 0.87 for an equilateral triangle, 0 for a degenerate one.
double relative_height(const Vec2* sides);

/// A height below this multiple of the longest side is almost none.
constexpr double least_relative_height = 1e-10;

}  // namespace ahm::trimesh
