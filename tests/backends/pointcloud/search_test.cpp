// Every neighbor search finds the distances that brute force finds.
#include "clouds.hpp"

namespace ahm::test {
namespace {

struct NamedSearch {
  const char* name;
  pointcloud::NeighborSearchFactory make;
};

class Search : public testing::TestWithParam<NamedSearch> {
 protected:
  void expect_brute_force_distances(const std::vector<Vec3>& points, std::size_t k) const {
    const auto search = GetParam().make(points);
    std::vector<Index> indices(k);
    std::vector<double> squared(k);
    for (std::size_t q = 0; q < points.size(); q += 7) {
      const auto squared_distance = [&](const Vec3& p) { return dot(p - points[q], p - points[q]); };
      std::vector<double> expected;
      for (const Vec3& p : points) expected.push_back(squared_distance(p));
      std::sort(expected.begin(), expected.end());
      const Index found = search->nearest(points[q], indices, squared);
      ASSERT_EQ(found, static_cast<Index>(std::min(k, points.size())));
      for (Index r = 0; r < found; ++r) {
        ASSERT_NEAR(squared[r], expected[r], 1e-15 * (1 + expected[r]));
        ASSERT_NEAR(squared_distance(points[indices[r]]), squared[r], 1e-15 * (1 + squared[r]));
      }
    }
  }
};

TEST_P(Search, FindsWhatBruteForceFinds) {
  expect_brute_force_distances(random_sphere(2000).points, 31);
  expect_brute_force_distances(flat_cloud(500).points, 8);
  expect_brute_force_distances(random_sphere(20).points, 31);  // more than there are
  std::vector<Vec3> equal(300, Vec3{1, 2, 3});
  equal.push_back({1, 2, 4});
  expect_brute_force_distances(equal, 10);
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
    for (const Vec3& p : lattice)
      expected.emplace_back(dot(p - lattice[q], p - lattice[q]), static_cast<Index>(expected.size()));
    std::sort(expected.begin(), expected.end());
    search->nearest(lattice[q], indices, squared);
    for (std::size_t r = 0; r < indices.size(); ++r) ASSERT_EQ(indices[r], expected[r].second) << q << ", " << r;
  }
}

TEST_P(Search, BuildsTheSameGraph) {
  const Cloud sphere = random_sphere(3000);
  const auto surface = PointCloudSurface::build(sphere.points, {}, {.search = GetParam().make}),
             expected = PointCloudSurface::build(sphere.points);
  EXPECT_EQ(surface.graph().data().neighbors, expected.graph().data().neighbors);
}

const NamedSearch libraries[] = {
    {"nanoflann", pointcloud::nanoflann_search},
#ifdef AHM_WITH_FLANN
    {"flann", pointcloud::flann_search},
#endif
};
INSTANTIATE_TEST_SUITE_P(Libraries, Search, testing::ValuesIn(libraries),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(RadiusSearch, FindsTheFinitePointsWithinTheRadiusInTheirOrder) {
  Cloud cloud = random_sphere(2000);
  cloud.points[7] = {NAN, 0, 0};
  cloud.points[31][2] = INFINITY;
  const Vec3 center = cloud.points[40];
  std::vector<Row> near;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (norm(cloud.points[i] - center) <= 0.5) near.emplace_back(static_cast<Index>(i));
  EXPECT_EQ(pointcloud::radius_search(cloud.points, center, 0.5), near);
  EXPECT_GT(near.size(), 50u);
  EXPECT_EQ(pointcloud::radius_search(cloud.points, center, 10).size(), 1998u);
}

}  // namespace
}  // namespace ahm::test
