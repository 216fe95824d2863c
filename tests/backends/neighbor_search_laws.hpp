/// \file
/// Laws of every neighbor search.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ahm/pointcloud/neighbor_search.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::test {

/// Squared distance and number of every point, in ascending order.
inline std::vector<std::pair<double, Index>> sorted_neighbors(const std::vector<Vec3>& points, const Vec3& query) {
  std::vector<std::pair<double, Index>> result;
  for (const Vec3& p : points) result.emplace_back(ahm::dot(p - query, p - query), static_cast<Index>(result.size()));
  std::sort(result.begin(), result.end());
  return result;
}

/// Expects the distances of brute force around every seventh point, and around a position next to it.
/// @param tolerance  of distances, where a search of lower precision selects another neighbor
inline void expect_nearest(const pointcloud::NeighborSearchFactory& make, const std::vector<Vec3>& points,
                           std::size_t k, double tolerance = 0) {
  const auto search = make(points);
  const std::size_t count = std::min(k, points.size());
  std::vector<Index> index(k, -7);
  std::vector<double> squared(k);
  for (std::size_t q = 0; q < points.size(); q += 7)
    for (const Vec3& query : {points[q], 0.9 * points[q] + 0.1 * points[0]}) {
      const auto expected = sorted_neighbors(points, query);
      ASSERT_EQ(search->nearest(query, index, squared), static_cast<Index>(count));
      for (std::size_t r = 0; r < count; ++r) {
        ASSERT_EQ(squared[r], ahm::dot(points[index[r]] - query, points[index[r]] - query));
        ASSERT_NEAR(std::sqrt(squared[r]), std::sqrt(expected[r].first), tolerance);
        ASSERT_TRUE(r == 0 || squared[r - 1] <= squared[r]);
      }
      if (query == points[q]) ASSERT_EQ(squared[0], 0);
      for (std::size_t r = count; r < k; ++r) ASSERT_EQ(index[r], -7);  // not written
    }
}

/// Expects that of equally near points, those with low numbers come first.
inline void expect_low_numbers_first(const pointcloud::NeighborSearchFactory& make, double spacing) {
  std::vector<Vec3> lattice;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j)
      for (int k = 0; k < 9; ++k) lattice.push_back({spacing * i, spacing * j, spacing * k});
  const auto search = make(lattice);
  std::vector<Index> index(24);
  std::vector<double> squared(24);
  for (std::size_t q = 0; q < lattice.size(); q += 5) {
    const auto expected = sorted_neighbors(lattice, lattice[q]);
    search->nearest(lattice[q], index, squared);
    for (std::size_t r = 0; r < index.size(); ++r) ASSERT_EQ(index[r], expected[r].second) << q << ", " << r;
  }
}

}  // namespace ahm::test
