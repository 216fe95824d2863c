// How fronts bend over curved surfaces, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "maps/front_geometry.hpp"

namespace ahm::test {
namespace {

/// The focusing of a front that has come this far, over a surface of one curvature.
double focusing_at(double distance, double curvature, int steps) {
  double focusing = 0;
  for (int k = 0; k < steps; ++k)
    focusing = focusing_after(focusing, distance * k / steps, distance * (k + 1) / steps, curvature);
  return focusing;
}

TEST(Focusing, IsNoneInThePlane) {
  EXPECT_EQ(focusing_at(3, 0, 7), 0);
  EXPECT_EQ(curvature_correction(bend_along(0.3, 0, 2), 0.3, 0.4, 1), 0);
}

// A front at distance r from a point of the unit sphere has the curvature cot r, on the hyperbolic plane coth r.
TEST(Focusing, IsThatOfTheSphereAndOfTheHyperbolicPlane) {
  for (double r : {0.1, 0.7, 1.5, 2.4}) {
    const double sphere = r - r * r / std::tan(r), hyperbolic = r - r * r / std::tanh(r);
    for (int steps : {50, 100, 200}) {
      EXPECT_NEAR(focusing_at(r, 1, steps), sphere, 6.0 / steps * std::abs(sphere)) << r;
      EXPECT_NEAR(focusing_at(r, -1, steps), hyperbolic, 2.0 / steps * std::abs(hyperbolic)) << r;
    }
    EXPECT_NEAR(focusing_at(r, 1, 20000), sphere, 1e-3 * std::abs(sphere)) << r;
    EXPECT_NEAR(focusing_at(r, -1, 20000), hyperbolic, 1e-3 * std::abs(hyperbolic)) << r;
  }
}

// The height of an isosceles triangle with straight sides, on the unit sphere: cos r = cos h cos(s/2).
TEST(Focusing, TellsTheHeightOfASphericalTriangle) {
  for (double r : {0.3, 1.0, 2.0})
    for (double s : {0.02, 0.04}) {
      const double height = std::acos(std::cos(r) / std::cos(s / 2)), flat = std::sqrt(r * r - s * s / 4);
      const double focusing = r - r * r / std::tan(r);
      EXPECT_NEAR(curvature_correction(bend_along(s, focusing, r), s, 0.5, 1), height - flat,
                  0.01 * std::abs(height - flat))
          << r << ", " << s;
    }
}

TEST(Focusing, StaysBoundedBehindAFocus) {
  double focusing = 0;
  for (int k = 0; k < 100; ++k) {
    focusing = focusing_after(focusing, 0.1 * k, 0.1 * (k + 1), 1);  // as far as 10: behind three foci
    ASSERT_LE(std::abs(focusing), max_bend * 0.01 * (k + 1) * (k + 1) / 0.1 * (1 + 1e-12));
    ASSERT_LE(std::abs(curvature_correction(bend_along(0.1, focusing, 0.1 * (k + 1)), 0.1, 0.5, 1)),
              max_curvature_correction * 0.1);
  }
}

TEST(Focusing, TakesNoMoreThanAShareOfTheDistance) {
  for (double distance : {0.0, 1e-300, 1e-3, 1.0})
    for (double focusing : {-1e9, 1e9})
      EXPECT_LE(std::abs(curvature_correction(bend_along(1, focusing, distance), 1, 0.5, 1)),
                max_curvature_correction * distance);
}

TEST(Focusing, IsFiniteWhereSquaresOfLengthsAreNot) {
  EXPECT_EQ(focusing_after(0, 1e200, 2e200, 0), 0);
  EXPECT_TRUE(std::isfinite(focusing_after(1, 1e-200, 2e-200, 1e300)));
}

}  // namespace
}  // namespace ahm::test
