// Lines over the tangent planes of clouds, and clouds that consist of lines of a scanner.
#include "ahm/maps/tangent_lines.hpp"
#include "ahm/surface/surface_paths.hpp"
#include "backends/great_circles.hpp"
#include "clouds.hpp"

namespace ahm::test {
namespace {

LineErrors sphere_line_errors(const Cloud& cloud) {
  const auto surface = PointCloudSurface::build(cloud.points);
  const CsrGraph& graph = surface.graph();
  LineErrors worst;
  const auto n = static_cast<Index>(cloud.points.size());
  for (Index k = 0; k < 12; ++k) {
    const TangentPlanePoint from{surface.vertex(Row(n / 13 * k + 5))}, to{surface.vertex(Row(n / 17 * (k + 3) + 2))};
    const Vec3 a = *position(graph, from), b = *position(graph, to);
    if (sphere_distance(a, b) > 2.8) continue;
    const TangentLine path = shortest_line(graph, from, to);
    EXPECT_EQ(path.status, Status::ok);
    std::vector<Vec3> points;
    for (const TangentPlanePoint& place : path.places) points.push_back(*position(graph, place));
    worst.add_path(a, b, path.length, points);
    const Frame frame = *graph.frame(from.vertex.index);
    const TangentLine line = trace_line(graph, from, {0.6, 0.8}, 2);
    EXPECT_TRUE(line.complete);
    worst.add_trace(a, 0.6 * frame.x + 0.8 * frame.y, *position(graph, line.places.back()));
  }
  return worst;
}

TEST(LinesOnClouds, ConvergeToGreatCircles) {
  const LineErrors coarse = sphere_line_errors(even_sphere(1000)),
                   fine = sphere_line_errors(even_sphere(16000));  // h / 4
  EXPECT_LT(coarse.length, 0.003);
  EXPECT_LT(coarse.off_circle, 0.03);  // a quarter of h
  EXPECT_LT(coarse.trace, 0.03);
  expect_convergence(coarse, fine);
}

TEST(LinesOnClouds, AreStraightOnAPlaneAndGoAroundItsHole) {
  const Cloud cloud = flat_cloud(3000);
  const auto surface = PointCloudSurface::build(cloud.points);
  int straight = 0, around = 0;
  for (Index k = 0; k < 40; ++k) {
    const Row from(71 * k), to((1013 * k + 400) % 3000);
    const TangentLine path = shortest_line(surface.graph(), {surface.vertex(from)}, {surface.vertex(to)});
    ASSERT_EQ(path.status, Status::ok);
    const double chord = length(cloud.plane[from.index] - cloud.plane[to.index]);
    ASSERT_GE(path.length, chord * (1 - 1e-9));
    ASSERT_LT(path.length, 1.3 * chord + 4 * mean_edge(surface));
    ++(path.length < chord * (1 + 1e-9) ? straight : around);
    ASSERT_LT(norm(*position(surface.graph(), path.places.back()) - cloud.points[to.index]), 1e-9);
  }
  EXPECT_GT(straight, 20);
  EXPECT_GT(around, 3);
}

TEST(LinesOnClouds, AreTheSameReversed) {
  const auto surface = PointCloudSurface::build(moebius_cloud(4000).points);
  const CsrGraph& graph = surface.graph();
  for (Index k = 0; k < 10; ++k) {
    const TangentPlanePoint a{surface.vertex(Row(37 * k))}, b{surface.vertex(Row(3999 - 211 * k))};
    const TangentLine there = shortest_line(graph, a, b), back = shortest_line(graph, b, a);
    EXPECT_EQ(there.length, back.length);
    ASSERT_EQ(there.places.size(), back.places.size());
    for (std::size_t p = 0; p < there.places.size(); ++p)
      EXPECT_EQ(there.places[p].offset, back.places[back.places.size() - 1 - p].offset);
    EXPECT_EQ(there.departure[0], -back.arrival[0]);
    EXPECT_GE(there.length, norm(*position(graph, a) - *position(graph, b)) - mean_edge(surface));
  }
}

TEST(LinesOnClouds, AreTheSameBitsAtEveryPowerOfTwo) {
  std::vector<Vec3> points = random_sphere(900, 3).points;
  for (std::size_t k = 0; k < 900; k += 20)  // twins that are much nearer than all other neighbors
    points.push_back(points[k] + 1e-3 * Vec3{points[k][1], -points[k][0], 0});
  const auto lines = [&](int exponent) {
    const auto surface = PointCloudSurface::build(scaled(std::ldexp(1.0, exponent), points));
    std::vector<SurfacePath> found;
    for (Index k = 0; k < 8; ++k) found.push_back(shortest_line(surface, Row(20 * k), Row(889 - 41 * k)));
    return found;
  };
  const auto at_one = lines(0);
  for (int exponent : {-1000, -850, -700, -540, 540, 1000}) {
    const auto others = lines(exponent);
    for (std::size_t k = 0; k < at_one.size(); ++k) {
      ASSERT_EQ(at_one[k].points.size(), others[k].points.size()) << exponent;
      EXPECT_EQ(at_one[k].length, std::ldexp(others[k].length, -exponent)) << exponent;
      for (std::size_t p = 0; p < at_one[k].points.size(); ++p)
        for (std::size_t a = 0; a < 3; ++a)
          ASSERT_EQ(at_one[k].points[p][a], std::ldexp(others[k].points[p][a], -exponent)) << exponent;
    }
  }
}

constexpr Index around = 400, rings = 16;

/// Rings of points around a cylinder of radius 1. The distance of the rings is `ratio` times that of their points.
Cloud pipe(double ratio) {
  const double side = 2 * std::numbers::pi / around;
  Cloud cloud;
  for (Index ring = 0; ring < rings; ++ring)
    for (Index k = 0; k < around; ++k) {
      const double angle = side * (k + 0.37 * ring);
      cloud.points.push_back({std::cos(angle), std::sin(angle), ratio * side * ring});
      cloud.plane.push_back({angle, ratio * side * ring});
    }
  return cloud;
}

TEST(ScanLines, AroundAPipeAreJoined) {
  for (const double ratio : {5.0, 20.0, 40.0}) {
    const Cloud cloud = pipe(ratio);
    const SolvedCloud solved(cloud.points);
    EXPECT_EQ(solved.surface.details().components, 1) << ratio;
    EXPECT_EQ(solved.surface.details().degenerate, 0) << ratio;
    EXPECT_FALSE(find_warning(solved.surface, "lines")) << ratio;
    constexpr Index source = around * (rings / 2);
    const RowLogMap map = solved.map(source);
    for (Index i = 0; i < around * rings; ++i) {
      const double angle = std::remainder(cloud.plane[i][0] - cloud.plane[source][0], 2 * std::numbers::pi);
      const double exact = std::hypot(angle, cloud.plane[i][1] - cloud.plane[source][1]);
      ASSERT_NEAR(map.distance[i], exact, (ratio < 30 ? 0.03 : 0.05) * exact + 0.02) << ratio << ' ' << i;
    }
  }
}

TEST(ScanLines, OnAPlaneGetPlanesFromWiderNeighborhoods) {
  // The 30 nearest of most points lie on one line.
  std::vector<Vec3> points;
  for (int line = 0; line < 12; ++line)
    for (int i = 0; i < 120; ++i) points.push_back({0.05 * i, 1.0 * line, 0.0});
  const auto surface = PointCloudSurface::build(points);
  EXPECT_EQ(surface.details().degenerate, 0);
  EXPECT_EQ(surface.rows().row_count(), surface.details().vertices);
}

TEST(ScanLines, TooFarApartAreNamed) {
  const auto lines = PointCloudSurface::build(pipe(90).points);
  EXPECT_EQ(lines.details().lines, around * rings);
  EXPECT_TRUE(find_warning(lines, "lines"));
  std::vector<Vec3> ring = pipe(1).points;
  ring.resize(around);
  EXPECT_TRUE(find_warning(PointCloudSurface::build(ring), "lines"));
}

}  // namespace
}  // namespace ahm::test
