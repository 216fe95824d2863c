// Lines of a scanner, along which points are far denser than across.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "solved_cloud.hpp"

namespace ahm::test {
namespace {

constexpr Index around = 400, rings = 16;

/// Rings about a cylinder of radius 1, `ratio` times farther apart than their points.
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

bool are_lines(const pointcloud::PointCloudSurface& cloud) {
  return std::ranges::any_of(cloud.warnings(), [](const Warning& w) { return w.id == "lines"; });
}

TEST(ScanLines, AroundAPipeAreJoined) {
  for (const double ratio : {5.0, 20.0, 40.0}) {
    const Cloud cloud = pipe(ratio);
    const Solved solved(cloud);
    EXPECT_EQ(solved.graph.details().components, 1) << ratio;
    EXPECT_FALSE(are_lines(solved.graph)) << ratio;
    constexpr Index source = around * (rings / 2);
    const RowLogMap map = solved.map(source);
    for (Index i = 0; i < around * rings; ++i) {
      const double angle = std::remainder(cloud.plane[i][0] - cloud.plane[source][0], 2 * std::numbers::pi);
      const double exact = std::hypot(angle, cloud.plane[i][1] - cloud.plane[source][1]);
      ASSERT_NEAR(map.distance[i], exact, (ratio < 30 ? 0.03 : 0.05) * exact + 0.02) << ratio << ' ' << i;
    }
  }
}

TEST(ScanLines, TooFarApartAreNamed) {
  const auto lines = pointcloud::PointCloudSurface::build(pipe(90).points);
  EXPECT_EQ(lines.details().lines, around * rings);
  EXPECT_TRUE(are_lines(lines));
  std::vector<Vec3> ring = pipe(1).points;
  ring.resize(around);
  EXPECT_TRUE(are_lines(pointcloud::PointCloudSurface::build(ring)));
}

}  // namespace
}  // namespace ahm::test
