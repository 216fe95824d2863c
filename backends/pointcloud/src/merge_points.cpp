#include "merge_points.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {
namespace {

/// Points nearer to each other than this fraction of the spacing are always merged.
constexpr double equal_share = 1e-3;
/// Points nearer than this fraction of the spacing are merged only if more than `max_chance_share` of all points have such a
/// neighbor. Of randomly sampled points 0.4 % have one.
constexpr double near_share = 0.05, max_chance_share = 0.01;

struct Representatives {
  std::vector<Index> of_point;  ///< representative of each point: the point itself, or an earlier one near it
  Index merged = 0;
};

/// @param share  largest distance of merged points, as a fraction of the spacing
Representatives find_representatives(const CleanPoints& cloud, const Neighborhoods& neighborhoods, double share) {
  const auto n = static_cast<Index>(cloud.points.size());
  Representatives result{std::vector<Index>(cloud.points.size(), -1)};
  for (Index i = 0; i < n; ++i) {
    if (result.of_point[i] >= 0) continue;
    result.of_point[i] = i;
    const double reach = share * spacing_at(neighborhoods, i);
    for (const Index j : neighborhoods.of(i)) {
      if (!(norm(cloud.points[j] - cloud.points[i]) <= reach)) break;
      if (result.of_point[j] >= 0) continue;
      result.of_point[j] = i;
      ++result.merged;
    }
  }
  return result;
}

/// Keeps only the points that represent themselves.
/// @return for each point, the new number of its representative
std::vector<Index> keep_representatives(const std::vector<Index>& representatives, CleanPoints& cloud) {
  std::vector<Index> number(representatives.size());
  Index kept = 0;
  for (Index i = 0; i < static_cast<Index>(number.size()); ++i) {
    if (representatives[i] != i) continue;
    cloud.points[kept] = cloud.points[i];
    cloud.input[kept] = cloud.input[i];
    if (!cloud.smoothed.empty()) cloud.smoothed[kept] = cloud.smoothed[i];
    number[i] = kept++;
  }
  cloud.points.resize(static_cast<std::size_t>(kept));
  cloud.input.resize(cloud.points.size());
  if (!cloud.smoothed.empty()) cloud.smoothed.resize(cloud.points.size());
  for (std::size_t i = 0; i < number.size(); ++i) number[i] = number[representatives[i]];
  for (Index& clean : cloud.clean_of_input)
    if (clean >= 0) clean = number[clean];
  return number;
}

/// Removes merged points from the neighborhoods and closes the gaps.
/// @return the points that lost a neighbor, ascending
std::vector<Index> renumber(const std::vector<Index>& representatives, const std::vector<Index>& number,
                            std::size_t kept, Neighborhoods& neighborhoods) {
  std::vector<Index> incomplete;
  Offset end = 0;
  for (Index i = 0; i < static_cast<Index>(number.size()); ++i) {
    if (representatives[i] != i) continue;
    const auto neighbors = neighborhoods.of(i);
    const Offset begin = end;
    for (const Index j : neighbors)
      if (representatives[j] == j) neighborhoods.indices[end++] = number[j];
    if (end - begin < static_cast<Offset>(neighbors.size())) incomplete.push_back(number[i]);
    neighborhoods.radius[number[i]] = neighborhoods.radius[i];
    neighborhoods.begin[number[i]] = begin;
  }
  neighborhoods.radius.resize(kept);
  neighborhoods.begin.resize(kept + 1);
  neighborhoods.begin[kept] = end;
  neighborhoods.indices.resize(static_cast<std::size_t>(end));
  neighborhoods.k = std::min(neighborhoods.k, static_cast<Index>(kept) - 1);
  return incomplete;
}

}  // namespace

Index merge_near_points(CleanPoints& cloud, std::unique_ptr<NeighborSearch>& search, const CloudOptions& options,
                        Neighborhoods& neighborhoods) {
  Representatives found = find_representatives(cloud, neighborhoods, near_share);
  if (found.merged <= max_chance_share * static_cast<double>(cloud.points.size()) && found.merged > 0)
    found = find_representatives(cloud, neighborhoods, equal_share);
  if (found.merged == 0) return 0;
  const std::vector<Index> number = keep_representatives(found.of_point, cloud);
  const std::vector<Index> incomplete = renumber(found.of_point, number, cloud.points.size(), neighborhoods);
  search = options.search(cloud.points);
  refill_neighborhoods(cloud, *search, incomplete, options, neighborhoods);
  return found.merged;
}

}  // namespace ahm::pointcloud
