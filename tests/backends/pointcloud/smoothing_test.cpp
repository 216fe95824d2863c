// Noisy points move onto the surface before the graph is built; near duplicates are one vertex; every row stays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string_view>

#include "ahm/error.hpp"
#include "ahm/surface/surface_triangles.hpp"
#include "ahm/util/vec.hpp"
#include "noisy_clouds.hpp"
#include "solved_cloud.hpp"

namespace ahm::test {
namespace {

using pointcloud::PointCloudSurface;

constexpr Index n = 5000;

double sphere_spacing() { return std::sqrt(4 * std::numbers::pi / n); }

Vec3 origin(const PointCloudSurface& cloud, Index row) {
  return cloud.graph().frame(cloud.vertex(Row(row)).index)->origin;
}

bool has_warning(const PointCloudSurface& cloud, std::string_view id) {
  return std::ranges::any_of(cloud.warnings(), [&](const Warning& w) { return w.id == id; });
}

/// Root mean square distance of the frames' origins from the unit sphere.
double distance_from_sphere(const PointCloudSurface& cloud) {
  double sum = 0;
  for (Index i = 0; i < n; ++i) sum += std::pow(norm(origin(cloud, i)) - 1, 2);
  return std::sqrt(sum / n);
}

TEST(Smoothing, MovesNoisyPointsOntoTheSphereAndKeepsEveryRow) {
  for (const auto& [share, left] : {std::pair(0.25, 0.6), {0.5, 0.5}, {1.0, 0.4}}) {
    const double noise = share * sphere_spacing();
    const Cloud noisy = with_noise(random_sphere(n), noise);
    const auto cloud = PointCloudSurface::build(noisy.points);
    EXPECT_LT(distance_from_sphere(cloud), left * noise) << share;
    EXPECT_GT(cloud.details().smoothed, 0.5 * n) << share;
    EXPECT_TRUE(has_warning(cloud, "smoothed")) << share;
    EXPECT_TRUE(std::ranges::equal(cloud.positions(), noisy.points));
    EXPECT_EQ(mapped_positions(cloud)[7], origin(cloud, 7)) << "pictures show the smoothed points";
    EXPECT_EQ(cloud.details().degenerate, 0) << share;
    for (Index i = 0; i < n; ++i) ASSERT_EQ(cloud.rows().vertices(Row(i)).size(), 1u) << share << " row " << i;
  }
}

TEST(Smoothing, LeavesCleanCloudsAloneAndCanBeTurnedOff) {
  for (const Cloud& cloud : {random_sphere(n), flat_cloud(2000), folded_cloud(60, 6, std::numbers::pi / 2)}) {
    const auto built = PointCloudSurface::build(cloud.points);
    EXPECT_EQ(built.details().smoothed, 0);
    EXPECT_FALSE(has_warning(built, "smoothed"));
  }
  const Cloud noisy = with_noise(random_sphere(n), sphere_spacing());
  const auto off = PointCloudSurface::build(noisy.points, {}, {.smooth = 0.0});
  EXPECT_EQ(off.details().smoothed, 0);
  for (Index i = 0; i < n; ++i) ASSERT_EQ(origin(off, i), noisy.points[i]);
  EXPECT_THROW(PointCloudSurface::build(noisy.points, {}, {.smooth = -1.0}), InvalidArgument);
}

TEST(Smoothing, ByARadiusFitsQuadrics) {
  const Cloud flat = flat_cloud(2000);
  const auto cloud = PointCloudSurface::build(flat.points, {}, {.smooth = 0.1});
  for (Index i = 0; i < 2000; ++i) ASSERT_LT(norm(origin(cloud, i) - flat.points[i]), 1e-13);
  const Cloud noisy = with_noise(random_sphere(n), 0.3 * sphere_spacing());
  EXPECT_LT(distance_from_sphere(PointCloudSurface::build(noisy.points, {}, {.smooth = 5 * sphere_spacing()})),
            0.3 * 0.3 * sphere_spacing());
}

TEST(Smoothing, DoesNotReachAnotherSheet) {
  const double h = 1 / std::sqrt(2000.0), gap = 4 * h;
  std::mt19937_64 random(5);
  std::normal_distribution<double> offset(0.0, 0.35 * h);
  std::vector<Vec3> sheets;
  for (const double sheet : {0.0, gap})
    for (const Vec2& p : flat_cloud(2000).plane) sheets.push_back({p[0], p[1], sheet + offset(random)});
  const auto cloud = PointCloudSurface::build(sheets);
  ASSERT_GT(cloud.details().smoothed, 0);
  double sum = 0;
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const double height = origin(cloud, static_cast<Index>(i))[2] - (i < 2000 ? 0 : gap);
    EXPECT_LT(std::abs(height), 0.5 * gap) << i;
    sum += height * height;
  }
  EXPECT_LT(std::sqrt(sum / static_cast<double>(sheets.size())), 0.6 * 0.35 * h);
}

TEST(Smoothing, DoesNotDependOnThreads) {
  const Cloud noisy = with_noise(random_sphere(9000), 0.03);
  const auto one = PointCloudSurface::build(noisy.points, {}, {.threads = 1}),
             four = PointCloudSurface::build(noisy.points, {}, {.threads = 4});
  ASSERT_GT(one.details().smoothed, 0);
  for (Index i = 0; i < 9000; ++i) ASSERT_EQ(origin(one, i), origin(four, i));
}

TEST(NearDuplicates, AreOneVertexAndChangeNoDistance) {
  const Cloud clean = even_sphere(3000);
  const RowLogMap expected = Solved(clean).map(0);
  for (const double scale : {1e-12, 1e-9, 1e-6, 1e-4}) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> offset(-scale, scale);
    Cloud doubled = clean;
    for (std::size_t i = 0; i < 3000; i += 3) {
      const Vec3& p = clean.points[i];
      for (int copy = 0; copy < 2; ++copy)
        doubled.points.push_back({p[0] + offset(random), p[1] + offset(random), p[2] + offset(random)});
    }
    const Solved solved(doubled);
    EXPECT_EQ(solved.graph.details().vertices, 3000) << scale;
    EXPECT_EQ(solved.graph.details().near_duplicates, 2000) << scale;
    EXPECT_TRUE(has_warning(solved.graph, "near_duplicates"));
    const RowLogMap map = solved.map(0);
    for (std::size_t i = 0; i < 3000; ++i)
      ASSERT_NEAR(map.distance[i], expected.distance[i], 1e-3 + 10 * scale) << scale;
    for (Index copy = 0; copy < 2000; ++copy)
      ASSERT_EQ(solved.graph.vertex(Row(3000 + copy)), solved.graph.vertex(Row(copy / 2 * 3)));
  }
}

TEST(NearDuplicates, ByChanceStayApart) {
  const auto cloud = PointCloudSurface::build(random_sphere(n).points);
  EXPECT_EQ(cloud.details().vertices, n);
  EXPECT_EQ(cloud.details().near_duplicates, 0);
}

TEST(CloudWarnings, TellOfSinglePrecisionFarFromTheOrigin) {
  Cloud cloud = flat_cloud(1000);
  const auto moved = [&](double by, bool single) {
    std::vector<Vec3> points = cloud.points;
    for (Vec3& p : points)
      for (double& x : p) x = single ? static_cast<double>(static_cast<float>(x + by)) : x + by;
    return PointCloudSurface::build(points);
  };
  EXPECT_FALSE(has_warning(moved(0, true), "coarse_coordinates"));
  EXPECT_FALSE(has_warning(moved(4e5, false), "coarse_coordinates"));
  for (const double spacing : {1.0, 0.5}) {
    std::vector<Vec3> grid;
    for (int i = 0; i < 900; ++i) grid.push_back({5e5 + spacing * (i % 30), 5.4e6 + spacing * (i / 30), 0});
    EXPECT_FALSE(has_warning(PointCloudSurface::build(grid), "coarse_coordinates")) << spacing;
  }
  const auto coarse = moved(4e5, true);  // steps of 1/32 at edges of about 0.04
  EXPECT_TRUE(has_warning(coarse, "coarse_coordinates"));
  EXPECT_EQ(coarse.details().coordinate_step, 1.0 / 32);
}

TEST(CloudMethod, IsHeatWhereTheCloudIsNoSurfaceOrNoisy) {
  EXPECT_EQ(PointCloudSurface::build(random_sphere(n).points).suggested_method(), Method::polar);
  EXPECT_EQ(PointCloudSurface::build(with_noise(random_sphere(n), 0.2 * sphere_spacing()).points).suggested_method(),
            Method::polar);
  EXPECT_EQ(PointCloudSurface::build(with_noise(random_sphere(n), 0.8 * sphere_spacing()).points).suggested_method(),
            Method::heat);
  std::vector<Vec3> sheets = flat_cloud(3000).points;  // one spacing apart
  for (std::size_t i = 0; i < 3000; ++i) sheets.push_back(sheets[(i + 1) % 3000] + Vec3{-0.007, 0.014, 0.014});
  EXPECT_EQ(PointCloudSurface::build(sheets).suggested_method(), Method::heat);
}

}  // namespace
}  // namespace ahm::test
