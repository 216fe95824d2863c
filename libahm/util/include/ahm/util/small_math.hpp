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

/// Euclidean length without overflow.
inline double length(std::span<const double> v) {
  if (v.size() == 2) return std::hypot(v[0], v[1]);
  double sum = 0;
  for (double x : v) sum = std::hypot(sum, x);
  return sum;
}

}  // namespace ahm
