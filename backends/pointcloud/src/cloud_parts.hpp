/// \file
/// The parts of a cloud that share no neighbours. What is measured of one part must not depend on what else is in the file.
#pragma once

#include <span>
#include <vector>

#include "tangent_planes.hpp"

namespace ahm::pointcloud {

/// Parts that share no neighbours, numbered in the order of their first points.
struct CloudParts {
  std::vector<Index> of_point;
  Index count = 0;

  explicit CloudParts(const Neighborhoods& neighborhoods);
  /// All as one part.
  explicit CloudParts(Index points) : of_point(static_cast<std::size_t>(points), 0), count(1) {}
  /// The points of each part, ascending.
  std::vector<std::vector<Index>> points() const;
};

/// A number for each part, or one for all.
class PerPart {
 public:
  PerPart(double of_all = 0) : values_{of_all} {}  // NOLINT(google-explicit-constructor): tiles measure one for all
  /// @param part_of_point  must outlive this object
  PerPart(std::span<const Index> part_of_point, std::vector<double> values)
      : part_(part_of_point), values_(std::move(values)) {}

  double at(Index point) const { return part_.empty() ? values_.front() : values_[part_[point]]; }

 private:
  std::span<const Index> part_;
  std::vector<double> values_;
};

}  // namespace ahm::pointcloud
