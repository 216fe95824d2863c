#include "noise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/pointcloud/plane_fit.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/quantile.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "clean_points.hpp"
#include "cloud_parts.hpp"
#include "merge_points.hpp"
#include "tangent_edges.hpp"
#include "tangent_planes.hpp"

namespace ahm::pointcloud {
namespace {

constexpr Index nearest_few = 6;  ///< neighbors per point used to measure noise

/// Standard deviation of a normal distribution, divided by the median of its absolute value. And standard deviation of offsets
/// between normally distributed points, divided by the median of the largest of six offsets.
constexpr double deviation_of_median = 1 / 0.6744897501960817, deviation_of_largest = 1 / 1.449;

/// Median of the mean squared offset of six normally distributed points from a seventh, divided by its expectation (by
/// simulation).
constexpr double median_of_mean_square = 0.745;

/// Offsets up to this fraction of the neighborhood radius are rounding errors.
constexpr double min_offset = 1e-6;
/// Criteria for layers. Nearly all points have neighbors in another layer. Few offsets lie between these fractions of the largest
/// offset at their point; with normal noise every second one does.
constexpr double layered_points = 0.9, between_from = 0.25, between_to = 0.75, between_layers = 0.25;
/// Layers have a constant distance: the largest offsets of most points agree with their median to this fraction. On lattices
/// over bends, points have neighbors both across the bend and along it, and offsets have any size.
constexpr double alike_by = 0.25, alike_in_layers = 0.8;

/// Absolute offsets of the `nearest_few` neighbors of each point across their mean planes; -1: no plane.
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
        if (has_sides && dot(planes.normals[point], planes.normals[j]) < 0) continue;  // other side of a wall
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
  if (!(most > min_offset * radius)) return;
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

namespace {

/// Mean squared offset of each point's nearest neighbors, divided by its median for a standard deviation of 1.
std::vector<double> squared_noise(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                  const TangentPlanes& planes, unsigned threads) {
  const auto n = static_cast<Index>(cloud.points.size());
  const std::vector<double> offsets = offsets_of(cloud, neighborhoods, planes, 0, n, threads);
  std::vector<double> result(cloud.points.size(), 0.0);
  for (Index i = 0; i < n; ++i) {
    double sum = 0, count = 0;
    for (const double offset : of_point(offsets, i))
      if (offset >= 0) sum += offset * offset, ++count;
    if (count > 0) result[i] = sum / (median_of_mean_square * count);
  }
  return result;
}

}  // namespace

std::vector<double> neighborhood_noise(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                       const TangentPlanes& planes, unsigned threads) {
  const auto n = static_cast<Index>(cloud.points.size());
  const std::vector<double> squares = squared_noise(cloud, neighborhoods, planes, threads);
  std::vector<double> result(cloud.points.size(), 0.0);
  detail::parallel_chunks(n, points_per_task, threads, [&](Offset begin, Offset end) {
    std::vector<double> around;
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      around.assign(1, squares[i]);
      for (const Index j : neighborhoods.of(i)) around.push_back(squares[j]);
      result[i] = std::sqrt(detail::value_at(std::span(around), around.size() / 2));
    }
  });
  return result;
}

namespace {

/// Each round averages over one more neighborhood. Three rounds remove noise of a whole spacing.
constexpr int max_rounds = 5;

void find_noise(const CleanPoints& cloud, const CloudOptions& options, NoisyPlanes& result) {
  Noise whole;
  detail::run_both(
      options.threads, [&] { whole = offset_noise(cloud, result.neighborhoods, result.planes, options.threads); },
      [&] {
        result.parts = options.parts_apart
                           ? std::make_unique<const CloudParts>(result.neighborhoods)
                           : std::make_unique<const CloudParts>(static_cast<Index>(cloud.points.size()));
      });
  result.noise = whole.deviation;
  result.typical_noise = whole;
  if (result.parts->count == 1) return;
  const auto points = result.parts->points();
  const std::vector<Noise> noise = offset_noise(cloud, result.neighborhoods, result.planes, points, options.threads);
  const auto largest =
      std::max_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  result.typical_noise = noise[static_cast<std::size_t>(largest - points.begin())];
  std::vector<double> deviations;
  for (const Noise& of_part : noise) deviations.push_back(of_part.deviation);
  result.noise = PerPart(result.parts->of_point, std::move(deviations));
}

NoisyPlanes find_planes(CleanPoints& cloud, std::span<const Vec3> normals, std::unique_ptr<NeighborSearch>& search,
                        const CloudOptions& options) {
  NoisyPlanes result;
  result.neighborhoods = find_neighborhoods(cloud, *search, options.k.value_or(default_neighbors), options);
  result.merged = merge_near_points(cloud, search, options, result.neighborhoods);
  result.planes = find_tangent_planes(cloud, normals, *search, result.neighborhoods, options);
  find_noise(cloud, options, result);
  return result;
}

/// @throws InvalidArgument if the radius of smoothing exceeds the longest side of the points' bounding box
void check_radius(const CleanPoints& cloud, const CloudOptions& options) {
  if (!options.smooth) return;
  Vec3 low = cloud.points.front(), high = low;
  for (const Vec3& p : cloud.points)
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  const Vec3 sides = cloud.unit * (high - low);
  if (const double longest = std::max({sides[0], sides[1], sides[2]}); *options.smooth > longest)
    throw InvalidArgument("smooth is " + detail::number(*options.smooth) + ", but the cloud is only " +
                          detail::number(longest) + " long; give a radius of a few spacings");
}

}  // namespace

NoisyPlanes find_noisy_planes(CleanPoints& cloud, std::span<const Vec3> normals,
                              std::unique_ptr<NeighborSearch>& search, const CloudOptions& options) {
  check_radius(cloud, options);
  NoisyPlanes result = find_planes(cloud, normals, search, options);
  CloudOptions quiet = options;
  quiet.progress.report = nullptr;
  const int rounds = options.smooth ? 1 : max_rounds;
  for (int round = 0; round < rounds; ++round) {
    const std::vector<char> noisy = find_noisy_points(cloud, result, *search, options);
    if (std::find(noisy.begin(), noisy.end(), 1) == noisy.end() ||
        !smooth_points(cloud, result, noisy, *search, options))
      break;
    search = options.search(cloud.points);
    NoisyPlanes smoothed = find_planes(cloud, normals, search, quiet);
    smoothed.typical_noise = result.typical_noise;
    smoothed.merged += result.merged;
    result = std::move(smoothed);
  }
  return result;
}

namespace {

/// A part is noisy if the standard deviation of its neighbors' offsets exceeds this fraction of the spacing. Both ends of an
/// offset are noisy, so each point then deviates by 0.085 spacings. Vertices of clean meshes of real shapes have 0.02 to 0.09,
/// of a finely carved one 0.13.
constexpr double noisy_share = 0.12;
/// The same for regions of a part, where creases close together are easily taken for noise.
constexpr double locally_noisy_share = 1.0 / 3;
/// Rounds of averaging the share of noisy points over neighborhoods, about five spacings of standard deviation. Creases are narrower.
constexpr int averaging_rounds = 10;
/// Neighborhoods in noisy parts are smoothed above this lower fraction, because points at rest next to moved ones would make a
/// step.
constexpr double quiet_share = 0.06;

/// A quadric has six coefficients; points with fewer neighbors than this are not smoothed.
constexpr std::size_t min_fit_points = 10;

/// Test for volumes: at this many points of a part, both the neighborhood and one `wider_by` times as large must be as thick as
/// wide. This holds at 85 % of the points at most on surfaces with noise of a whole spacing, and at all points in volumes of
/// seven spacings or more.
constexpr std::size_t samples = 256;
constexpr Index wider_by = 4;
constexpr double thick_in_volumes = 0.95;

/// Standard deviation of the Gaussian weights, and largest displacement of a point, as fractions of the neighborhood radius.
constexpr double weight_width = 0.5, farthest_move = 1;

/// Fits a quadric over the tangent plane of a point.
class QuadricFit {
 public:
  QuadricFit(const CleanPoints& cloud, const TangentPlanes& planes)
      : cloud_(cloud), planes_(planes), has_sides_(planes.estimated < static_cast<Index>(cloud.points.size())) {}

  /// Height of the fitted surface over point i along its normal. None if too few neighbors lie in its sheet or the surface is
  /// too far.
  /// @param noise  standard deviation of neighbors' offsets
  std::optional<double> height(Index i, std::span<const Index> neighbors, double radius, double noise) const {
    const Vec3& normal = planes_.normals[i];
    const PlaneAxes axes(normal);
    Matrix matrix = Matrix::Zero();
    matrix(0, 0) = 1;  // the point itself
    Vector right = Vector::Zero();
    const double width = weight_width * radius;
    std::size_t count = 0;
    for (const Index j : neighbors) {
      if (!in_same_sheet(i, j, noise)) continue;
      const Vec3 offset = (1 / width) * (cloud_.points[j] - cloud_.points[i]);
      const double x = dot(axes.x, offset), y = dot(axes.y, offset), weight = std::exp(-0.5 * (x * x + y * y));
      const Vector row{{1, x, y, x * x, x * y, y * y}};
      matrix.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
      right += weight * dot(normal, offset) * row;
      ++count;
    }
    if (count < min_fit_points) return {};
    const double height = width * matrix.selfadjointView<Eigen::Lower>().ldlt().solve(right)[0];
    return std::abs(height) <= farthest_move * radius ? std::optional(height) : std::nullopt;
  }

 private:
  using Matrix = Eigen::Matrix<double, 6, 6>;
  using Vector = Eigen::Matrix<double, 6, 1>;

  bool in_same_sheet(Index i, Index j, double noise) const {
    if (!planes_.has_plane(j)) return false;
    const Vec3 &own = planes_.normals[i], &other = planes_.normals[j];
    if (has_sides_ && dot(own, other) < 0) return false;
    return !leaves_surface(own, other, cloud_.points[j] - cloud_.points[i], noise);
  }

  const CleanPoints& cloud_;
  const TangentPlanes& planes_;
  bool has_sides_;
};

/// Finds the points within a radius of point i, without i.
/// @param squared  work space for squared distances
void find_within(const CleanPoints& cloud, Index i, double radius, const NeighborSearch& search,
                 std::vector<Index>& found, std::vector<double>& squared) {
  for (std::size_t count = 2 * default_neighbors;; count *= 2) {
    found.resize(std::min(count, cloud.points.size()));
    squared.resize(found.size());
    search.nearest(cloud.points[i], found, squared);
    if (squared.back() > radius * radius || found.size() == cloud.points.size()) break;
  }
  const auto beyond = std::upper_bound(squared.begin(), squared.end(), radius * radius);
  found.resize(static_cast<std::size_t>(beyond - squared.begin()));
  std::erase(found, i);
}

/// Whether almost all neighborhoods, both narrow and wide ones, are as thick as wide. The points then fill a volume, which is
/// not noise.
bool is_volume(const CleanPoints& cloud, const Neighborhoods& neighborhoods, std::span<const Index> points,
               const NeighborSearch& search) {
  std::vector<Index> wide(std::min(static_cast<std::size_t>(wider_by * neighborhoods.k), cloud.points.size()));
  std::vector<double> squared(wide.size());
  Index thick = 0, count = 0;
  for (std::size_t at = 0; at < points.size(); at += (points.size() + samples - 1) / samples) {
    const Index i = points[at];
    search.nearest(cloud.points[i], wide, squared);
    thick += fit_plane(cloud.points, i, neighborhoods.of(i)).thickness > thick_ratio &&
             fit_plane(cloud.points, i, wide).thickness > thick_ratio;
    ++count;
  }
  return thick > thick_in_volumes * count;
}

}  // namespace

namespace {

/// The points around which most points are noisy, within about ten spacings.
std::vector<char> find_noisy_regions(const CleanPoints& cloud, const NoisyPlanes& planes, unsigned threads) {
  const std::size_t n = cloud.points.size();
  const std::vector<double> squares = squared_noise(cloud, planes.neighborhoods, planes.planes, threads);
  std::vector<double> share(n), mean(n);
  detail::for_each_index(n, threads, [&](std::size_t i) {
    const double limit = locally_noisy_share * spacing_at(planes.neighborhoods, static_cast<Index>(i));
    share[i] = squares[i] > limit * limit ? 1 : 0;
  });
  for (int round = 0; round < averaging_rounds; ++round) {
    // A mean never exceeds the largest share, so clean clouds end here at once.
    if (std::ranges::max(share) <= 0.5) return std::vector<char>(n, 0);
    detail::for_each_index(n, threads, [&](std::size_t i) {
      const auto neighbors = planes.neighborhoods.of(static_cast<Index>(i));
      double sum = share[i];
      for (const Index j : neighbors) sum += share[j];
      mean[i] = sum / static_cast<double>(neighbors.size() + 1);
    });
    std::swap(share, mean);
  }
  std::vector<char> noisy(n);
  for (std::size_t i = 0; i < n; ++i) noisy[i] = share[i] > 0.5;
  return noisy;
}

}  // namespace

std::vector<char> find_noisy_points(const CleanPoints& cloud, const NoisyPlanes& planes, const NeighborSearch& search,
                                    const CloudOptions& options) {
  const std::size_t n = cloud.points.size();
  if (options.smooth) return std::vector<char>(n, *options.smooth > 0);
  const bool again = !cloud.smoothed.empty();
  const std::vector<char> in_region = again                 ? cloud.smoothed
                                      : options.parts_apart ? find_noisy_regions(cloud, planes, options.threads)
                                                            : std::vector<char>(n, 0);
  std::vector<std::vector<Index>> regions = planes.parts->points();
  for (std::vector<Index>& region : regions)
    if (again || !(planes.noise.at(region.front()) > noisy_share * spacing(planes.neighborhoods, region)))
      std::erase_if(region, [&](Index i) { return in_region[i] == 0; });
  std::erase_if(regions, [&](const auto& region) {
    return region.empty() || (!again && is_volume(cloud, planes.neighborhoods, region, search));
  });
  const std::vector<Noise> noise =
      again ? offset_noise(cloud, planes.neighborhoods, planes.planes, regions, options.threads) : std::vector<Noise>();
  std::vector<char> noisy(n, 0);
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (again && !(noise[r].deviation > noisy_share * spacing(planes.neighborhoods, regions[r]))) continue;
    for (const Index i : regions[r]) noisy[i] = 1;
  }
  return noisy;
}

bool smooth_points(CleanPoints& cloud, const NoisyPlanes& planes, const std::vector<char>& noisy,
                   const NeighborSearch& search, const CloudOptions& options) {
  const auto n = static_cast<Offset>(cloud.points.size());
  const std::vector<double> noise = neighborhood_noise(cloud, planes.neighborhoods, planes.planes, options.threads);
  const QuadricFit quadric(cloud, planes.planes);
  std::vector<Vec3> points = cloud.points;
  const bool again = !cloud.smoothed.empty();
  cloud.smoothed.resize(points.size(), 0);
  std::atomic<bool> any{false};
  detail::parallel_chunks(n, points_per_task, options.threads, [&](Offset begin, Offset end) {
    std::vector<Index> within;
    std::vector<double> squared;
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      if ((again && !cloud.smoothed[i]) || !noisy[i] || !planes.planes.has_plane(i)) continue;
      if (!options.smooth && !(noise[i] > quiet_share * spacing_at(planes.neighborhoods, i))) continue;
      std::span<const Index> neighbors = planes.neighborhoods.of(i);
      double radius = planes.neighborhoods.radius[i];
      if (options.smooth) {
        radius = *options.smooth / cloud.unit;
        find_within(cloud, i, radius, search, within, squared);
        neighbors = within;
      }
      if (neighbors.size() < min_fit_points) continue;
      cloud.smoothed[i] = 1;
      const auto height = quadric.height(i, neighbors, radius, noise[i]);
      if (!height) continue;
      points[i] = points[i] + *height * planes.planes.normals[i];
      any = true;
    }
    if (options.progress.stop.stop_requested()) throw Cancelled("cancelled during smoothing");
  });
  if (any) cloud.points = std::move(points);  // not earlier: `search` refers to the old points
  return any;
}

}  // namespace ahm::pointcloud
