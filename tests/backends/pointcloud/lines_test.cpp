// Lines over the tangent planes of clouds.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/maps/tangent_lines.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/surface_paths.hpp"
#include "backends/great_circles.hpp"

namespace ahm::test {
namespace {

using pointcloud::PointCloudSurface;

/// Largest over some pairs of points of the unit sphere.
LineErrors sphere_errors(const Cloud& cloud) {
  const auto surface = PointCloudSurface::build(cloud.points);
  const CsrGraph& graph = surface.graph();
  LineErrors worst;
  const auto n = static_cast<Index>(cloud.points.size());
  for (Index k = 0; k < 12; ++k) {
    const TangentPlanePoint from{surface.vertex(Row(n / 13 * k + 5))}, to{surface.vertex(Row(n / 17 * (k + 3) + 2))};
    const Vec3 a = *position(graph, from), b = *position(graph, to);
    const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0));
    if (angle > 2.8) continue;
    const TangentLine path = shortest_line(graph, from, to);
    EXPECT_EQ(path.status, Status::ok);
    worst.length = std::max(worst.length, std::abs(path.length / angle - 1));
    const Vec3 normal = cross(a, b);
    for (const TangentPlanePoint& place : path.places)
      worst.off_circle = std::max(worst.off_circle, std::abs(dot(*position(graph, place), normal)) / norm(normal));
    const Frame frame = *graph.frame(from.vertex.index);
    const TangentLine line = trace_line(graph, from, {0.6, 0.8}, 2);
    EXPECT_TRUE(line.complete);
    Vec3 end;
    for (std::size_t c = 0; c < 3; ++c)
      end[c] = std::cos(2.0) * a[c] + std::sin(2.0) * (0.6 * frame.x[c] + 0.8 * frame.y[c]);
    worst.trace = std::max(worst.trace, norm(minus(*position(graph, line.places.back()), end)));
  }
  return worst;
}

TEST(LinesOnClouds, ConvergeToGreatCircles) {
  const LineErrors coarse = sphere_errors(even_sphere(1000)), fine = sphere_errors(even_sphere(16000));  // h / 4
  EXPECT_LT(coarse.length, 0.003);
  EXPECT_LT(coarse.off_circle, 0.03);  // a quarter of h
  EXPECT_LT(coarse.trace, 0.03);
  expect_convergence(coarse, fine);
}

TEST(LinesOnClouds, AreStraightOnAPlaneAndGoRoundItsHole) {
  const Cloud cloud = flat_cloud(3000);
  const auto surface = PointCloudSurface::build(cloud.points);
  const CsrGraph& graph = surface.graph();
  const double h = graph.mean_edge_length() * graph.length_unit();
  std::size_t straight = 0, around = 0;
  for (Index k = 0; k < 40; ++k) {
    const Row from(71 * k), to((1013 * k + 400) % 3000);
    const TangentLine path = shortest_line(graph, {surface.vertex(from)}, {surface.vertex(to)});
    ASSERT_EQ(path.status, Status::ok);
    const Vec2 a = cloud.plane[from.index], b = cloud.plane[to.index];
    const double chord = std::hypot(a[0] - b[0], a[1] - b[1]);
    ASSERT_GE(path.length, chord * (1 - 1e-9));
    ASSERT_LT(path.length, 1.3 * chord + 4 * h);
    path.length < chord*(1 + 1e-9) ? ++straight : ++around;
    const Vec3 end = *position(graph, path.places.back());
    ASSERT_LT(norm(minus(end, cloud.points[to.index])), 1e-9);
  }
  EXPECT_GT(straight, 20U);
  EXPECT_GT(around, 3U);
}

TEST(LinesOnClouds, AreTheSameReversed) {
  const Cloud cloud = moebius_cloud(4000);
  const auto surface = PointCloudSurface::build(cloud.points);
  const CsrGraph& graph = surface.graph();
  const double h = graph.mean_edge_length() * graph.length_unit();
  for (Index k = 0; k < 10; ++k) {
    const TangentPlanePoint a{surface.vertex(Row(37 * k))}, b{surface.vertex(Row(3999 - 211 * k))};
    const TangentLine there = shortest_line(graph, a, b), back = shortest_line(graph, b, a);
    EXPECT_EQ(there.length, back.length);
    ASSERT_EQ(there.places.size(), back.places.size());
    for (std::size_t p = 0; p < there.places.size(); ++p)
      EXPECT_EQ(there.places[p].offset, back.places[back.places.size() - 1 - p].offset);
    EXPECT_EQ(there.departure[0], -back.arrival[0]);
    EXPECT_GE(there.length, norm(minus(*position(graph, a), *position(graph, b))) - h);
  }
}

/// A cloud in which some points have a twin, much nearer than all other neighbours.
std::vector<Vec3> sphere_with_twins(double scale) {
  std::vector<Vec3> points = random_sphere(900, 3).points;
  for (std::size_t k = 0; k < 900; k += 20)
    points.push_back({points[k][0] + 1e-3 * points[k][1], points[k][1] - 1e-3 * points[k][0], points[k][2]});
  for (Vec3& p : points)
    for (double& x : p) x *= scale;
  return points;
}

TEST(LinesOnClouds, AreTheSameBitsAtEveryPowerOfTwo) {
  const auto lines = [](int exponent) {
    const auto surface = PointCloudSurface::build(sphere_with_twins(std::ldexp(1.0, exponent)));
    std::vector<SurfacePath> found;
    for (Index k = 0; k < 8; ++k) found.push_back(shortest_line(surface, Row(20 * k), Row(889 - 41 * k)));
    return found;
  };
  const auto at_one = lines(0);
  for (int exponent : {-1000, -850, -700, -540, 540, 1000}) {
    const auto scaled = lines(exponent);
    for (std::size_t k = 0; k < at_one.size(); ++k) {
      ASSERT_EQ(at_one[k].points.size(), scaled[k].points.size()) << exponent;
      EXPECT_EQ(at_one[k].length, std::ldexp(scaled[k].length, -exponent)) << exponent;
      for (std::size_t p = 0; p < at_one[k].points.size(); ++p)
        for (std::size_t a = 0; a < 3; ++a)
          ASSERT_EQ(at_one[k].points[p][a], std::ldexp(scaled[k].points[p][a], -exponent)) << exponent;
    }
  }
}

}  // namespace
}  // namespace ahm::test
