/// \file
/// Vectors of a few numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace ahm {

inline bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

inline double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// Euclidean length without overflow.
inline double length(std::span<const double> v) {
  if (v.size() == 2) return std::hypot(v[0], v[1]);
  double sum = 0;
  for (double x : v) sum = std::hypot(sum, x);
  return sum;
}

}  // namespace ahm
