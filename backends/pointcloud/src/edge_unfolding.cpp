#include "edge_unfolding.hpp"

#include <algorithm>
#include <cmath>

#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {
namespace {

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

}  // namespace

MeanPlane::MeanPlane(const Vec3& from, const Vec3& to) {
  const double side = dot(from, to) < 0 ? -1.0 : 1.0;
  const Vec3 sum = from + side * to;
  const double length = norm(sum);
  normal = (1 / length) * sum;
  across = 0.5 * (from - side * to);
  cosine = std::min(1.0, 0.5 * length);
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
