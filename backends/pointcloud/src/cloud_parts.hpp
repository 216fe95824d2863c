/// \file
/// Parts of a cloud that share no neighbors.
#pragma once

#include <span>
#include <vector>

#include "ahm/types.hpp"
#include "tangent_planes.hpp"

namespace ahm::pointcloud {

/// Number of points that a thread processes at a time.
inline constexpr Offset points_per_task = 4096;

/// Parts of a cloud that share no neighbors, numbered in the order of their first points.
struct CloudParts {
  std::vector<Index> of_point;  ///< part of each point
  Index count = 0;

  explicit CloudParts(const Neighborhoods& neighborhoods);
  /// All points in one part.
  explicit CloudParts(Index points) : of_point(static_cast<std::size_t>(points), 0), count(1) {}
  /// Points of each part, ascending.
  std::vector<std::vector<Index>> points() const;
};

/// One number for each part, or one number for all points.
class PerPart {
 public:
  PerPart(double of_all = 0) : values_{of_all} {}  // NOLINT(google-explicit-constructor): tiles use one value
  /// @param part_of_point  must outlive this object
  PerPart(std::span<const Index> part_of_point, std::vector<double> values)
      : part_(part_of_point), values_(std::move(values)) {}

  double at(Index point) const { return part_.empty() ? values_.front() : values_[part_[point]]; }

 private:
  std::span<const Index> part_;
  std::vector<double> values_;
};

}  // namespace ahm::pointcloud
