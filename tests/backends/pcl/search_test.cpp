#include "ahm/pcl/search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "ahm/error.hpp"
#include "clouds.hpp"

namespace ahm::pcl_bridge {
namespace {

using test::random_box;
using test::squared_distance;

std::vector<double> brute_force(const std::vector<Vec3>& points, const Vec3& query, std::size_t k) {
  std::vector<double> d;
  for (const Vec3& p : points) d.push_back(squared_distance(p, query));
  std::sort(d.begin(), d.end());
  d.resize(std::min(k, d.size()));
  return d;
}

/// Single precision relative to the cloud: what a neighbour at the last place may be off by.
void expect_agrees(const std::vector<Vec3>& points, double extent, std::size_t k) {
  const auto search = kdtree_search(points);
  std::vector<Index> index(k);
  std::vector<double> squared(k);
  for (std::size_t q = 0; q < points.size(); q += 37) {
    const auto exact = brute_force(points, points[q], k);
    ASSERT_EQ(search->nearest(points[q], index, squared), static_cast<Index>(exact.size()));
    EXPECT_EQ(index[0], static_cast<Index>(q));
    EXPECT_TRUE(std::is_sorted(squared.begin(), squared.begin() + static_cast<std::ptrdiff_t>(exact.size())));
    for (std::size_t i = 0; i < exact.size(); ++i) {
      EXPECT_EQ(squared[i], squared_distance(points[q], points[index[i]]));
      EXPECT_NEAR(std::sqrt(squared[i]), std::sqrt(exact[i]), 4e-7 * extent);
    }
  }
}

TEST(KdTreeSearch, AgreesWithBruteForce) { expect_agrees(random_box(3000), 1.0, 30); }

TEST(KdTreeSearch, KeepsTheShapeOfACloudFarFromTheOrigin) {
  expect_agrees(random_box(2000, {5e5, 5.4e6, 1e3}, 10.0), 10.0, 20);
}

TEST(KdTreeSearch, IsIndependentOfScale) {
  expect_agrees(random_box(1000, {0, 0, 0}, 1e-100), 1e-100, 10);
  expect_agrees(random_box(1000, {0, 0, 0}, 1e100), 1e100, 10);
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
    std::vector<std::pair<double, Index>> expected;
    for (std::size_t i = 0; i < lattice.size(); ++i)
      expected.emplace_back(squared_distance(lattice[q], lattice[i]), static_cast<Index>(i));
    std::sort(expected.begin(), expected.end());
    search->nearest(lattice[q], index, squared);
    for (std::size_t r = 0; r < index.size(); ++r) ASSERT_EQ(index[r], expected[r].second) << q << ", " << r;
  }
}

TEST(KdTreeSearch, FindsNoMoreThanThereAre) {
  const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  const auto search = kdtree_search(points);
  std::vector<Index> index(10, -7);
  std::vector<double> squared(10);
  ASSERT_EQ(search->nearest({0.9, 0, 0}, index, squared), 3);
  EXPECT_EQ(index[0], 1);
  EXPECT_EQ(index[1], 0);
  EXPECT_EQ(index[2], 2);
  EXPECT_EQ(index[3], -7);
}

TEST(KdTreeSearch, SurvivesManyEqualPoints) {
  const std::vector<Vec3> points(500, Vec3{1, 2, 3});
  const auto search = kdtree_search(points);
  std::vector<Index> index(5);
  std::vector<double> squared(5);
  ASSERT_EQ(search->nearest(points[0], index, squared), 5);
  for (double d : squared) EXPECT_EQ(d, 0.0);
}

TEST(KdTreeSearch, GivesManyThreadsTheSameAnswers) {
  const auto points = random_box(2000);
  const auto search = kdtree_search(points);
  auto all = [&] {
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
  points[7][1] = std::numeric_limits<double>::quiet_NaN();
  try {
    kdtree_search(points);
    FAIL() << "accepted a NaN";
  } catch (const InvalidGeometry& e) {
    EXPECT_NE(std::string(e.what()).find("point 7"), std::string::npos) << e.what();
  }
}

TEST(Version, LooksLikeAVersion) { EXPECT_NE(version().find('.'), std::string::npos); }

}  // namespace
}  // namespace ahm::pcl_bridge
