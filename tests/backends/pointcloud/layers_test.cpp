// Layers nearer to each other than neighbours are one surface, with the distances of one, and are named.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "ahm/util/vec.hpp"
#include "noisy_clouds.hpp"
#include "solved_cloud.hpp"

namespace ahm::test {
namespace {

constexpr Index n = 4000;

double spacing() { return std::sqrt(4 * std::numbers::pi / n); }

bool has_layers(const pointcloud::PointCloudSurface& cloud) {
  return std::ranges::any_of(cloud.warnings(), [](const Warning& w) { return w.id == "layers"; });
}

/// Two scans of the unit sphere, the second one `gap` farther out, with normals.
Cloud two_scans(double gap) {
  Cloud both = random_sphere(n, 1);
  const Cloud other = random_sphere(n, 2);
  for (const Vec3& p : other.points) both.points.push_back((1 + gap) * p);
  both.normals.insert(both.normals.end(), other.normals.begin(), other.normals.end());
  return both;
}

TEST(Layers, OfTwoScansKeepTheDistancesOfOne) {
  for (const double share : {0.1, 0.25, 0.5, 0.75}) {
    const double gap = share * spacing();
    const Cloud cloud = two_scans(gap);
    const Solved solved(cloud);
    EXPECT_TRUE(has_layers(solved.graph)) << share;
    EXPECT_NEAR(solved.graph.details().layer_gap, gap, 0.1 * gap) << share;
    const RowLogMap map = solved.map(0);
    double sum = 0;
    Index count = 0;
    for (Index i = 0; i < 2 * n; ++i) {
      const double exact = (1 + gap / 2) * std::acos(std::clamp(dot(cloud.normals[0], cloud.normals[i]), -1.0, 1.0));
      if (exact > 0.3) sum += map.distance[i] / exact - 1, ++count;
    }
    EXPECT_LT(std::abs(sum / count), 0.01) << share;
  }
}

TEST(Layers, AreTheTwoSidesOfAThinPlate) {
  Cloud plate = flat_cloud(3000);
  for (std::size_t i = 0; i < plate.points.size(); i += 2) plate.points[i][2] += 1e-4;
  EXPECT_TRUE(has_layers(pointcloud::PointCloudSurface::build(plate.points)));
}

TEST(Layers, AreNeitherNoiseNorBendsNorCorners) {
  const auto is_seen = [](const std::vector<Vec3>& points) {
    const auto cloud = pointcloud::PointCloudSurface::build(points);
    return has_layers(cloud) || cloud.details().layer_gap != 0;
  };
  EXPECT_FALSE(is_seen(flat_cloud(2000).points));
  for (const double share : {0.0, 0.1, 0.5, 1.0})
    EXPECT_FALSE(is_seen(with_noise(random_sphere(n), share * spacing()).points)) << share;
  EXPECT_FALSE(is_seen(even_sphere(n).points));
  EXPECT_FALSE(is_seen(folded_cloud(60, 6, std::numbers::pi / 2).points));
  for (const auto& [height, waves] : {std::pair(0.05, 10), {0.1, 10}, {0.03, 20}, {0.05, 20}})
    for (const int side : {30, 50, 80, 120}) {
      std::vector<Vec3> lattice;
      for (int i = 0; i < side * side; ++i) {
        const double x = static_cast<double>(i % side) / (side - 1), y = static_cast<double>(i / side) / (side - 1);
        lattice.push_back({x, y, height * std::sin(waves * x)});
      }
      EXPECT_FALSE(is_seen(lattice)) << height << ' ' << waves << ' ' << side;
    }
}

// Given sides tell the two sides of a wall apart: there is nothing to be told, and no noise.
TEST(Layers, WithSidesAreWalls) {
  Cloud wall = two_scans(0.2 * spacing());
  for (std::size_t i = n; i < wall.normals.size(); ++i) wall.normals[i] = -1.0 * wall.normals[i];
  const Solved solved(wall, true);
  EXPECT_FALSE(has_layers(solved.graph));
  EXPECT_EQ(solved.graph.details().components, 2);
  EXPECT_LT(solved.graph.details().noise, 0.02 * spacing());
}

}  // namespace
}  // namespace ahm::test
