#include "clean_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ahm/detail/text.hpp"
#include "ahm/error.hpp"

namespace ahm::pointcloud {
namespace {

bool is_finite(const Vec3& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); }

double largest_coordinate(const std::vector<Vec3>& points) {
  double largest = 0;
  for (const Vec3& p : points)
    for (double x : p) largest = std::max(largest, std::abs(x));
  return largest;
}

/// Multiplies by a power of two that brings the largest coordinate into [1, 2); returns its exponent.
int normalize_scale(std::vector<Vec3>& points) {
  const double largest = largest_coordinate(points);
  const int exponent = largest > 0 ? std::ilogb(largest) : 0;
  for (Vec3& p : points)
    for (double& x : p) x = std::scalbn(x, -exponent);
  return exponent;
}

void center(std::vector<Vec3>& points) {
  for (int axis = 0; axis < 3; ++axis) {
    auto [low, high] = std::minmax_element(points.begin(), points.end(),
                                           [axis](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
    const double middle = 0.5 * ((*low)[axis] + (*high)[axis]);
    for (Vec3& p : points) p[axis] -= middle;
  }
}

/// Spreads the low 21 bits so that two zero bits follow each.
std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// Position of a point with coordinates in [-2, 2] along the Morton curve.
std::uint64_t morton_code(const Vec3& p) {
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis)
    code |= spread_bits(static_cast<std::uint64_t>((p[axis] + 2.0) * 0x1p19)) << axis;
  return code;
}

}  // namespace

CleanPoints clean_points(std::span<const Vec3> input, const CloudOptions& options, CloudReport& report) {
  if (input.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max() / 2))
    throw InvalidGeometry("the cloud has " + std::to_string(input.size()) + " points; at most 2^30 are supported");
  report.points = static_cast<Index>(input.size());
  std::vector<Vec3> scaled;
  std::vector<Index> kept;
  scaled.reserve(input.size());
  kept.reserve(input.size());
  for (std::size_t i = 0; i < input.size(); ++i) {
    if (is_finite(input[i])) {
      scaled.push_back(input[i]);
      kept.push_back(static_cast<Index>(i));
      continue;
    }
    ++report.non_finite;
    if (!options.drop_non_finite)
      throw InvalidGeometry("point " + std::to_string(i) + " is (" + detail::number(input[i][0]) + ", " +
                            detail::number(input[i][1]) + ", " + detail::number(input[i][2]) +
                            "): coordinates must be finite; drop such points with drop_non_finite");
  }

  CleanPoints clean;
  int exponent = normalize_scale(scaled);
  center(scaled);
  exponent += normalize_scale(scaled);
  clean.unit = std::scalbn(1.0, exponent);

  struct Key {
    std::uint64_t code;
    Index position;
  };
  std::vector<Key> order(scaled.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = {morton_code(scaled[i]), static_cast<Index>(i)};
  std::sort(order.begin(), order.end(), [&](const Key& a, const Key& b) {
    if (a.code != b.code) return a.code < b.code;
    if (scaled[a.position] != scaled[b.position]) return scaled[a.position] < scaled[b.position];
    return a.position < b.position;
  });

  clean.clean_of_input.assign(input.size(), -1);
  clean.points.reserve(order.size());
  clean.input.reserve(order.size());
  for (const Key& key : order) {
    const Vec3& p = scaled[key.position];
    if (clean.points.empty() || clean.points.back() != p) {
      clean.points.push_back(p);
      clean.input.push_back(kept[key.position]);
    } else {
      ++report.duplicates;
    }
    clean.clean_of_input[kept[key.position]] = static_cast<Index>(clean.points.size()) - 1;
  }
  if (clean.points.size() < 3)
    throw InvalidGeometry("the cloud has " + std::to_string(clean.points.size()) +
                          " distinct finite points; at least 3 are needed");
  return clean;
}

}  // namespace ahm::pointcloud
