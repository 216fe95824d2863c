#include "read/weld.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ahm::io {

Welded weld(std::span<const Vec3> points) {
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

}  // namespace ahm::io
