/// \file
/// Vectors of a few numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace ahm {

/// An index among sizes: before a product that an int might not hold.
template <class Integer>
constexpr std::size_t to_size(Integer i) {
  return static_cast<std::size_t>(i);
}

inline bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

inline double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// The power of two next below |x|, 1 for 0: in units of it squares of lengths near x neither overflow nor underflow, and
/// no bit of them changes.
inline double power_of_two_below(double x) {
  return x == 0 ? 1.0 : std::ldexp(1.0, std::clamp(std::ilogb(x), -1022, 1022));
}

/// Euclidean length without overflow; of vectors times a power of two the same bits.
inline double length(std::span<const double> v) {
  const double squared = dot(v, v);
  if ((squared > 1e-280 && squared < 1e280) || std::isnan(squared)) return std::sqrt(squared);
  double largest = 0;
  for (double x : v) largest = std::max(largest, std::abs(x));
  if (largest == 0 || std::isinf(largest)) return largest;
  const double unit = power_of_two_below(largest);
  double sum = 0;
  for (double x : v) sum += (x / unit) * (x / unit);
  return unit * std::sqrt(sum);
}

}  // namespace ahm
