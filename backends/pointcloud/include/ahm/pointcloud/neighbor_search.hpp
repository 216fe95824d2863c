/// \file
/// k nearest neighbours behind one small interface.
///
/// \code
/// auto search = ahm::pointcloud::nanoflann_search(points);
/// std::vector<ahm::Index> index(30);
/// std::vector<double> squared(30);
/// ahm::Index found = search->nearest(points[0], index, squared);   // the point itself comes first
/// \endcode
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "ahm/types.hpp"

namespace ahm::pointcloud {

/// A search structure over a fixed set of points. `nearest` may be called from many threads at once.
class NeighborSearch {
 public:
  virtual ~NeighborSearch() = default;

  /// The `indices.size()` points nearest to `query`, nearest first, of points at equal distances those of lower numbers; a
  /// query that is itself a point of the set finds itself.
  /// @param squared_distances  same length as `indices`
  /// @return the number found: the smaller of `indices.size()` and the number of points
  virtual Index nearest(const Vec3& query, std::span<Index> indices, std::span<double> squared_distances) const = 0;
};

/// Makes a search over `points`, which must be finite and outlive it.
using NeighborSearchFactory = std::function<std::unique_ptr<NeighborSearch>(std::span<const Vec3> points)>;

/// k-d tree of nanoflann, double precision. The default.
std::unique_ptr<NeighborSearch> nanoflann_search(std::span<const Vec3> points);

/// Single k-d tree of FLANN, double precision, exact.
/// @throws InvalidArgument in a build without FLANN (AHM_WITH_FLANN=OFF)
std::unique_ptr<NeighborSearch> flann_search(std::span<const Vec3> points);

}  // namespace ahm::pointcloud
