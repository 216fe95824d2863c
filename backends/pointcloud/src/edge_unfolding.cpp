#include "edge_unfolding.hpp"

#include <algorithm>
#include <cmath>

#include "ahm/util/parallel.hpp"
#include "ahm/util/vec.hpp"
#include "points_per_task.hpp"

namespace ahm::pointcloud {
namespace {

constexpr Index nearest_few = 6;  ///< neighbours per point that noise is measured on

/// Standard deviation of a normal distribution over the median of its absolute value.
constexpr double deviation_of_median = 1 / 0.6744897501960817;

/// What noise explains: offsets of fewer standard deviations. Of the rest of normal noise the share in squared lengths is
/// below a percent, so that noisy planes keep their distances.
constexpr double noise_reach = 3;

/// Neighbours are of another sheet beyond this many deviations and this slope over the mean plane. Distances on scans need some
/// such bound, but hardly tell slopes between 0.4 and 1 apart.
constexpr double sheet_reach = 4;
constexpr double steepest = 0.6;

/// Squared length that an offset across the mean plane adds: all of it where it is far beyond noise, nothing within.
double squared_excess(double offset, double noise) {
  const double squared = offset * offset, reach = noise_reach * noise_reach * noise * noise;
  return squared > reach ? squared - reach * (reach / squared) : 0.0;
}

/// `nearest_few` for each point; -1: none.
std::vector<double> offsets_of(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                               const TangentPlanes& planes, Index begin, Index end, unsigned threads) {
  std::vector<double> offsets(static_cast<std::size_t>(end - begin) * nearest_few, -1.0);
  detail::parallel_chunks(end - begin, points_per_task, threads, [&](Offset first, Offset last) {
    for (Offset i = first; i < last; ++i) {
      const auto point = static_cast<Index>(begin + i);
      if (!planes.has_plane(point)) continue;
      const auto neighbors = neighborhoods.of(point);
      const Index few = std::min(nearest_few, static_cast<Index>(neighbors.size()));
      for (Index k = 0; k < few; ++k) {
        const Index j = neighbors[k];
        if (!planes.has_plane(j)) continue;
        const MeanPlane mean(planes.normals[point], planes.normals[j]);
        offsets[i * nearest_few + k] = std::abs(dot(mean.normal, cloud.points[j] - cloud.points[point]));
      }
    }
  });
  return offsets;
}

double noise_of(std::vector<double> offsets) {
  if (offsets.empty()) return 0;
  const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
  std::nth_element(offsets.begin(), middle, offsets.end());
  return noise_of_median(*middle);
}

}  // namespace

MeanPlane::MeanPlane(const Vec3& from, const Vec3& to) {
  const double side = dot(from, to) < 0 ? -1.0 : 1.0;
  const Vec3 sum = from + side * to;
  const double length = norm(sum);
  normal = (1 / length) * sum;
  across = 0.5 * (from - side * to);
  cosine = std::min(1.0, 0.5 * length);
}

std::vector<double> neighbor_offsets(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                     const TangentPlanes& planes, Index begin, Index end, unsigned threads) {
  std::vector<double> offsets = offsets_of(cloud, neighborhoods, planes, begin, end, threads);
  std::erase(offsets, -1.0);
  return offsets;
}

double noise_of_median(double offset) { return offset * deviation_of_median; }

double offset_noise(const CleanPoints& cloud, const Neighborhoods& neighborhoods, const TangentPlanes& planes,
                    unsigned threads) {
  return noise_of(neighbor_offsets(cloud, neighborhoods, planes, 0, static_cast<Index>(cloud.points.size()), threads));
}

std::vector<double> offset_noise(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                 const TangentPlanes& planes, const std::vector<std::vector<Index>>& parts,
                                 unsigned threads) {
  const std::vector<double> all =
      offsets_of(cloud, neighborhoods, planes, 0, static_cast<Index>(cloud.points.size()), threads);
  std::vector<double> noise, offsets;
  for (const auto& points : parts) {
    offsets.clear();
    for (const Index i : points)
      for (Index k = 0; k < nearest_few; ++k)
        if (const double offset = all[static_cast<std::size_t>(i) * nearest_few + k]; offset >= 0)
          offsets.push_back(offset);
    noise.push_back(noise_of(offsets));
  }
  return noise;
}

Vec3 unfolded_edge(const Vec3& tail, const Vec3& head, const Vec3& edge, double noise) {
  const MeanPlane mean(tail, head);
  const double offset = dot(mean.normal, edge);
  Vec3 flat = edge - offset * mean.normal;
  const double squared_sine = dot(mean.across, mean.across);
  if (squared_sine > 0) flat = flat + ((1 / mean.cosine - 1) * dot(mean.across, flat) / squared_sine) * mean.across;
  // From the mean plane to that of the tail by the smallest rotation.
  flat = flat - (dot(tail, flat) / (1 + mean.cosine)) * (mean.normal + tail);
  const double excess = squared_excess(offset, noise), squared = dot(flat, flat);
  if (!(excess > 0 && squared > 0)) return flat;
  return std::sqrt(1 + excess / squared) * flat;
}

bool leaves_surface(const Vec3& tail, const Vec3& head, const Vec3& edge, double noise) {
  // Normals less than a right angle apart add up to the root of two at least: this is twice the square of what the offset is at
  // the most, and mostly tells that it is not steep.
  const double sum = std::abs(dot(tail, edge)) + std::abs(dot(head, edge)), squared = dot(edge, edge);
  constexpr double steepest_squared = steepest * steepest;
  if (sum * sum * (1 + steepest_squared) < 1.99 * steepest_squared * squared) return false;
  const double offset = std::abs(dot(MeanPlane(tail, head).normal, edge));
  const double flat = std::sqrt(std::max(0.0, squared - offset * offset));
  return offset > sheet_reach * noise && offset > steepest * flat;
}

}  // namespace ahm::pointcloud
