#include "ahm/applications/distortion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ahm/error.hpp"
#include "mapped_surfaces.hpp"

namespace ahm::test {
namespace {

/// The coordinates of a patch after a linear map of the plane.
std::vector<double> mapped(const Patch& patch, const std::array<double, 4>& A) {
  std::vector<double> q = patch.coordinates;
  for (std::size_t i = 0; i + 1 < q.size(); i += 2) {
    const double u = q[i], v = q[i + 1];
    q[i] = A[0] * u + A[1] * v, q[i + 1] = A[2] * u + A[3] * v;
  }
  return q;
}

TEST(Distortion, OfAnIsometryIsOne) {
  // A tilted plane, so that space does not agree with (u, v); turned in the plane as well.
  const Patch plane = patch(20, 1, [](double u, double v) {
    return std::array<Vec3, 2>{Vec3{3 + 0.6 * u, v - 7, 0.8 * u}, Vec3{-0.8, 0, 0.6}};
  });
  for (double turn : {0.0, 1.0, 2.5}) {
    const double c = std::cos(turn), s = std::sin(turn);
    const auto triangles = distortion(plane.positions, plane.triangles, mapped(plane, {c, -s, s, c}));
    for (const TriangleDistortion& t : triangles) {
      EXPECT_NEAR(t.value(), 1, 1e-12);
      EXPECT_FALSE(t.flipped);
    }
    EXPECT_NEAR(summary(triangles).mean, 1, 1e-13);
    EXPECT_EQ(summary(triangles).flipped, 0);
  }
}

TEST(Distortion, OfALinearMapAreItsSingularValues) {
  const Patch plane = patch(12, 1, flat);
  // Stretch by a and b between two rotations.
  const double c = std::cos(0.7), s = std::sin(0.7), C = std::cos(-1.9), S = std::sin(-1.9);
  for (const auto& [a, b] : {std::array{3.0, 0.5}, std::array{0.2, 0.9}, std::array{4.0, 2.0}, std::array{2.0, -1.5}}) {
    const auto triangles = distortion(
        plane.positions, plane.triangles,
        mapped(plane, {C * a * c - S * b * s, -C * a * s - S * b * c, S * a * c + C * b * s, -S * a * s + C * b * c}));
    const double least = std::min(std::abs(a), std::abs(b)), most = std::max(std::abs(a), std::abs(b));
    double area = 0;
    for (const TriangleDistortion& t : triangles) {
      EXPECT_NEAR(t.sigma1, least, 1e-12);
      EXPECT_NEAR(t.sigma2, most, 1e-12);
      EXPECT_NEAR(t.value(), std::max(1 / least, most), 1e-11);
      EXPECT_EQ(t.flipped, a * b < 0);
      area += t.side * t.side;
    }
    EXPECT_NEAR(area, 4, 1e-12);
    EXPECT_EQ(summary(triangles).flipped, a * b < 0 ? 1 : 0);
  }
}

TEST(Distortion, OfACollapseIsInfiniteAndOfUnknownsNothing) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 1, 3}};  // the second has no area
  const auto collapsed = distortion(positions, triangles, std::vector<double>{0, 0, 1, 0, 2, 0, 0, 0});
  EXPECT_EQ(collapsed[0].value(), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(collapsed[1].value()));
  const auto unknown = distortion(positions, triangles, std::vector<double>{0, 0, 1, 0, std::nan(""), 0, 0, 0});
  EXPECT_TRUE(std::isnan(unknown[0].value()));
  const DistortionSummary s = summary(unknown);
  EXPECT_EQ(s.measured, 0);
  EXPECT_EQ(s.unmeasured, 2);
  EXPECT_TRUE(std::isnan(s.mean) && std::isnan(s.percentile_95) && std::isnan(s.flipped));
}

TEST(Distortion, PerCornerAgreesWithPerVertex) {
  const Patch cap = patch(15, 1.2, on_sphere);
  std::vector<double> corners;
  for (const Triangle& t : cap.triangles)
    for (Index v : t)
      for (std::size_t c : {0, 1}) corners.push_back(cap.coordinates[2 * static_cast<std::size_t>(v) + c]);
  const auto a = distortion(cap.positions, cap.triangles, cap.coordinates),
             b = corner_distortion(cap.positions, cap.triangles, corners);
  for (std::size_t t = 0; t < a.size(); ++t) {
    EXPECT_EQ(a[t].sigma1, b[t].sigma1);
    EXPECT_EQ(a[t].sigma2, b[t].sigma2);
  }
}

TEST(Distortion, OfTheLogMapOfASphereIsRadiusOverSine) {
  // Polar coordinates stretch circles by r / sin r and nothing else.
  const Patch cap = patch(81, 1.2, on_sphere);
  const auto triangles = distortion(cap.positions, cap.triangles, cap.coordinates);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    double u = 0, v = 0;
    for (Index i : cap.triangles[t])
      u += cap.coordinates[2 * static_cast<std::size_t>(i)] / 3,
          v += cap.coordinates[2 * static_cast<std::size_t>(i) + 1] / 3;
    const double r = std::hypot(u, v);
    EXPECT_NEAR(triangles[t].sigma2, r > 0 ? r / std::sin(r) : 1, cap.longest_edge);
    EXPECT_NEAR(triangles[t].sigma1, 1, cap.longest_edge);
  }
}

TEST(Distortion, ScalesWithThePowersOfTwo) {
  const Patch cap = patch(9, 1, on_sphere);
  const auto original = distortion(cap.positions, cap.triangles, cap.coordinates);
  for (int exponent : {-400, -30, 30, 400}) {
    Patch scaled = cap;
    for (double& x : scaled.coordinates) x = std::ldexp(x, exponent);
    for (Vec3& p : scaled.positions)
      for (double& x : p) x = std::ldexp(x, exponent);
    const auto triangles = distortion(scaled.positions, scaled.triangles, scaled.coordinates);
    for (std::size_t t = 0; t < triangles.size(); ++t) EXPECT_EQ(triangles[t].value(), original[t].value());
    EXPECT_EQ(summary(triangles).percentile_95, summary(original).percentile_95);
  }
}

TEST(Distortion, IsSummarizedByArea) {
  const auto triangle = [](double sigma2, double area, bool flipped) {
    return TriangleDistortion{1, sigma2, std::sqrt(area), flipped};
  };
  const std::vector<TriangleDistortion> some{triangle(2, 90, false), triangle(10, 6, true), triangle(4, 4, false),
                                             TriangleDistortion{}};
  const DistortionSummary s = summary(some);
  EXPECT_DOUBLE_EQ(s.mean, (90 * 2 + 6 * 10 + 4 * 4) / 100.0);
  EXPECT_EQ(s.median, 2);
  EXPECT_EQ(s.percentile_95, 10);  // 94 % of the area have at most 4
  EXPECT_EQ(s.largest, 10);
  EXPECT_DOUBLE_EQ(s.flipped, 1.0 / 3);
  EXPECT_DOUBLE_EQ(s.flipped_area, 0.06);
  EXPECT_EQ(s.collapsed_area, 0);
  EXPECT_EQ(s.measured, 3);
  EXPECT_EQ(s.unmeasured, 1);
  // What collapses is told apart from the mean, and no less a part of the rest.
  std::vector<TriangleDistortion> with_collapse = some;
  with_collapse.push_back(triangle(1e14, 25, false));
  const DistortionSummary c = summary(with_collapse);
  EXPECT_DOUBLE_EQ(c.mean, s.mean);
  EXPECT_DOUBLE_EQ(c.collapsed_area, 0.2);
  EXPECT_EQ(c.largest, 1e14);
  EXPECT_EQ(c.measured, 4);
  EXPECT_TRUE(std::isnan(summary(std::vector{triangle(1e14, 25, false)}).mean));
}

TEST(Distortion, RefusesWhatDoesNotFit) {
  const Patch plane = patch(4, 1, flat);
  EXPECT_THROW(distortion(plane.positions, plane.triangles, std::vector<double>(3)), InvalidArgument);
  EXPECT_THROW(corner_distortion(plane.positions, plane.triangles, plane.coordinates), InvalidArgument);
  const std::vector<Triangle> outside{{0, 1, 16}};
  EXPECT_THROW(distortion(plane.positions, outside, plane.coordinates), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
