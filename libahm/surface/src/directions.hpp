/// \file
/// Curvature from heights over a tangent plane [CP05].
#pragma once

#include <array>

#include "ahm/types.hpp"

namespace ahm {

/// Principal curvatures of a shape operator S, |kappa_1| >= |kappa_2|, and the unit vector, up to its sign, along which the
/// curvature is kappa_1. NaN where the heights do not determine S.
struct PrincipalCurvature {
  Vec2 values, direction;
};

/// The paraboloid z = t . x - (x . S x) / 2 through a point with a normal. It is fitted by weighted least squares to heights z
/// over positions x in the tangent plane of the point.
class Paraboloid {
 public:
  /// @param unit  typical length of the positions x
  explicit Paraboloid(double unit) : unit_(unit) {}
  void add(const Vec2& x, double z, double weight);
  /// In 1 / the unit of the positions; positive where the surface bends away from the normal.
  PrincipalCurvature curvature() const;

 private:
  double unit_;
  std::array<double, 25> normal_{};  ///< normal equations for t and for S_00, S_01, S_11 times the unit
  std::array<double, 5> right_{};
};

}  // namespace ahm
