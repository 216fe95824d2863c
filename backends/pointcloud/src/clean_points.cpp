#include "clean_points.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/quantile.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {

namespace {

Vec3 scaled(const Vec3& p, int exponent) {
  return {std::scalbn(p[0], exponent), std::scalbn(p[1], exponent), std::scalbn(p[2], exponent)};
}

/// The scale that brings the points to order one. Uses medians, because a single outlier must not make the other points tiny.
Placement placement_of(const std::vector<Vec3>& points, unsigned threads) {
  Placement result;
  double largest = 0;
  for (const Vec3& p : points)
    for (double x : p) largest = std::max(largest, std::abs(x));
  const int first = largest > 0 ? std::ilogb(largest) : 0;  // differences of values scaled by it do not overflow
  Vec3 middle{0, 0, 0};
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3 && !points.empty(); ++axis) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](const Vec3& p) { return std::scalbn(p[axis], -first); });
    middle[axis] = detail::median(values, threads);
  }
  std::transform(points.begin(), points.end(), values.begin(), [&](const Vec3& point) {
    const Vec3 p = scaled(point, -first) - middle;
    return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
  });
  const double spread = points.empty() ? 0.0 : detail::median(values, threads);
  result.exponent = first + (spread > 0 ? std::ilogb(spread) : 0);
  return result;
}

/// Position of the highest binary digit in which two coordinates differ. A different sign ranks above all digits.
int highest_difference(double a, double b) {
  if (a == b) return std::numeric_limits<int>::min();
  if ((a < 0) != (b < 0)) return std::numeric_limits<int>::max();
  constexpr int digits = 52;
  constexpr std::uint64_t magnitude = ~std::uint64_t{0} >> 1;
  const std::uint64_t x = std::bit_cast<std::uint64_t>(a) & magnitude, y = std::bit_cast<std::uint64_t>(b) & magnitude;
  const int e = static_cast<int>(x >> digits), f = static_cast<int>(y >> digits);
  if (e != f) return std::max(e, f);
  return std::max(e, 1) - std::countl_zero((x ^ y) << (64 - digits)) - 1;
}

/// Leading digits of positions on the Morton curve, as integers. If they differ for two points, the point with the lower
/// integer is `before_on_curve`.
class MortonCodes {
 public:
  explicit MortonCodes(std::span<const Vec3> points) {
    double most = 0;
    for (const Vec3& p : points) most = std::max(most, largest(p));
    most = std::min(most, std::numeric_limits<double>::max());  // a far outlier may be infinite
    to_digits_ = most > 0 ? digits - 1 - std::ilogb(most) : 0;
  }
  std::uint64_t operator()(const Vec3& p) const {
    return spread(of_axis(p[2])) << 2 | spread(of_axis(p[1])) << 1 | spread(of_axis(p[0]));
  }

 private:
  static constexpr int digits = 20;  ///< per axis, besides the sign

  /// Leading digits of a coordinate, ascending with it.
  std::uint64_t of_axis(double x) const {
    constexpr std::uint64_t sign = std::uint64_t{1} << digits;
    const double scaled = std::min(std::scalbn(std::abs(x), to_digits_), static_cast<double>(sign - 1));
    const auto first = static_cast<std::uint64_t>(scaled);
    return x < 0 ? sign - 1 - first : sign + first;
  }
  /// Inserts two zeros between consecutive binary digits.
  static std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
  }

  int to_digits_;  ///< exponent of two that scales coordinates to digits; its power may overflow
};

/// Copies the finite points, and stores their indices in `kept`.
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

/// @param points  scaled, so that half of them have distances of order one
/// @throws InvalidGeometry (a point so far away that squares of lengths would overflow)
void check_reach(const std::vector<Vec3>& points, const std::function<Index(std::size_t)>& row,
                 const std::vector<Index>& kept) {
  constexpr double farthest = 1e150;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (const double x : points[i])
      if (std::abs(x) > farthest)
        throw InvalidGeometry("point " + std::to_string(row(static_cast<std::size_t>(kept[i]))) + " has a coordinate " +
                              detail::number(std::abs(x)) +
                              " times as large as the median distance of the points; it must be less than 1e150");
}

}  // namespace

Vec3 Placement::place(const Vec3& point) const { return scaled(point, -exponent); }

double Placement::unit() const { return std::scalbn(1.0, exponent); }

bool before_on_curve(const Vec3& point, const Vec3& other) {
  int deciding = 2, highest = highest_difference(point[2], other[2]);
  for (int axis : {1, 0})
    if (const int level = highest_difference(point[axis], other[axis]); level > highest)
      deciding = axis, highest = level;
  return point[deciding] < other[deciding];
}

CleanPoints clean_points(std::span<const Vec3> input, const std::function<Index(std::size_t)>& row,
                         const CloudOptions& options, CloudDetails& report) {
  if (input.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max() / 2))
    throw InvalidGeometry("the cloud has " + detail::counted(input.size(), "point") + "; at most 2^30 are supported");
  std::vector<Index> kept;
  std::vector<Vec3> placed = finite_points(input, row, options, kept, report);
  const Placement placement = placement_of(placed, options.threads);
  detail::for_each_index(placed.size(), options.threads,
                         [&](std::size_t i) { placed[i] = placement.place(placed[i]); });
  check_reach(placed, row, kept);
  CleanPoints clean;
  clean.unit = placement.unit();

  struct Place {
    std::uint64_t begin;
    Index position;
  };
  const MortonCodes begin_of(placed);
  std::vector<Place> order(placed.size());
  detail::for_each_index(order.size(), options.threads, [&](std::size_t i) {
    order[i] = {begin_of(placed[i]), static_cast<Index>(i)};
  });
  detail::parallel_sort(order, options.threads, [&](const Place& a, const Place& b) {
    if (a.begin != b.begin) return a.begin < b.begin;
    const Vec3 &p = placed[a.position], &q = placed[b.position];
    return p == q ? a.position < b.position : before_on_curve(p, q);
  });

  clean.clean_of_input.assign(input.size(), -1);
  clean.points.reserve(order.size());
  clean.input.reserve(order.size());
  for (const Place& place : order) {
    const Index position = place.position;
    const Vec3& p = placed[position];
    if (clean.points.empty() || clean.points.back() != p) {
      clean.points.push_back(p);
      clean.input.push_back(kept[position]);
    } else {
      ++report.duplicates;
    }
    clean.clean_of_input[kept[position]] = static_cast<Index>(clean.points.size()) - 1;
  }
  if (clean.points.size() < 3)
    throw InvalidGeometry("the cloud has " + detail::counted(clean.points.size(), "distinct finite point") +
                          "; at least 3 are needed");
  return clean;
}

}  // namespace ahm::pointcloud
