/// \file
/// Mean and median of weighted points of R^d.
#pragma once

#include <span>
#include <vector>

namespace ahm {

/// Points as K x d numbers with K weights > 0.
struct FlatPoints {
  std::size_t dimension = 0;
  std::vector<double> coordinates;
  std::vector<double> weights;

  std::size_t size() const { return weights.size(); }
  std::span<const double> operator[](std::size_t k) const {
    return std::span(coordinates).subspan(k * dimension, dimension);
  }
};

/// sum w z / sum w.
std::vector<double> flat_mean(const FlatPoints& points);

/// Where sum w |z - x| is least, to rounding; one of these places where there are several.
std::vector<double> flat_median(const FlatPoints& points);

/// Distances of the points from x, one per point.
std::vector<double> distances(const FlatPoints& points, std::span<const double> x);

}  // namespace ahm
