/// \file
/// Merges points at the same position. Not part of the public interface.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ahm/types.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::detail {

/// Merged points, numbered in the order of their first input points.
struct MergedPoints {
  std::vector<Index> number;  ///< merged point of each input point
  std::vector<Index> first;   ///< first input point of each merged point, ascending
};

/// Merges points with exactly equal positions. Points with a NaN coordinate are never merged.
inline MergedPoints weld(std::span<const Vec3> points) {
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  // Points with NaN go last: they have no place in a strict weak order.
  const auto is_number = [&](Index p) {
    return std::ranges::none_of(points[p], [](double x) { return std::isnan(x); });
  };
  const auto numbers = std::stable_partition(order.begin(), order.end(), is_number);
  std::stable_sort(order.begin(), numbers, [&](Index a, Index b) { return points[a] < points[b]; });
  std::vector<Index> first(points.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    first[order[k]] = k > 0 && points[order[k]] == points[order[k - 1]] ? first[order[k - 1]] : order[k];
  MergedPoints result;
  result.number.resize(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const bool is_first = first[p] == static_cast<Index>(p);
    result.number[p] = is_first ? static_cast<Index>(result.first.size()) : result.number[first[p]];
    if (is_first) result.first.push_back(static_cast<Index>(p));
  }
  return result;
}

struct CellHash {
  std::size_t operator()(const Vec3& cell) const {
    std::size_t hash = 0;
    for (double x : cell) hash = hash * 0x9E3779B97F4A7C15U + std::hash<double>()(x);
    return hash;
  }
};

/// Merges each point into the nearest earlier merged point within `reach` > 0, or else makes it a new merged point. Ties go to the
/// first one. Distances are measured to the first input point of a merged point, so chains of close points do not collapse into one.
/// Points that are not finite are never merged.
inline MergedPoints weld(std::span<const Vec3> points, double reach) {
  MergedPoints result;
  std::unordered_map<Vec3, Index, CellHash> last_in;  // last merged point in each cell of width `reach`
  std::vector<Index> before;                          // previous merged point in the same cell; -1: none
  const auto cell_of = [&](const Vec3& p, const Vec3& step) {
    Vec3 cell;
    for (std::size_t a = 0; a < 3; ++a) {
      const double number = std::floor(p[a] / reach);
      // If p / reach overflows, only points with the same coordinate are within reach.
      cell[a] = (std::isfinite(number) ? number + step[a] : p[a]) + 0.0;  // turns -0 into 0
    }
    return cell;
  };
  const auto nearest = [&](const Vec3& p) {
    Index best = -1;
    double least = reach;
    for (const double x : {-1.0, 0.0, 1.0})
      for (const double y : {-1.0, 0.0, 1.0})
        for (const double z : {-1.0, 0.0, 1.0}) {
          const auto found = last_in.find(cell_of(p, {x, y, z}));
          for (Index number = found == last_in.end() ? -1 : found->second; number >= 0; number = before[number]) {
            const double away = distance(points[result.first[number]], p);
            if (away < least || (away == least && (best < 0 || number < best))) best = number, least = away;
          }
        }
    return best;
  };
  for (std::size_t p = 0; p < points.size(); ++p) {
    const bool finite = is_finite(points[p]);
    Index number = finite ? nearest(points[p]) : -1;
    if (number < 0) {
      number = static_cast<Index>(result.first.size());
      result.first.push_back(static_cast<Index>(p));
      before.push_back(-1);
      if (finite) {
        const auto [place, is_new] = last_in.emplace(cell_of(points[p], {0, 0, 0}), number);
        if (!is_new) before.back() = std::exchange(place->second, number);
      }
    }
    result.number.push_back(number);
  }
  return result;
}

}  // namespace ahm::detail
