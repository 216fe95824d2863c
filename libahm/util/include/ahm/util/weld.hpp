/// \file
/// One number for points at the same place. Not part of the public interface.
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

struct Welded {
  std::vector<Index> number;  ///< per point
  std::vector<Index> first;   ///< per number: the first point that has it, ascending
};

/// Gives points at exactly equal positions one number. NaN equals nothing, itself included.
inline Welded weld(std::span<const Vec3> points) {
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  // NaN is put last to keep the order strict.
  const auto is_number = [&](Index p) {
    return std::ranges::none_of(points[p], [](double x) { return std::isnan(x); });
  };
  const auto numbers = std::stable_partition(order.begin(), order.end(), is_number);
  std::stable_sort(order.begin(), numbers, [&](Index a, Index b) { return points[a] < points[b]; });
  std::vector<Index> first(points.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    first[order[k]] = k > 0 && points[order[k]] == points[order[k - 1]] ? first[order[k - 1]] : order[k];
  Welded result;
  result.number.resize(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const bool new_one = first[p] == static_cast<Index>(p);
    result.number[p] = new_one ? static_cast<Index>(result.first.size()) : result.number[first[p]];
    if (new_one) result.first.push_back(static_cast<Index>(p));
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

/// Gives a point the number of the nearest point before it that has one of its own and is at most `reach` > 0 away, of
/// equally near ones the first. Numbers never lie farther apart than that from their points, however long a chain of points
/// is. A point that is not finite equals nothing, itself included.
inline Welded weld(std::span<const Vec3> points, double reach) {
  Welded result;
  std::unordered_map<Vec3, Index, CellHash> last_in;  // the numbers of a cell as wide as the reach, linked
  std::vector<Index> before;
  const auto cell_of = [&](const Vec3& p, const Vec3& step) {
    Vec3 cell;
    for (std::size_t a = 0; a < 3; ++a) {
      const double number = std::floor(p[a] / reach);
      // Where there are more cells than numbers, only equal coordinates lie within the reach.
      cell[a] = (std::isfinite(number) ? number + step[a] : p[a]) + 0.0;  // no -0
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
