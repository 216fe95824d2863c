#include "smooth_points.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "ahm/pointcloud/plane_fit.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/vec.hpp"
#include "edge_unfolding.hpp"
#include "plane_axes.hpp"
#include "points_per_task.hpp"

namespace ahm::pointcloud {
namespace {

/// Parts are noisy where the deviation of neighbors' offsets is more than this share of the spacing: that of two noisy ends, so that
/// each is off by 0.085 spacings. The vertices of clean meshes of real shapes have 0.02 to 0.09, of a finely carved one 0.13.
constexpr double noisy_share = 0.12;
/// In noisy parts, neighborhoods are quiet below this share: points at rest beside moved ones make a step.
constexpr double quiet_share = 0.06;

/// A quadric has six coefficients; fewer neighbors are not averaged.
constexpr std::size_t least_fitted = 10;

/// Of these many points of a part, both neighborhoods and wider ones are as thick as wide: at 85 % at most on surfaces with noise of a
/// whole spacing, at all in volumes of seven spacings and more.
constexpr std::size_t samples = 256;
constexpr Index wider_by = 4;
constexpr double thick_in_volumes = 0.95;

/// Standard deviation of the Gaussian weights, and the farthest that a point moves, as shares of the radius.
constexpr double weight_width = 0.5, farthest_move = 1;

/// Fits quadrics over the tangent planes of points.
class QuadricFit {
 public:
  QuadricFit(const CleanPoints& cloud, const TangentPlanes& planes)
      : cloud_(cloud), planes_(planes), has_sides_(planes.estimated < static_cast<Index>(cloud.points.size())) {}

  /// Height of the surface over point i along its normal. None: too few neighbors in its sheet, or too far.
  /// @param noise  deviation of neighbors' offsets
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
    if (count < least_fitted) return {};
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

/// The points within a radius of point i, itself left out. @param squared  room for squares of distances
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

/// Whether neighborhoods are as thick as wide almost everywhere, narrow and wide ones: what fills a volume is not noise.
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

std::vector<char> find_noisy_parts(const CleanPoints& cloud, const NoisyPlanes& planes, const NeighborSearch& search,
                                   const CloudOptions& options) {
  std::vector<char> noisy(static_cast<std::size_t>(planes.parts->count), options.smooth && *options.smooth > 0);
  if (options.smooth) return noisy;
  const auto points = planes.parts->points();
  for (std::size_t part = 0; part < points.size(); ++part)
    noisy[part] = planes.noise.at(points[part].front()) > noisy_share * spacing(planes.neighborhoods, points[part]) &&
                  (!cloud.smoothed.empty() || !is_volume(cloud, planes.neighborhoods, points[part], search));
  return noisy;
}

bool smooth_points(CleanPoints& cloud, const NoisyPlanes& planes, const std::vector<char>& noisy_parts,
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
      if ((again && !cloud.smoothed[i]) || !noisy_parts[planes.parts->of_point[i]] || !planes.planes.has_plane(i))
        continue;
      if (!options.smooth && !(noise[i] > quiet_share * spacing_at(planes.neighborhoods, i))) continue;
      std::span<const Index> neighbors = planes.neighborhoods.of(i);
      double radius = planes.neighborhoods.radius[i];
      if (options.smooth) {
        radius = *options.smooth / cloud.unit;
        find_within(cloud, i, radius, search, within, squared);
        neighbors = within;
      }
      if (neighbors.size() < least_fitted) continue;
      cloud.smoothed[i] = 1;
      const auto height = quadric.height(i, neighbors, radius, noise[i]);
      if (!height) continue;
      points[i] = points[i] + *height * planes.planes.normals[i];
      any = true;
    }
    if (options.progress.stop.stop_requested()) throw Cancelled("cancelled during smoothing");
  });
  if (any) cloud.points = std::move(points);  // the search refers to those of before
  return any;
}

}  // namespace ahm::pointcloud
