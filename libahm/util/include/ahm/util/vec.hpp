/// \file
/// Arithmetic on 2D and 3D vectors. Not part of the public interface.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "ahm/types.hpp"

namespace ahm {

template <std::size_t d>
std::array<double, d> operator+(const std::array<double, d>& a, const std::array<double, d>& b) {
  std::array<double, d> c;
  for (std::size_t k = 0; k < d; ++k) c[k] = a[k] + b[k];
  return c;
}

template <std::size_t d>
std::array<double, d> operator-(const std::array<double, d>& a, const std::array<double, d>& b) {
  std::array<double, d> c;
  for (std::size_t k = 0; k < d; ++k) c[k] = a[k] - b[k];
  return c;
}

template <std::size_t d>
std::array<double, d> operator-(const std::array<double, d>& a) {
  std::array<double, d> c;
  for (std::size_t k = 0; k < d; ++k) c[k] = -a[k];
  return c;
}

template <std::size_t d>
std::array<double, d> operator*(double s, const std::array<double, d>& a) {
  std::array<double, d> c;
  for (std::size_t k = 0; k < d; ++k) c[k] = s * a[k];
  return c;
}

template <std::size_t d>
double dot(const std::array<double, d>& a, const std::array<double, d>& b) {
  double sum = a[0] * b[0];
  for (std::size_t k = 1; k < d; ++k) sum += a[k] * b[k];
  return sum;
}

inline double cross(const Vec2& a, const Vec2& b) { return a[0] * b[1] - a[1] * b[0]; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Euclidean length. May overflow or underflow; `length` does not.
template <std::size_t d>
double norm(const std::array<double, d>& a) {
  return std::sqrt(dot(a, a));
}

template <std::size_t d>
std::array<double, d> normalized(const std::array<double, d>& a) {
  return 1.0 / norm(a) * a;
}

/// The largest absolute value of a coordinate.
template <std::size_t d>
double largest(const std::array<double, d>& a) {
  double result = 0;
  for (double x : a) result = std::max(result, std::abs(x));
  return result;
}

inline bool is_finite(const Vec3& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); }

/// Euclidean distance without overflow.
inline double distance(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

}  // namespace ahm
