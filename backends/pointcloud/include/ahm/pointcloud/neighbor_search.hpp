/// \file
/// Search for the nearest points of a cloud.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::pointcloud {

/// Squared distance and index of a point.
using Candidate = std::pair<double, Index>;

/// Stores the `count` nearest candidates in `indices` and `squared_distances`; of equally near ones, those with lower indices.
/// Reorders the candidates. Not part of the public interface.
inline void take_nearest(std::vector<Candidate>& candidates, std::size_t count, std::span<Index> indices,
                         std::span<double> squared_distances) {
  std::sort(candidates.begin(), candidates.end());
  for (std::size_t i = 0; i < count; ++i) {
    squared_distances[i] = candidates[i].first;
    indices[i] = candidates[i].second;
  }
}

/// A search structure over a fixed set of points. `nearest` may be called from many threads at once.
class NeighborSearch {
 public:
  virtual ~NeighborSearch() = default;

  /// Finds the `indices.size()` points nearest to `query`, nearest first. Of points at equal distances, lower indices come
  /// first. A query that is itself a point of the set finds itself.
  /// @param squared_distances  same length as `indices`
  /// @return the number of points found: the smaller of `indices.size()` and the number of points
  virtual Index nearest(const Vec3& query, std::span<Index> indices, std::span<double> squared_distances) const = 0;
};

/// Makes a search over `points`, which must be finite and outlive it.
using NeighborSearchFactory = std::function<std::unique_ptr<NeighborSearch>(std::span<const Vec3> points)>;

/// k-d tree of nanoflann, double precision. The default.
std::unique_ptr<NeighborSearch> nanoflann_search(std::span<const Vec3> points);

/// Single k-d tree of FLANN, double precision, exact.
/// @throws InvalidArgument (a build without FLANN, AHM_WITH_FLANN=OFF)
std::unique_ptr<NeighborSearch> flann_search(std::span<const Vec3> points);

/// Rows of the points within a straight-line distance of `center`, ascending. Ignores points that are not finite.
///
/// A path along the surface is never shorter than the straight line, so the result contains every point within `radius` along the
/// surface. For maps, use 1.5 times the radius of interest: the border of the selection affects the map, and the diffusion time
/// depends on the selected points.
std::vector<Row> radius_search(std::span<const Vec3> points, const Vec3& center, double radius);

}  // namespace ahm::pointcloud
