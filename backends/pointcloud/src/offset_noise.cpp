#include "offset_noise.hpp"

#include <algorithm>
#include <cmath>

#include "ahm/util/parallel.hpp"
#include "ahm/util/quantile.hpp"
#include "ahm/util/vec.hpp"
#include "edge_unfolding.hpp"
#include "points_per_task.hpp"

namespace ahm::pointcloud {
namespace {

constexpr Index nearest_few = 6;  ///< neighbours per point that noise is measured on

/// Standard deviation of a normal distribution over the median of its absolute value, and of the offsets of normal points over the
/// median of the largest of six.
constexpr double deviation_of_median = 1 / 0.6744897501960817, deviation_of_largest = 1 / 1.449;

/// Median of the mean squared offset of six normal points from a seventh, over its expectation (by simulation).
constexpr double median_of_mean_square = 0.745;

/// Offsets of this share of the radius of a neighbourhood and less are rounding.
constexpr double least_offset = 1e-6;
/// In layers nearly all points have neighbours in another one, and of the offsets hardly any is between these shares of the
/// largest of its point, where those of normal noise are every second time.
constexpr double layered_points = 0.9, between_from = 0.25, between_to = 0.75, between_layers = 0.25;
/// Layers are as far apart at most points, to this share, as at the middle one; on lattices over bends, whose points have neighbours
/// across the bend and along it, offsets are of any size.
constexpr double alike_by = 0.25, alike_in_layers = 0.8;

/// `nearest_few` for each point; -1: none.
std::vector<double> offsets_of(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                               const TangentPlanes& planes, Index begin, Index end, unsigned threads) {
  std::vector<double> offsets(static_cast<std::size_t>(end - begin) * nearest_few, -1.0);
  const bool has_sides = planes.estimated < static_cast<Index>(cloud.points.size());
  detail::parallel_chunks(end - begin, points_per_task, threads, [&](Offset first, Offset last) {
    for (Offset i = first; i < last; ++i) {
      const auto point = static_cast<Index>(begin + i);
      if (!planes.has_plane(point)) continue;
      const auto neighbors = neighborhoods.of(point);
      const Index few = std::min(nearest_few, static_cast<Index>(neighbors.size()));
      for (Index k = 0; k < few; ++k) {
        const Index j = neighbors[k];
        if (!planes.has_plane(j)) continue;
        if (has_sides && dot(planes.normals[point], planes.normals[j]) < 0) continue;  // the other side of a wall
        const MeanPlane mean(planes.normals[point], planes.normals[j]);
        offsets[i * nearest_few + k] = std::abs(dot(mean.normal, cloud.points[j] - cloud.points[point]));
      }
    }
  });
  return offsets;
}

std::span<const double> of_point(const std::vector<double>& offsets, Index point) {
  return std::span(offsets).subspan(static_cast<std::size_t>(point) * nearest_few, nearest_few);
}

double median_or_zero(std::span<double> values, unsigned threads) {
  return values.empty() ? 0 : detail::median(values, threads);
}

Noise noise_of(NeighborOffsets offsets, unsigned threads) {
  const double all = median_or_zero(offsets.all, threads), largest = median_or_zero(offsets.largest, threads);
  offsets.counts.alike = count_alike(offsets.largest, largest);
  return noise_of(offsets.counts, all, largest);
}

}  // namespace

void NeighborOffsets::add(std::span<const double> of_point, double radius) {
  double most = -1;
  Offset count = 0;
  for (const double offset : of_point) {
    if (offset < 0) continue;
    all.push_back(offset);
    most = std::max(most, offset);
    ++count;
  }
  counts.points += count > 0;
  if (!(most > least_offset * radius)) return;
  largest.push_back(most);
  ++counts.apart;
  counts.beside += count - 1;
  counts.between +=
      std::ranges::count_if(of_point, [&](double t) { return t > between_from * most && t < between_to * most; });
}

Offset count_alike(std::span<const double> largest, double median) {
  return std::ranges::count_if(largest, [&](double t) { return std::abs(t - median) <= alike_by * median; });
}

NeighborOffsets neighbor_offsets(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                 const TangentPlanes& planes, Index begin, Index end, unsigned threads) {
  const std::vector<double> all = offsets_of(cloud, neighborhoods, planes, begin, end, threads);
  NeighborOffsets result;
  result.all.reserve(all.size());
  result.largest.reserve(static_cast<std::size_t>(end - begin));
  for (Index i = begin; i < end; ++i) result.add(of_point(all, i - begin), neighborhoods.radius[i]);
  return result;
}

Noise noise_of(const OffsetCounts& counts, double all, double largest) {
  const auto share = [](Offset some, Offset of) { return static_cast<double>(some) / static_cast<double>(of); };
  const bool layers = counts.beside > 0 && share(counts.between, counts.beside) < between_layers &&
                      share(counts.apart, counts.points) > layered_points &&
                      share(counts.alike, counts.apart) > alike_in_layers;
  if (layers) return {largest * deviation_of_largest, largest};
  return {all * deviation_of_median, 0};
}

Noise offset_noise(const CleanPoints& cloud, const Neighborhoods& neighborhoods, const TangentPlanes& planes,
                   unsigned threads) {
  const auto n = static_cast<Index>(cloud.points.size());
  return noise_of(neighbor_offsets(cloud, neighborhoods, planes, 0, n, threads), threads);
}

std::vector<Noise> offset_noise(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                const TangentPlanes& planes, const std::vector<std::vector<Index>>& parts,
                                unsigned threads) {
  const std::vector<double> all =
      offsets_of(cloud, neighborhoods, planes, 0, static_cast<Index>(cloud.points.size()), threads);
  std::vector<Noise> noise;
  for (const auto& points : parts) {
    NeighborOffsets offsets;
    for (const Index i : points) offsets.add(of_point(all, i), neighborhoods.radius[i]);
    noise.push_back(noise_of(std::move(offsets), threads));
  }
  return noise;
}

std::vector<double> neighborhood_noise(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                       const TangentPlanes& planes, unsigned threads) {
  const auto n = static_cast<Index>(cloud.points.size());
  const std::vector<double> offsets = offsets_of(cloud, neighborhoods, planes, 0, n, threads);
  std::vector<double> mean_square(cloud.points.size(), 0.0), result = mean_square;
  for (Index i = 0; i < n; ++i) {
    double sum = 0, count = 0;
    for (const double offset : of_point(offsets, i))
      if (offset >= 0) sum += offset * offset, ++count;
    if (count > 0) mean_square[i] = sum / count;
  }
  detail::parallel_chunks(n, points_per_task, threads, [&](Offset begin, Offset end) {
    std::vector<double> around;
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      around.assign(1, mean_square[i]);
      for (const Index j : neighborhoods.of(i)) around.push_back(mean_square[j]);
      result[i] = std::sqrt(detail::value_at(std::span(around), around.size() / 2) / median_of_mean_square);
    }
  });
  return result;
}

}  // namespace ahm::pointcloud
