#include "clean_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {
namespace {

/// The value in the middle when sorted; reorders.
double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Vec3 scaled(const Vec3& p, int exponent) {
  return {std::scalbn(p[0], exponent), std::scalbn(p[1], exponent), std::scalbn(p[2], exponent)};
}

/// Brings the points to order one about their middle. Medians, since a single stray point must cost the others no digits.
Placement normalize(std::vector<Vec3>& points) {
  Placement result;
  double largest = 0;
  for (const Vec3& p : points)
    for (double x : p) largest = std::max(largest, std::abs(x));
  result.first = largest > 0 ? std::ilogb(largest) : 0;
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3 && !points.empty(); ++axis) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](const Vec3& p) { return std::scalbn(p[axis], -result.first); });
    result.middle[axis] = median(values);
  }
  std::transform(points.begin(), points.end(), values.begin(), [&](const Vec3& point) {
    const Vec3 p = result.place(point);
    return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
  });
  const double spread = points.empty() ? 0.0 : median(values);
  result.second = spread > 0 ? std::ilogb(spread) : 0;
  for (Vec3& p : points) p = result.place(p);
  return result;
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

/// Copies the finite points; `kept` are their numbers.
std::vector<Vec3> finite_points(std::span<const Vec3> input, const std::function<Index(std::size_t)>& row,
                                const CloudOptions& options, std::vector<Index>& kept, CloudDetails& report) {
  std::vector<Vec3> points;
  points.reserve(input.size());
  kept.reserve(input.size());
  for (std::size_t i = 0; i < input.size(); ++i) {
    if (is_finite(input[i])) {
      points.push_back(input[i]);
      kept.push_back(static_cast<Index>(i));
      continue;
    }
    ++report.non_finite;
    if (!options.drop_non_finite)
      throw InvalidGeometry("non_finite",
                            "point " + std::to_string(row(i)) + " is (" + detail::number(input[i][0]) + ", " +
                                detail::number(input[i][1]) + ", " + detail::number(input[i][2]) +
                                "): coordinates must be finite",
                            "drop such points with drop_non_finite");
  }
  return points;
}

}  // namespace

Vec3 Placement::place(const Vec3& point) const { return scaled(scaled(point, -first) - middle, -second); }

double Placement::unit() const { return std::scalbn(1.0, first + second); }

std::uint64_t morton_code(const Vec3& placed) {
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = (std::clamp(placed[axis], -16.0, 15.999) + 16.0) * 0x1p16;
    code |= spread_bits(static_cast<std::uint64_t>(cell)) << axis;
  }
  return code;
}

CleanPoints clean_points(std::span<const Vec3> input, const std::function<Index(std::size_t)>& row,
                         const CloudOptions& options, CloudDetails& report) {
  if (input.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max() / 2))
    throw InvalidGeometry("the cloud has " + std::to_string(input.size()) + " points; at most 2^30 are supported");
  std::vector<Index> kept;
  std::vector<Vec3> placed = finite_points(input, row, options, kept, report);
  CleanPoints clean;
  clean.unit = normalize(placed).unit();

  struct Key {
    std::uint64_t code;
    Index position;
  };
  std::vector<Key> order(placed.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = {morton_code(placed[i]), static_cast<Index>(i)};
  std::sort(order.begin(), order.end(), [&](const Key& a, const Key& b) {
    if (a.code != b.code) return a.code < b.code;
    if (placed[a.position] != placed[b.position]) return placed[a.position] < placed[b.position];
    return a.position < b.position;
  });

  clean.clean_of_input.assign(input.size(), -1);
  clean.points.reserve(order.size());
  clean.input.reserve(order.size());
  for (const Key& key : order) {
    const Vec3& p = placed[key.position];
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
