// Points that are not joined to each other do not shape each other's planes; what is no surface is named.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ahm/maps/quality.hpp"
#include "ahm/util/small_math.hpp"
#include "noisy_clouds.hpp"
#include "solved_cloud.hpp"

namespace ahm::test {
namespace {

using pointcloud::PointCloudSurface;

const Warning* find_warning(const PointCloudSurface& cloud, std::string_view id, std::vector<Warning>& kept) {
  kept = cloud.warnings();
  const auto found = std::find_if(kept.begin(), kept.end(), [&](const Warning& w) { return w.id == id; });
  return found == kept.end() ? nullptr : &*found;
}

bool warns(const PointCloudSurface& cloud, std::string_view id) {
  std::vector<Warning> kept;
  return find_warning(cloud, id, kept) != nullptr;
}

/// 30 points of a tilted square of side 0.5, with spacing 0.1, from `corner` on.
std::vector<Vec3> island(const Vec3& corner, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> jitter(-0.03, 0.03);
  std::vector<Vec3> points;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 6; ++j) {
      const double u = 0.1 * i + jitter(random), v = 0.1 * j + jitter(random);
      points.push_back({corner[0] + 0.8 * u, corner[1] + v, corner[2] + 0.6 * u});
    }
  return points;
}

/// Distances within a flat part, rows [first, last), are those of space.
void expect_flat(const Solved& solved, const std::vector<Vec3>& points, Index first, Index last) {
  const RowLogMap map = solved.map(first);
  for (Index i = first; i < last; ++i) {
    ASSERT_EQ(map.status[i], Status::ok);
    ASSERT_NEAR(map.distance[i], norm(minus(points[i], points[first])), 1e-11);
  }
}

TEST(Islands, KeepTheirPlaneFarFromASurface) {
  Cloud cloud = random_sphere(3000);
  const auto first = static_cast<Index>(cloud.points.size());
  for (const Vec3& p : island({16, 0, 0}, 1)) cloud.points.push_back(p);
  const Solved solved(cloud);
  EXPECT_EQ(solved.graph.details().components, 2);
  expect_flat(solved, cloud.points, first, first + 30);
}

TEST(Islands, KeepTheirPlanesFarFromEachOther) {
  Cloud cloud;
  for (int k = 0; k < 4; ++k)
    for (const Vec3& p : island({15.0 * (k % 2), 15.0 * (k / 2), 3.0 * k}, 7 + static_cast<unsigned>(k)))
      cloud.points.push_back(p);
  const Solved solved(cloud);
  EXPECT_EQ(solved.graph.details().components, 4);
  for (Index k = 0; k < 4; ++k) expect_flat(solved, cloud.points, 30 * k, 30 * k + 30);
}

TEST(Islands, OfADenserScanAreNotPulledByPointsBeside) {
  // A dense flat part beside a sparse volume of points, none of which is joined to it.
  Cloud cloud;
  for (int k = 0; k < 2; ++k)
    for (const Vec3& p : island({0.5 * k * 0.8, 0, 0.5 * k * 0.6}, 3)) cloud.points.push_back(p);
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(10, 30);
  for (int i = 0; i < 60; ++i) cloud.points.push_back({uniform(random), uniform(random), uniform(random)});
  expect_flat(Solved(cloud), cloud.points, 0, 60);
}

TEST(Volumes, AreNamed) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Vec3> points(5000);
  for (Vec3& p : points) p = {uniform(random), uniform(random), uniform(random)};
  const auto volume = PointCloudSurface::build(points);
  std::vector<Warning> kept;
  const Warning* warning = find_warning(volume, "no_surface", kept);
  ASSERT_NE(warning, nullptr);
  EXPECT_EQ(warning->numbers, (std::vector<double>{static_cast<double>(volume.details().thick),
                                                   static_cast<double>(volume.details().vertices)}));
  EXPECT_GT(volume.details().thick, 4000);
}

// No way is shorter than the straight line in space: a vector that is, by a tenth, is wrong, however well it agrees with the
// distance of heat.
TEST(Volumes, HaveNoTrustedVectorsThatAreTooShort) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Cloud slab;
  for (int i = 0; i < 4000; ++i) slab.points.push_back({uniform(random), uniform(random), 0.15 * uniform(random)});
  const Solved solved(slab);
  const LogMap map = solved.solver.solve(solved.graph.source(Row(5)).source);
  const std::vector<double> quality = map_quality(solved.graph.graph(), map);
  Index too_short = 0;
  for (Index i = 0; i < solved.graph.graph().size(); ++i) {
    const double line = norm(minus(solved.graph.graph().frame(i)->origin, slab.points[5]));
    if (map.status(Vertex(i)) != Status::ok || !(line > 0.2)) continue;
    if (!(length(map.coordinates(Vertex(i))) < 0.9 * line)) continue;
    ++too_short;
    ASSERT_LE(quality[i], trusted_quality);
  }
  EXPECT_GT(too_short, 1000);
}

TEST(Volumes, AreNeitherCornersNorNoisySurfaces) {
  EXPECT_FALSE(warns(PointCloudSurface::build(folded_cloud(60, 6, std::numbers::pi / 2).points), "no_surface"));
  EXPECT_FALSE(warns(PointCloudSurface::build(flat_cloud(2000).points), "no_surface"));
  EXPECT_FALSE(warns(PointCloudSurface::build(with_noise(random_sphere(5000), 0.015).points), "no_surface"));
}

TEST(Noise, IsMeasured) {
  const double spacing = std::sqrt(4 * std::numbers::pi / 10000);
  for (double share : {0.05, 0.1, 0.2}) {
    // Two ends of an edge differ by the root of two deviations; the neighbours that shape a plane are among its witnesses.
    const auto cloud = PointCloudSurface::build(with_noise(random_sphere(10000), share * spacing).points);
    EXPECT_NEAR(cloud.details().noise / (std::sqrt(2.0) * share * spacing), 1, 0.1) << share;
  }
  const auto flat = PointCloudSurface::build(flat_cloud(2000).points);
  EXPECT_LT(flat.details().noise, 1e-14);
}

/// One cloud, and another 100 to the right of it.
std::vector<Vec3> beside(std::vector<Vec3> points, const std::vector<Vec3>& others) {
  for (const Vec3& p : others) points.push_back({p[0] + 100, p[1], p[2]});
  return points;
}

// What a part is made of does not depend on what else is in the file: neither its planes nor the lengths of its edges.
TEST(Parts, HaveTheirOwnNoise) {
  const Cloud clean = random_sphere(3000), noisy = with_noise(clean, std::sqrt(4 * std::numbers::pi / 3000));
  const auto alone = PointCloudSurface::build(noisy.points),
             with_clean = PointCloudSurface::build(beside(noisy.points, clean.points));
  ASSERT_GT(alone.details().smoothed, 2900);
  EXPECT_EQ(with_clean.details().smoothed, alone.details().smoothed);
  EXPECT_NEAR(with_clean.details().noise, alone.details().noise, 1e-12);
  EXPECT_EQ(with_clean.details().thick, alone.details().thick);
  for (Index i = 0; i < 3000; ++i) {
    const auto normal = [i](const PointCloudSurface& cloud) {
      return cloud.graph().frame(cloud.rows().vertices(Row(i)).front().index)->normal;
    };
    ASSERT_NEAR(std::abs(dot(normal(alone), normal(with_clean))), 1, 1e-9);
  }
}

TEST(Parts, HaveTheirOwnDistances) {
  const Cloud clean = even_sphere(2000);
  std::vector<Vec3> large = with_noise(random_sphere(1000), 0.1).points;
  for (Vec3& p : large) p = {30 * p[0], 30 * p[1], 30 * p[2]};
  Cloud both = clean;
  both.points = beside(clean.points, large);
  const Solved alone(clean), together(both);
  for (const Index source : {0, 700}) {
    const RowLogMap a = alone.map(source), b = together.map(source);
    for (Index i = 0; i < 2000; ++i) {
      ASSERT_NEAR(a.distance[i], b.distance[i], 1e-9);
      ASSERT_NEAR(std::hypot(a.u[i], a.v[i]), std::hypot(b.u[i], b.v[i]), 1e-9);
    }
  }
}

}  // namespace
}  // namespace ahm::test
