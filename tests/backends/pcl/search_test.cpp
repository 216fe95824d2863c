#include "ahm/pcl/search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "ahm/error.hpp"
#include "clouds.hpp"
#include "support/expect_error.hpp"

namespace ahm::pcl_bridge {
namespace {

using test::random_box;
using test::squared_distance;

/// Points in ascending order of distance, then number.
std::vector<std::pair<double, Index>> brute_force(const std::vector<Vec3>& points, const Vec3& query) {
  std::vector<std::pair<double, Index>> result;
  for (const Vec3& p : points) result.emplace_back(squared_distance(p, query), static_cast<Index>(result.size()));
  std::sort(result.begin(), result.end());
  return result;
}

TEST(KdTreeSearch, AgreesWithBruteForceAnywhereAtEveryScale) {
  struct Case {
    Vec3 center;
    double size;
    std::size_t n, k;
  };
  for (const auto& [center, size, n, k] : {Case{{0, 0, 0}, 1, 3000, 30}, Case{{5e5, 5.4e6, 1e3}, 10, 2000, 20},
                                           Case{{0, 0, 0}, 1e-100, 1000, 10}, Case{{0, 0, 0}, 1e100, 1000, 10}}) {
    const auto points = random_box(n, center, size);
    const auto search = kdtree_search(points);
    std::vector<Index> index(k);
    std::vector<double> squared(k);
    for (std::size_t q = 0; q < n; q += 37) {
      const auto exact = brute_force(points, points[q]);
      ASSERT_EQ(search->nearest(points[q], index, squared), static_cast<Index>(k));
      EXPECT_EQ(index[0], static_cast<Index>(q));
      EXPECT_TRUE(std::is_sorted(squared.begin(), squared.end()));
      for (std::size_t i = 0; i < k; ++i) {
        EXPECT_EQ(squared[i], squared_distance(points[q], points[index[i]]));
        // Single precision, relative to the cloud, decides which point is the last one.
        EXPECT_NEAR(std::sqrt(squared[i]), std::sqrt(exact[i].first), 4e-7 * size);
      }
    }
  }
}

TEST(KdTreeSearch, PrefersLowNumbersOfEquallyNearPoints) {
  std::vector<Vec3> lattice;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j)
      for (int k = 0; k < 9; ++k) lattice.push_back({0.1 * i, 0.1 * j, 0.1 * k});
  const auto search = kdtree_search(lattice);
  std::vector<Index> index(24);
  std::vector<double> squared(24);
  for (std::size_t q = 0; q < lattice.size(); q += 5) {
    const auto expected = brute_force(lattice, lattice[q]);
    search->nearest(lattice[q], index, squared);
    for (std::size_t r = 0; r < index.size(); ++r) ASSERT_EQ(index[r], expected[r].second) << q << ", " << r;
  }
}

TEST(KdTreeSearch, FindsNoMoreThanThereAre) {
  const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, equal(500, Vec3{1, 2, 3});
  std::vector<Index> index(5, -7);
  std::vector<double> squared(5);
  ASSERT_EQ(kdtree_search(points)->nearest({0.9, 0, 0}, index, squared), 3);
  EXPECT_EQ(index, (std::vector<Index>{1, 0, 2, -7, -7}));
  ASSERT_EQ(kdtree_search(equal)->nearest(equal[0], index, squared), 5);
  EXPECT_EQ(squared, std::vector<double>(5, 0.0));
}

TEST(KdTreeSearch, MayBeCalledFromManyThreads) {
  const auto points = random_box(2000);
  const auto search = kdtree_search(points);
  const auto all = [&] {
    std::vector<Index> result, index(8);
    std::vector<double> squared(8);
    for (const Vec3& p : points) {
      search->nearest(p, index, squared);
      result.insert(result.end(), index.begin(), index.end());
    }
    return result;
  };
  const auto expected = all();
  std::vector<std::vector<Index>> results(4);
  {
    std::vector<std::jthread> threads;
    for (auto& r : results) threads.emplace_back([&] { r = all(); });
  }
  for (const auto& r : results) EXPECT_EQ(r, expected);
}

TEST(KdTreeSearch, NamesTheNonFinitePoint) {
  auto points = random_box(10);
  points[7][1] = NAN;
  test::expect_error<InvalidGeometry>([&] { kdtree_search(points); }, "point 7");
}

TEST(Version, HasAPoint) { EXPECT_NE(version().find('.'), std::string::npos); }

}  // namespace
}  // namespace ahm::pcl_bridge
