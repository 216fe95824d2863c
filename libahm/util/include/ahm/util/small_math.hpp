/// \file
/// Arithmetic on vectors of any dimension.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace ahm {

/// Converts an integer to std::size_t, before a product that could overflow an int.
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

/// The largest power of two that is at most |x|; 1 for 0. Lengths near x, divided by it, can be squared without overflow or underflow.
/// The division itself is exact.
inline double power_of_two_below(double x) {
  return x == 0 ? 1.0 : std::ldexp(1.0, std::clamp(std::ilogb(x), -1022, 1022));
}

namespace detail {

/// `length` of vectors whose squared length overflows or underflows.
[[gnu::noinline]] inline double scaled_length(std::span<const double> v) {
  double largest = 0;
  for (double x : v) largest = std::max(largest, std::abs(x));
  if (largest == 0 || std::isinf(largest)) return largest;
  const double unit = power_of_two_below(largest);
  double sum = 0;
  for (double x : v) sum += (x / unit) * (x / unit);
  return unit * std::sqrt(sum);
}

}  // namespace detail

/// Euclidean length without overflow or underflow. Scaling the vector by a power of two scales the result exactly.
inline double length(std::span<const double> v) {
  const double squared = dot(v, v);
  if ((squared > 1e-280 && squared < 1e280) || std::isnan(squared)) return std::sqrt(squared);
  return detail::scaled_length(v);
}

}  // namespace ahm
