#include "merge_points.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {
namespace {

/// For each point the one that takes its place: itself, or an earlier one nearer than `share` of the spacing.
/// @return empty where all stay
std::vector<Index> find_representatives(const CleanPoints& cloud, const Neighborhoods& neighborhoods, double share) {
  const auto n = static_cast<Index>(cloud.points.size());
  std::vector<Index> result(cloud.points.size(), -1);
  bool any = false;
  for (Index i = 0; i < n; ++i) {
    if (result[i] >= 0) continue;
    result[i] = i;
    const double reach = share * spacing_at(neighborhoods, i);
    for (const Index j : neighborhoods.of(i)) {
      if (!(norm(cloud.points[j] - cloud.points[i]) <= reach)) break;
      if (result[j] >= 0) continue;
      result[j] = i;
      any = true;
    }
  }
  if (!any) result.clear();
  return result;
}

/// Keeps the points that represent themselves.
/// @return the new number of each point: of its representative
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

/// Closes the gaps that points and neighbors leave which others represent.
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
  const std::size_t before = cloud.points.size();
  const std::vector<Index> representatives = find_representatives(cloud, neighborhoods, options.merge);
  if (representatives.empty()) return 0;
  const std::vector<Index> number = keep_representatives(representatives, cloud);
  const std::vector<Index> incomplete = renumber(representatives, number, cloud.points.size(), neighborhoods);
  search = options.search(cloud.points);
  refill_neighborhoods(cloud, *search, incomplete, options, neighborhoods);
  return static_cast<Index>(before - cloud.points.size());
}

}  // namespace ahm::pointcloud
