// Every neighbour search finds the distances that brute force finds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ahm/conformance/clouds.hpp"
#include "ahm/pointcloud/neighbor_search.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"

namespace ahm::test {
namespace {

using pointcloud::NeighborSearchFactory;

struct NamedSearch {
  const char* name;
  NeighborSearchFactory make;
};

class Search : public testing::TestWithParam<NamedSearch> {};

void expect_brute_force_distances(const NeighborSearchFactory& make, const std::vector<Vec3>& points, std::size_t k) {
  const auto search = make(points);
  std::vector<Index> indices(k);
  std::vector<double> squared(k);
  for (std::size_t q = 0; q < points.size(); q += 7) {
    std::vector<double> expected;
    for (const Vec3& p : points)
      expected.push_back(std::pow(p[0] - points[q][0], 2) + std::pow(p[1] - points[q][1], 2) +
                         std::pow(p[2] - points[q][2], 2));
    std::sort(expected.begin(), expected.end());
    const Index found = search->nearest(points[q], indices, squared);
    ASSERT_EQ(found, static_cast<Index>(std::min(k, points.size())));
    for (Index r = 0; r < found; ++r) {
      ASSERT_NEAR(squared[r], expected[r], 1e-15 * (1 + expected[r]));
      const Vec3& p = points[indices[r]];
      ASSERT_NEAR(
          std::pow(p[0] - points[q][0], 2) + std::pow(p[1] - points[q][1], 2) + std::pow(p[2] - points[q][2], 2),
          squared[r], 1e-15 * (1 + squared[r]));
    }
  }
}

TEST_P(Search, FindsWhatBruteForceFinds) {
  expect_brute_force_distances(GetParam().make, random_sphere(2000).points, 31);
  expect_brute_force_distances(GetParam().make, flat_cloud(500).points, 8);
}

TEST_P(Search, FindsAllPointsWhenAskedForMore) {
  expect_brute_force_distances(GetParam().make, random_sphere(20).points, 31);
}

TEST_P(Search, SurvivesManyEqualPoints) {
  std::vector<Vec3> points(300, Vec3{1, 2, 3});
  points.push_back({1, 2, 4});
  expect_brute_force_distances(GetParam().make, points, 10);
}

TEST_P(Search, PrefersLowNumbersOfEquallyNearPoints) {
  std::vector<Vec3> lattice;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j)
      for (int k = 0; k < 9; ++k) lattice.push_back({1.0 * i, 1.0 * j, 1.0 * k});
  const auto search = GetParam().make(lattice);
  std::vector<Index> indices(24);
  std::vector<double> squared(24);
  for (std::size_t q = 0; q < lattice.size(); q += 5) {
    std::vector<std::pair<double, Index>> expected;
    for (std::size_t i = 0; i < lattice.size(); ++i) {
      const Vec3 &p = lattice[i], &o = lattice[q];
      expected.emplace_back(std::pow(p[0] - o[0], 2) + std::pow(p[1] - o[1], 2) + std::pow(p[2] - o[2], 2), i);
    }
    std::sort(expected.begin(), expected.end());
    search->nearest(lattice[q], indices, squared);
    for (std::size_t r = 0; r < indices.size(); ++r) ASSERT_EQ(indices[r], expected[r].second) << q << ", " << r;
  }
}

TEST_P(Search, BuildsTheSameGraph) {
  const Cloud sphere = random_sphere(3000);
  pointcloud::CloudOptions options;
  options.search = GetParam().make;
  const auto graph = pointcloud::PointCloudSurface::build(sphere.points, {}, options);
  const auto expected = pointcloud::PointCloudSurface::build(sphere.points);
  EXPECT_EQ(graph.graph().data().neighbors, expected.graph().data().neighbors);
}

const NamedSearch libraries[] = {
    {"nanoflann", pointcloud::nanoflann_search},
#ifdef AHM_WITH_FLANN
    {"flann", pointcloud::flann_search},
#endif
};
INSTANTIATE_TEST_SUITE_P(Libraries, Search, testing::ValuesIn(libraries),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace ahm::test
