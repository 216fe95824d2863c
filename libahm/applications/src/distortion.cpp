#include "ahm/applications/distortion.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

/// A triangle has no area if its area is below this share of the square of its longest side: then it is rounding error.
constexpr double min_relative_area = 1e-14;
/// A triangle with a larger distortion counts as collapsed.
constexpr double max_distortion = 1e6;

/// (a - b) / unit for a power of two `unit`; does not overflow.
template <std::size_t d>
std::array<double, d> scaled_difference(const std::array<double, d>& a, const std::array<double, d>& b, double unit) {
  return 1 / unit * a - 1 / unit * b;
}

TriangleDistortion distortion_of_triangle(const std::array<Vec3, 3>& p, const std::array<Vec2, 3>& q) {
  TriangleDistortion result;
  double size = 0;
  for (const Vec3& x : p) {
    if (!all_finite(x)) return result;
    size = std::max(size, largest(x - p[0]));
  }
  if (!(size > 0) || !std::isfinite(size)) return result;
  const double unit = power_of_two_below(size);
  const Vec3 a = scaled_difference(p[1], p[0], unit), b = scaled_difference(p[2], p[0], unit);

  // The triangle in the plane: a = (base, 0), b = (along, height).
  const double base = length(a), along = base > 0 ? dot(a, b) / base : 0, twice_area = length(cross(a, b));
  if (!(twice_area > min_relative_area)) return result;
  result.side = unit * std::sqrt(twice_area / 2);
  const double height = twice_area / base;
  if (!all_finite(q[0]) || !all_finite(q[1]) || !all_finite(q[2])) return result;

  // Gradient J = (qa, qb) (a, b)^-1. Its largest singular value is the sum of the lengths of its conformal and its
  // anticonformal part.
  const Vec2 qa = scaled_difference(q[1], q[0], unit), qb = scaled_difference(q[2], q[0], unit);
  Vec2 x, y;  // columns of J
  for (std::size_t c = 0; c < 2; ++c) x[c] = qa[c] / base, y[c] = (qb[c] - x[c] * along) / height;
  const double determinant = x[0] * y[1] - x[1] * y[0];
  result.sigma2 = (std::hypot(x[0] + y[1], x[1] - y[0]) + std::hypot(x[0] - y[1], x[1] + y[0])) / 2;
  result.sigma1 = result.sigma2 > 0 ? std::abs(determinant) / result.sigma2 : 0;
  result.flipped = determinant < 0;
  return result;
}

void check_length(const char* name, std::size_t size, std::size_t wanted) {
  if (size != wanted)
    throw InvalidArgument("distortion: '" + std::string(name) + "' has " + detail::counted(size, "number") + ", not " +
                          std::to_string(wanted));
}

/// @param place  place(triangle, corner): index of the first coordinate of a corner
template <class Place>
std::vector<TriangleDistortion> distortion_of_triangles(std::span<const Vec3> positions,
                                                        std::span<const std::array<Index, 3>> triangles,
                                                        std::span<const double> coordinates, const Place& place) {
  return detail::with_memory_check("measuring distortion", [&] {
    std::vector<TriangleDistortion> result(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      std::array<Vec3, 3> p;
      std::array<Vec2, 3> q;
      for (std::size_t c = 0; c < 3; ++c) {
        const Index vertex = triangles[t][c];
        if (vertex < 0 || static_cast<std::size_t>(vertex) >= positions.size())
          throw InvalidArgument("distortion: triangle " + std::to_string(t) + " refers to vertex " +
                                std::to_string(vertex) + ", outside [0, " + std::to_string(positions.size()) + ")");
        p[c] = positions[vertex];
        q[c] = {coordinates[place(t, c)], coordinates[place(t, c) + 1]};
      }
      result[t] = distortion_of_triangle(p, q);
    }
    return result;
  });
}

}  // namespace

double TriangleDistortion::value() const noexcept {
  return std::isnan(sigma1) || std::isnan(sigma2) ? std::numeric_limits<double>::quiet_NaN()
                                                  : std::max(1 / sigma1, sigma2);
}

std::vector<TriangleDistortion> distortion(std::span<const Vec3> positions,
                                           std::span<const std::array<Index, 3>> triangles,
                                           std::span<const double> coordinates) {
  check_length("coordinates", coordinates.size(), 2 * positions.size());
  return distortion_of_triangles(positions, triangles, coordinates, [&](std::size_t t, std::size_t c) {
    return 2 * static_cast<std::size_t>(triangles[t][c]);
  });
}

std::vector<TriangleDistortion> corner_distortion(std::span<const Vec3> positions,
                                                  std::span<const std::array<Index, 3>> triangles,
                                                  std::span<const double> corner_coordinates) {
  check_length("corner_coordinates", corner_coordinates.size(), 6 * triangles.size());
  return distortion_of_triangles(positions, triangles, corner_coordinates,
                                 [](std::size_t t, std::size_t c) { return 6 * t + 2 * c; });
}

std::vector<double> relative_areas(std::span<const TriangleDistortion> triangles) {
  double largest = 0;
  for (const TriangleDistortion& t : triangles) largest = std::max(largest, t.side);
  std::vector<double> areas;
  for (const TriangleDistortion& t : triangles)
    areas.push_back(largest > 0 ? (t.side / largest) * (t.side / largest) : 0);
  return areas;
}

DistortionSummary summary(std::span<const TriangleDistortion> triangles) {
  DistortionSummary s;
  std::vector<std::pair<double, double>> sorted;  // D and area
  double area = 0, sum = 0, flipped_area = 0, collapsed_area = 0;
  Offset flipped = 0;
  const std::vector<double> areas = relative_areas(triangles);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const double value = triangles[t].value();
    if (std::isnan(value)) continue;
    sorted.emplace_back(value, areas[t]);
    area += areas[t];
    value <= max_distortion ? sum += value * areas[t] : collapsed_area += areas[t];
    flipped += triangles[t].flipped;
    flipped_area += triangles[t].flipped ? areas[t] : 0;
  }
  s.measured = static_cast<Offset>(sorted.size());
  s.unmeasured = static_cast<Offset>(triangles.size()) - s.measured;
  if (sorted.empty()) return s;
  std::sort(sorted.begin(), sorted.end());
  const auto percentile = [&](double share) {
    double below = 0;
    for (const auto& [value, weight] : sorted)
      if ((below += weight) >= share * area) return value;
    return sorted.back().first;
  };
  if (collapsed_area < area) s.mean = sum / (area - collapsed_area);
  s.collapsed_area = collapsed_area / area;
  s.median = percentile(0.5);
  s.percentile_95 = percentile(0.95);
  s.largest = sorted.back().first;
  s.flipped = static_cast<double>(flipped) / static_cast<double>(s.measured);
  s.flipped_area = flipped_area / area;
  return s;
}

}  // namespace ahm
