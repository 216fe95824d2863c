// The neighbor searches for clouds.
#include "backends/neighbor_search_laws.hpp"
#include "clouds.hpp"

namespace ahm::test {
namespace {

struct NamedSearch {
  const char* name;
  pointcloud::NeighborSearchFactory make;
};

class Search : public testing::TestWithParam<NamedSearch> {};

TEST_P(Search, FindsWhatBruteForceFinds) {
  expect_nearest(GetParam().make, random_sphere(2000).points, 31);
  expect_nearest(GetParam().make, flat_cloud(500).points, 8);
  expect_nearest(GetParam().make, random_sphere(20).points, 31);  // more than there are
  std::vector<Vec3> equal(300, Vec3{1, 2, 3});
  equal.push_back({1, 2, 4});
  expect_nearest(GetParam().make, equal, 10);
}

TEST_P(Search, PrefersLowNumbersOfEquallyNearPoints) { expect_low_numbers_first(GetParam().make, 1); }

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
