// Flat clouds give the identity, to rounding; clouds rolled up from the plane converge to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "ahm/conformance/vectors.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/maps/wavefront.hpp"
#include "solved_cloud.hpp"

namespace ahm::test {
namespace {

constexpr double gate = 1e-11;

/// Largest difference between (u, v) and the position relative to p along the axes of the graph's frame at p.
double flat_error(const Cloud& cloud, const Solved& solved, Index p, Variant variant) {
  const Frame frame = *solved.graph.graph().frame(solved.graph.vertex(Row(p)).index);
  const auto map = solved.map(p, variant);
  double worst = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    EXPECT_EQ(map.status[i], Status::ok) << "point " << i;
    const Vec3 offset{cloud.points[i][0] - cloud.points[p][0], cloud.points[i][1] - cloud.points[p][1],
                      cloud.points[i][2] - cloud.points[p][2]};
    worst = std::max(worst, std::hypot(map.u[i] - dot(frame.x, offset), map.v[i] - dot(frame.y, offset)));
  }
  return worst;
}

TEST(FlatCloud, IsTheIdentityFromInteriorAndBoundary) {
  const Cloud cloud = flat_cloud(4000);
  const Solved solved(cloud);
  // The interior, the four corners of the square and the rim of the hole.
  std::vector<Index> sources{17, 2000};
  for (auto corner : {std::array{0.0, 0.0}, std::array{1.0, 0.0}, std::array{0.0, 1.0}, std::array{1.0, 1.0},
                      std::array{0.65, 0.5}}) {
    auto nearest = std::min_element(cloud.plane.begin(), cloud.plane.end(), [&](const auto& a, const auto& b) {
      return std::hypot(a[0] - corner[0], a[1] - corner[1]) < std::hypot(b[0] - corner[0], b[1] - corner[1]);
    });
    sources.push_back(static_cast<Index>(nearest - cloud.plane.begin()));
  }
  for (Index p : sources)
    for (Variant variant : all_variants)
      EXPECT_LT(flat_error(cloud, solved, p, variant), gate * std::sqrt(2.0)) << "source " << p;
}

TEST(FlatCloud, IsTheIdentityOnARegularGrid) {
  // Every cell is cocircular: the hardest case for Delaunay.
  Cloud cloud;
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y) cloud.points.push_back({x * 1.0, y * 1.0, 0.0});
  for (Index p : {0, 820, 1599}) EXPECT_LT(flat_error(cloud, Solved(cloud), p, Variant::adaptive), gate * 56);
}

// Heat goes straight through a wall; the quality tells where the way around it is another.
TEST(FlatCloud, IsNotTrustedBehindAWall) {
  Cloud cloud;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  const int side = 60;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y) {
      const Vec3 p{(x + shift(random)) / side, (y + shift(random)) / side, 0};
      if (std::abs(p[0] - 0.5) > 0.3 || std::abs(p[1] - 0.5) > 0.06) cloud.points.push_back(p);
    }
  const auto nearest = [&](double x, double y) {
    const auto away = [&](const Vec3& p) { return std::hypot(p[0] - x, p[1] - y); };
    const auto found = std::min_element(cloud.points.begin(), cloud.points.end(),
                                        [&](const Vec3& a, const Vec3& b) { return away(a) < away(b); });
    return static_cast<Index>(found - cloud.points.begin());
  };
  const Solved solved(cloud);
  const LogMap map = solved.solver.solve(solved.graph.source(Row(nearest(0.5, 0.3))).source);
  const auto quality = to_rows(solved.graph.to_rows(map), map_quality(solved.graph.graph(), map));
  int behind = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3& p = cloud.points[i];
    const double offset = std::abs(p[0] - 0.5);
    if (p[1] < 0.42) EXPECT_GT(quality[i], 0.99) << p[0] << ", " << p[1];
    if (p[1] < 0.6 || offset > 0.15) continue;
    EXPECT_LT(quality[i], trusted_quality) << p[0] << ", " << p[1];
    ++behind;
  }
  EXPECT_GT(behind, 300);
}

// A line along the diagonals of squares passes between triangles that bend away from it on either side.
TEST(RolledCloud, OfSquaresIsCrossedDiagonally) {
  const int around = 120, rows = 40;
  const double h = 2 * std::numbers::pi / around;
  for (const Vec2 place : {Vec2{0, 0}, Vec2{0.5, 0}, Vec2{0, 0.01}, Vec2{0.5, 10.5}}) {
    Cloud cloud;
    for (int y = 0; y < rows; ++y)
      for (int k = 0; k < around; ++k) {
        const double angle = h * (k + place[0]);
        cloud.points.push_back({std::cos(angle) + place[1], std::sin(angle), h * y});
      }
    const auto surface = pointcloud::PointCloudSurface::build(cloud.points);
    Wavefront front(surface.graph());
    front.add(surface.source(Row(0)).source);
    front.run();
    for (int y = 0; y < rows; ++y)
      for (int k = 0; k < around; ++k) {
        const double exact = h * std::hypot(y, std::min(k, around - k));
        ASSERT_NEAR(front.distance(*surface.rows().vertex(Row(y * around + k))), exact, 0.002 * exact)
            << y << ", " << k;
      }
  }
}

TEST(FlatCloud, CoversItsArea) {
  // The lumped masses of a cloud that fills the unit square (less the hole) add up to about its area; local
  // triangulations that disagree count a little twice.
  const Cloud cloud = flat_cloud(4000);
  const auto graph = pointcloud::PointCloudSurface::build(cloud.points);
  const auto& masses = graph.graph().data().masses;
  const double area = std::accumulate(masses.begin(), masses.end(), 0.0) * std::pow(graph.graph().length_unit(), 2);
  EXPECT_NEAR(area, 1 - 0.15 * 0.15 * 3.14159, 0.1);
}

TEST(FlatCloud, ScalesBitwiseByPowersOfTwoAndSurvivesExtremeScales) {
  const Cloud cloud = flat_cloud(500);
  const auto map = Solved(cloud).map(3);
  for (double factor : {0x1p-990, 0x1p-20, 0x1p30, 0x1p1000}) {
    Cloud scaled = cloud;
    for (Vec3& p : scaled.points)
      for (double& c : p) c *= factor;
    const auto other = Solved(scaled).map(3);
    for (std::size_t i = 0; i < cloud.points.size(); ++i) ASSERT_EQ(other.u[i], factor * map.u[i]) << factor;
  }
  for (double factor : {1e-300, 1e-12, 1e12, 1e300}) {
    Cloud scaled = cloud;
    for (Vec3& p : scaled.points)
      for (double& c : p) c *= factor;
    const auto other = Solved(scaled).map(3);
    for (std::size_t i = 0; i < cloud.points.size(); ++i) ASSERT_NEAR(other.u[i] / factor, map.u[i], 1e-11);
  }
}

TEST(FlatCloud, IsAsGoodFarFromTheOriginAsItsDigitsAllow) {
  for (double far : {1e6, 1e8}) {
    Cloud cloud = flat_cloud(1500);
    for (Vec3& p : cloud.points)
      for (double& c : p) c += far;
    EXPECT_LT(flat_error(cloud, Solved(cloud), 10, Variant::adaptive), 100 * far * 2.3e-16);
  }
}

TEST(FlatCloud, DoesNotDependOnTheOrderOfPoints) {
  const Cloud cloud = flat_cloud(1000);
  std::vector<Index> order(cloud.points.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(2));
  Cloud shuffled = cloud;
  for (std::size_t i = 0; i < order.size(); ++i) shuffled.points[order[i]] = cloud.points[i];
  const auto map = Solved(cloud).map(3), other = Solved(shuffled).map(order[3]);
  for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(other.u[order[i]], map.u[i]);
}

TEST(FlatCloud, DoesNotDependOnTheNumberOfThreads) {
  const Cloud cloud = random_sphere(20000);
  pointcloud::CloudOptions one, many;
  one.threads = 1;
  many.threads = 7;
  const auto a = pointcloud::PointCloudSurface::build(cloud.points, {}, one),
             b = pointcloud::PointCloudSurface::build(cloud.points, {}, many);
  EXPECT_EQ(a.graph().data().neighbors, b.graph().data().neighbors);
  EXPECT_EQ(a.graph().data().weights, b.graph().data().weights);
  EXPECT_EQ(a.graph().data().transports, b.graph().data().transports);
}

TEST(RolledCloud, ConvergesToThePlaneWithSecondOrder) {
  auto error = [](Index rows, Variant variant) {
    const Cloud cloud = rolled_cloud(rows, 0.5);
    const Solved solved(cloud, true);
    const Index p = (rows / 2) * rows + rows / 2;
    // u along the axis of the cylinder, which is the plane's u; v is the normal times u.
    const LogMap map = solved.solver.solve(solved.graph.source(Row(p), Vec3{1, 0, 0}).source, {.variant = variant});
    const auto on_points = solved.graph.to_rows(map);
    double worst = 0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i)
      worst = std::max(worst, std::hypot(on_points.u[i] - (cloud.plane[i][0] - cloud.plane[p][0]),
                                         on_points.v[i] - (cloud.plane[i][1] - cloud.plane[p][1])));
    return worst;
  };
  for (Variant variant : all_variants) {
    const double coarse = error(30, variant), fine = error(60, variant);
    EXPECT_GE(std::log2(coarse / fine), 1.8) << coarse << " -> " << fine;
  }
}

TEST(Source, PointsItsUAxisWhereAsked) {
  const Cloud cloud = flat_cloud(800);
  const Solved solved(cloud);
  const Vec3 direction{cloud.points[60][0] - cloud.points[5][0], cloud.points[60][1] - cloud.points[5][1],
                       cloud.points[60][2] - cloud.points[5][2]};
  const auto map = solved.graph.to_rows(solved.solver.solve(solved.graph.source(Row(5), direction).source));
  EXPECT_NEAR(map.u[60], std::sqrt(dot(direction, direction)), 1e-11);
  EXPECT_NEAR(map.v[60], 0, 1e-11);
}

}  // namespace
}  // namespace ahm::test
