/// \file
/// Errors of lines on the unit sphere against great circles.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::test {

/// Largest errors of some paths, and of some traces of length 2.
struct LineErrors {
  double length = 0;      ///< lengths of paths, relative
  double off_circle = 0;  ///< distances of their points from the plane of the great circle
  double trace = 0;       ///< distances of the ends of traces from the exact ends

  void add_path(const Vec3& from, const Vec3& to, double path_length, const std::vector<Vec3>& points) {
    length = std::max(length, std::abs(path_length / sphere_distance(from, to) - 1));
    const Vec3 normal = ahm::normalized(ahm::cross(from, to));
    for (const Vec3& p : points) off_circle = std::max(off_circle, std::abs(ahm::dot(p, normal)));
  }
  /// @param along  unit vector
  void add_trace(const Vec3& from, const Vec3& along, const Vec3& end) {
    trace = std::max(trace, ahm::norm(end - (std::cos(2.0) * from + std::sin(2.0) * along)));
  }
};

/// @param fine  errors at a quarter of the spacing
inline void expect_convergence(const LineErrors& coarse, const LineErrors& fine) {
  EXPECT_LT(fine.length, coarse.length / 12);         // second order
  EXPECT_LT(fine.off_circle, coarse.off_circle / 4);  // between first and second order
  EXPECT_LT(fine.trace, coarse.trace / 4);
}

}  // namespace ahm::test
