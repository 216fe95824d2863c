#include "tangent_planes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <atomic>
#include <iterator>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/pointcloud/plane_fit.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/quantile.hpp"
#include "ahm/util/text.hpp"
#include "cloud_parts.hpp"
#include "tangent_edges.hpp"

namespace ahm::pointcloud {
namespace {

/// An input plane is contradicted if its slope is this many times that of the plane fitted to the points, and larger than that
/// of normals written with three digits.
constexpr double contradiction = 2;
constexpr double min_slope = 2e-3;

/// An input plane is also contradicted if it differs from the planes around it by this many times the angle between fitted
/// planes, and by at least this angle. This criterion works on points too noisy for slopes.
constexpr double disagreement = 2;
constexpr double min_disagreement = 0.1;

/// Number of neighbors that measure how well planes fit.
constexpr std::size_t max_neighbors = 12;

/// Input planes of neighbors that bend by more than this differ from opposite planes only by their signs, which may be wrong.
/// At sharper creases the fitted planes are used, which bend gradually.
constexpr double sharpest_cosine = 0.1;
/// Neighbors in the other sheet of a thin wall: their planes are parallel, and the edge to them is steep.
constexpr double parallel = 0.7, steep = 0.3;

/// Share of neighbors that oppose a plane on the wrong side.
constexpr double nearly_all = 0.8;

/// How well planes fit the points around a point; 0 is best.
struct Fit {
  double slope, disagreement;
};

/// The 33rd percentile.
double third(std::span<double> values) { return detail::value_at(values, values.size() / 3); }

/// How well a field of normals fits the points around point i. Between two correct planes a neighbor lies in their mean plane,
/// whatever the curvature. Returns the 33rd percentile of the slopes over that plane, and of the angles between the planes in
/// radians, over the nearest neighbors. Other faces of a corner and other sheets then have no influence.
Fit measure_fit(const CleanPoints& cloud, const Neighborhoods& neighborhoods, std::span<const Vec3> normals, Index i) {
  std::array<double, max_neighbors> slopes, angles;
  std::size_t count = 0;
  for (Index j : neighborhoods.of(i)) {
    if (count == max_neighbors) break;
    if (normals[j] == Vec3{0, 0, 0}) continue;
    const Vec3 edge = cloud.points[j] - cloud.points[i];
    const MeanPlane mean(normals[i], normals[j]);
    slopes[count] = std::abs(dot(mean.normal, edge)) / norm(edge);
    angles[count++] = 2 * norm(mean.across);
  }
  if (count == 0) return {0, 0};
  return {third(std::span(slopes).first(count)), third(std::span(angles).first(count))};
}

bool contradicts(const Fit& given, const Fit& fitted) {
  return given.slope > std::max(min_slope, contradiction * fitted.slope) ||
         given.disagreement > std::max(min_disagreement, disagreement * fitted.disagreement);
}

/// Also marks points with mostly marked neighbors: some of many noisy normals are correct by chance.
std::vector<char> by_majority(const Neighborhoods& neighborhoods, const std::vector<char>& marked, unsigned threads) {
  std::vector<char> result = marked;
  detail::parallel_chunks(static_cast<Offset>(marked.size()), points_per_task, threads, [&](Offset begin, Offset end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      const auto neighbors = neighborhoods.of(i);
      const auto count = std::ranges::count_if(neighbors, [&](Index j) { return marked[j] != 0; });
      result[i] |= static_cast<char>(2 * count > static_cast<Offset>(neighbors.size()));
    }
  });
  return result;
}

/// Whether the input plane of point i meets that of a neighbor in a sharp crease. Fitted planes lie halfway between both sides
/// of a crease, so they decide which sides of the input planes correspond. In thin walls they do not, because they are fitted
/// to both sheets.
bool is_beside_crease(const CleanPoints& cloud, const Neighborhoods& neighborhoods, std::span<const Vec3> given,
                      std::span<const Vec3> fitted, Index i) {
  const double own_side = dot(given[i], fitted[i]);
  bool found = false;
  for (const Index j : neighborhoods.of(i)) {
    if (given[j] == Vec3{0, 0, 0} || fitted[j] == Vec3{0, 0, 0}) continue;
    const double cosine = dot(given[i], given[j]);
    const Vec3 edge = cloud.points[j] - cloud.points[i];
    if (std::abs(cosine) > parallel && std::abs(dot(given[i], edge)) > steep * norm(edge)) return false;
    const double same_side = own_side * dot(given[j], fitted[j]) * dot(fitted[i], fitted[j]);
    found |= std::copysign(1.0, same_side) * cosine < sharpest_cosine;
  }
  return found;
}

/// Very noisy normals may lie on the wrong side. Turns over contradicted planes that nearly all neighbors oppose. In a thin wall, neighbors
/// of both sheets have opposite sides, but the own sheet has as many.
void turn_outliers_over(const Neighborhoods& neighborhoods, const std::vector<char>& contradicted, unsigned threads,
                        TangentPlanes& planes) {
  std::vector<char> is_outlier(contradicted.size(), 0);
  detail::for_each_index(contradicted.size(), threads, [&](std::size_t i) {
    if (!contradicted[i]) return;
    const auto neighbors = neighborhoods.of(static_cast<Index>(i));
    const auto opposed =
        std::ranges::count_if(neighbors, [&](Index j) { return dot(planes.normals[i], planes.normals[j]) < 0; });
    is_outlier[i] = static_cast<double>(opposed) > nearly_all * static_cast<double>(neighbors.size());
  });
  for (std::size_t i = 0; i < is_outlier.size(); ++i)
    if (is_outlier[i]) planes.normals[i] = -1.0 * planes.normals[i];
}

}  // namespace

std::vector<char> apply_input_planes(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                     std::span<const Vec3> given, unsigned threads, TangentPlanes& planes) {
  const auto n = static_cast<Offset>(cloud.points.size());
  std::vector<char> missing(static_cast<std::size_t>(n), 0), contradicted = missing, beside_crease = missing;
  detail::parallel_chunks(n, points_per_task, threads, [&](Offset begin, Offset end) {
    for (Offset i = begin; i < end; ++i) {
      const auto point = static_cast<Index>(i);
      missing[i] = given[i] == Vec3{0, 0, 0};
      if (missing[i] || !planes.has_plane(point)) continue;
      contradicted[i] = contradicts(measure_fit(cloud, neighborhoods, given, point),
                                    measure_fit(cloud, neighborhoods, planes.normals, point));
      beside_crease[i] = !contradicted[i] && is_beside_crease(cloud, neighborhoods, given, planes.normals, point);
    }
  });
  contradicted = by_majority(neighborhoods, contradicted, threads);
  for (Offset i = 0; i < n; ++i) {
    planes.estimated += missing[i];
    if (missing[i]) continue;
    planes.contradicted += contradicted[i];
    if (!contradicted[i] && !beside_crease[i])
      planes.normals[i] = given[i];
    else if (dot(planes.normals[i], given[i]) < 0)
      planes.normals[i] = -1.0 * planes.normals[i];
  }
  turn_outliers_over(neighborhoods, contradicted, threads, planes);
  return missing;
}

namespace {

/// A neighborhood is narrow, and needs more points, if its second principal variance is below this fraction of the first.
constexpr double narrow_ratio = 1e-3;

/// If the second variance is below this fraction of the first, neighbors may lie along a curve that bends by less than a right
/// angle.
constexpr double bent_ratio = 0.05;

/// With fewer points a curve cannot be distinguished from a plane.
constexpr std::size_t min_curve_points = 8;

/// Fewer neighbors than half of this number are too few for a one-ring of triangles.
constexpr std::size_t min_neighbors = 8;

/// Buffers of one thread's queries.
struct QueryBuffers {
  std::vector<Index> indices;
  std::vector<double> squared;
};

/// Squared distances that differ by a smaller fraction are equal; on lattices they differ by rounding.
constexpr double equal_distances = 1e-9;

/// The k nearest of k + 1 neighbors, without those as far away as the one left out. Equally near points are
/// thus treated alike. If fewer than half of k would remain, keeps all k.
std::span<const Index> whole_shells(std::span<const Vec3> points, Index i, std::span<const Index> neighbors, Index k) {
  const auto most = static_cast<std::size_t>(k);
  if (neighbors.size() <= most) return neighbors;
  const auto squared = [&](std::size_t m) {
    const Vec3 offset = points[neighbors[m]] - points[i];
    return dot(offset, offset);
  };
  const double beyond = squared(most) * (1 - equal_distances);
  std::size_t count = most;
  while (count > 0 && squared(count - 1) >= beyond) --count;
  return neighbors.first(2 * count >= std::max(most, min_neighbors) ? count : most);
}

/// The k neighbors of point i, nearest first, without i; valid until the next use of the buffers.
std::span<const Index> neighbors_of(std::span<const Vec3> points, Index i, const NeighborSearch& search, Index k,
                                    QueryBuffers& buffers) {
  buffers.indices.resize(static_cast<std::size_t>(k) + 2);
  buffers.squared.resize(buffers.indices.size());
  const auto wanted = static_cast<Index>(std::min(buffers.indices.size(), points.size()));
  const Index found = search.nearest(points[i], buffers.indices, buffers.squared);
  buffers.indices.resize(static_cast<std::size_t>(wanted));
  for (Index j : buffers.indices)
    if (found != wanted || j < 0 || static_cast<std::size_t>(j) >= points.size())
      throw InvalidArgument("options.search: expected " + detail::counted(wanted, "neighbor") + " of point " +
                            std::to_string(i) + ", found " + std::to_string(found) + ", among them point " +
                            std::to_string(j));
  // The point is its own nearest neighbor, but a search in lower precision may rank it elsewhere or miss it.
  const auto self = std::find(buffers.indices.begin(), buffers.indices.end(), i);
  buffers.indices.erase(self == buffers.indices.end() ? self - 1 : self);
  return whole_shells(points, i, buffers.indices, k);
}

/// The neighbors, nearest first, up to the first gap after half of k.
std::span<const Index> before_gap(std::span<const Vec3> points, Index i, std::span<const Index> neighbors, Index k,
                                  double ratio) {
  for (auto m = static_cast<std::size_t>((k + 1) / 2); m < neighbors.size(); ++m)
    if (norm(points[neighbors[m]] - points[i]) > ratio * norm(points[neighbors[m - 1]] - points[i]))
      return neighbors.first(m);
  return neighbors;
}

/// Keeps only those of the `counts[i]` neighbors at i * k whose neighborhoods reach point i. Updates the radius.
/// @return whether all were kept
bool drop_unreachable(const CleanPoints& cloud, const CloudOptions& options, std::vector<Index>& counts,
                      Neighborhoods& result) {
  std::vector<double> radius = result.radius;
  std::atomic<bool> all{true};
  detail::parallel_chunks(
      static_cast<Offset>(counts.size()), points_per_task, options.threads, [&](Offset begin, Offset end) {
        for (Offset i = begin; i < end; ++i) {
          const auto first = result.indices.begin() + i * result.k;
          const auto last = std::remove_if(first, first + counts[i], [&](Index j) {
            return norm(cloud.points[j] - cloud.points[i]) > options.max_edge_ratio * result.radius[j];
          });
          if (last == first + counts[i]) continue;
          all = false;
          counts[i] = static_cast<Index>(last - first);
          if (counts[i] > 0) radius[i] = norm(cloud.points[*(last - 1)] - cloud.points[i]);
        }
      });
  result.radius = std::move(radius);
  return all;
}

/// Closes the gaps between neighborhoods after neighbors were dropped.
void compact(const std::vector<Index>& counts, Neighborhoods& result) {
  const auto n = static_cast<Offset>(counts.size()), k = static_cast<Offset>(result.k);
  result.begin.assign(static_cast<std::size_t>(n) + 1, 0);
  for (Offset i = 0; i < n; ++i) {
    result.begin[i + 1] = result.begin[i] + counts[i];
    if (result.begin[i] < i * k)
      std::copy_n(result.indices.begin() + i * k, counts[i], result.indices.begin() + result.begin[i]);
  }
  result.unreachable = n * k - result.begin[n];
  result.indices.resize(static_cast<std::size_t>(result.begin[n]));
}

/// Whether point i and its neighbors lie along a curve in their plane, as on a scan line around a pipe. The tolerance to a
/// parabola is that of narrow neighborhoods to a line.
bool is_on_curve(std::span<const Vec3> points, Index i, std::span<const Index> neighbors, const PlaneFit& fit) {
  if (neighbors.size() < min_curve_points) return false;
  const Vec3 across = cross(fit.normal, fit.along);
  const double unit = norm(points[neighbors.back()] - points[i]);
  // Least-squares fit of (1, s, s^2) to t, where s runs along the neighborhood and t across it.
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  normal_matrix(0, 0) = 1;  // the point itself
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double squares = 0;
  for (const Index j : neighbors) {
    const Vec3 offset = points[j] - points[i];
    const double s = dot(fit.along, offset) / unit, t = dot(across, offset) / unit;
    const Eigen::Vector3d row(1, s, s * s);
    normal_matrix += row * row.transpose();
    right += t * row;
    squares += t * t;
  }
  const double count = normal_matrix(0, 0), mean = normal_matrix(0, 1) / count;
  const double variance = normal_matrix(1, 1) / count - mean * mean;
  return squares - right.dot(normal_matrix.ldlt().solve(right)) <= narrow_ratio * count * variance;
}

/// Whether the neighbors do not determine a plane.
bool is_narrow(const PlaneFit& fit, std::span<const Vec3> points, Index i, std::span<const Index> neighbors) {
  return !(fit.ratio > narrow_ratio) || (fit.ratio < bent_ratio && is_on_curve(points, i, neighbors, fit));
}

/// More neighbors for a point with a narrow neighborhood.
struct WiderNeighborhood {
  Index point;
  std::vector<Index> neighbors;
};

/// Fits a plane to increasingly many neighbors until they are not narrow. If they stay narrow, returns the widest fit.
PlaneFit fit_wider(std::span<const Vec3> points, const NeighborSearch& search, Index k, double max_edge_ratio,
                   WiderNeighborhood& wider) {
  PlaneFit fit;
  QueryBuffers buffers;
  for (Index factor : {2, 4}) {
    const auto neighbors = before_gap(
        points, wider.point, neighbors_of(points, wider.point, search, factor * k, buffers), k, max_edge_ratio);
    wider.neighbors.assign(neighbors.begin(), neighbors.end());
    fit = fit_plane(points, wider.point, wider.neighbors);
    if (!is_narrow(fit, points, wider.point, wider.neighbors)) break;
  }
  return fit;
}

/// Replaces neighborhoods by wider ones, which ascend by point.
void replace(Neighborhoods& neighborhoods, const std::vector<WiderNeighborhood>& wider, std::span<const Vec3> points) {
  if (wider.empty()) return;
  Neighborhoods result{neighborhoods.k, {0}, {}, std::move(neighborhoods.radius)};
  result.begin.reserve(neighborhoods.begin.size());
  result.indices.reserve(neighborhoods.indices.size());
  auto next = wider.begin();
  for (Index i = 0; i + 1 < static_cast<Index>(neighborhoods.begin.size()); ++i) {
    std::span<const Index> neighbors = neighborhoods.of(i);
    if (next != wider.end() && next->point == i) {
      neighbors = next++->neighbors;
      if (!neighbors.empty()) result.radius[i] = norm(points[neighbors.back()] - points[i]);
    }
    result.indices.insert(result.indices.end(), neighbors.begin(), neighbors.end());
    result.begin.push_back(static_cast<Offset>(result.indices.size()));
  }
  neighborhoods = std::move(result);
}

/// Unit vector of an input normal; zero if it has no direction.
Vec3 direction(const Vec3& given) {
  const double largest = std::max({std::abs(given[0]), std::abs(given[1]), std::abs(given[2])});
  if (!(largest > 0) || !std::isfinite(given[0] + given[1] + given[2])) return {0, 0, 0};
  return normalized((1.0 / largest) * given);
}

/// Fits a plane to the neighbors of every point. Uses wider neighborhoods where they are narrow.
void fit_planes(const CleanPoints& cloud, const NeighborSearch& search, const CloudOptions& options,
                Neighborhoods& neighborhoods, TangentPlanes& planes) {
  const auto n = static_cast<Offset>(cloud.points.size());
  planes.normals.assign(static_cast<std::size_t>(n), Vec3{0, 0, 0});
  std::vector<std::vector<WiderNeighborhood>> wider(
      static_cast<std::size_t>((n + points_per_task - 1) / points_per_task));
  std::atomic<Index> thick{0};
  detail::parallel_chunks(n, points_per_task, options.threads, [&](Offset begin, Offset end) {
    Index thick_here = 0;
    for (Offset i = begin; i < end; ++i) {
      const auto point = static_cast<Index>(i);
      PlaneFit fit = fit_plane(cloud.points, point, neighborhoods.of(point));
      if (is_narrow(fit, cloud.points, point, neighborhoods.of(point)) && n > neighborhoods.k + 1) {
        WiderNeighborhood candidate{point, {}};
        fit = fit_wider(cloud.points, search, neighborhoods.k, options.max_edge_ratio, candidate);
        wider[begin / points_per_task].push_back(std::move(candidate));
      }
      planes.normals[i] = fit.normal;
      thick_here += fit.thickness > thick_ratio;
    }
    thick += thick_here;
    if (options.progress.stop.stop_requested()) throw Cancelled("cancelled during normal estimation");
  });
  planes.thick = thick;
  std::vector<WiderNeighborhood> all;
  for (auto& part : wider) std::move(part.begin(), part.end(), std::back_inserter(all));
  replace(neighborhoods, all, cloud.points);
}

}  // namespace

Neighborhoods find_neighborhoods(const CleanPoints& cloud, const NeighborSearch& search, Index wanted,
                                 const CloudOptions& options) {
  const auto n = static_cast<Offset>(cloud.points.size());
  Neighborhoods result;
  result.k = static_cast<Index>(std::min<Offset>(wanted, n - 1));
  const Offset k = result.k;
  std::vector<Index> counts(static_cast<std::size_t>(n));
  result.indices.resize(static_cast<std::size_t>(n * k));
  result.radius.resize(static_cast<std::size_t>(n));
  detail::parallel_chunks(n, points_per_task, options.threads, [&](Offset begin, Offset end) {
    QueryBuffers buffers;
    for (Offset i = begin; i < end; ++i) {
      const auto point = static_cast<Index>(i);
      const auto neighbors =
          before_gap(cloud.points, point, neighbors_of(cloud.points, point, search, result.k, buffers), result.k,
                     options.max_edge_ratio);
      std::copy(neighbors.begin(), neighbors.end(), result.indices.begin() + i * k);
      counts[i] = static_cast<Index>(neighbors.size());
      result.radius[i] = norm(cloud.points[neighbors.back()] - cloud.points[i]);
    }
    if (options.progress.stop.stop_requested()) throw Cancelled("cancelled during the neighbor search");
  });
  for (int round = 0; round < reach_rounds && !drop_unreachable(cloud, options, counts, result); ++round) continue;
  compact(counts, result);
  options.progress.step("neighbors", 1.0);
  return result;
}

void refill_neighborhoods(const CleanPoints& cloud, const NeighborSearch& search, std::span<const Index> points,
                          const CloudOptions& options, Neighborhoods& neighborhoods) {
  std::vector<WiderNeighborhood> found(points.size());
  detail::parallel_chunks(
      static_cast<Offset>(points.size()), points_per_task, options.threads, [&](Offset begin, Offset end) {
        QueryBuffers buffers;
        for (Offset m = begin; m < end; ++m) {
          const Index i = points[m];
          const auto neighbors =
              before_gap(cloud.points, i, neighbors_of(cloud.points, i, search, neighborhoods.k, buffers),
                         neighborhoods.k, options.max_edge_ratio);
          found[m].point = i;
          std::copy_if(neighbors.begin(), neighbors.end(), std::back_inserter(found[m].neighbors), [&](Index j) {
            return norm(cloud.points[j] - cloud.points[i]) <= options.max_edge_ratio * neighborhoods.radius[j];
          });
        }
      });
  replace(neighborhoods, found, cloud.points);
}

double spacing_at(const Neighborhoods& neighborhoods, Index i) {
  const auto count = static_cast<double>(neighborhoods.begin[i + 1] - neighborhoods.begin[i]);
  return neighborhoods.radius[i] * std::sqrt(std::numbers::pi / std::max(1.0, count));
}

double spacing(const Neighborhoods& neighborhoods, std::span<const Index> points) {
  std::vector<double> spacings;
  spacings.reserve(points.size());
  for (const Index i : points) spacings.push_back(spacing_at(neighborhoods, i));
  return detail::median(spacings);
}

double spacing(const Neighborhoods& neighborhoods) {
  std::vector<Index> all(neighborhoods.radius.size());
  std::iota(all.begin(), all.end(), Index{0});
  return spacing(neighborhoods, all);
}

TangentPlanes find_tangent_planes(const CleanPoints& cloud, std::span<const Vec3> given, const NeighborSearch& search,
                                  Neighborhoods& neighborhoods, const CloudOptions& options) {
  const auto n = static_cast<Offset>(cloud.points.size());
  TangentPlanes planes;
  fit_planes(cloud, search, options, neighborhoods, planes);
  std::vector<char> missing(static_cast<std::size_t>(n), 1);
  if (given.empty()) {
    planes.estimated = static_cast<Index>(n);
  } else {
    std::vector<Vec3> directions(static_cast<std::size_t>(n));
    for (Offset i = 0; i < n; ++i) directions[i] = direction(given[cloud.input[i]]);
    missing = apply_input_planes(cloud, neighborhoods, directions, options.threads, planes);
  }
  for (Index i = 0; planes.estimated < static_cast<Index>(n) && i < static_cast<Index>(n); ++i) {
    if (!missing[i]) continue;
    double agreement = 0;
    for (Index j : neighborhoods.of(i))
      if (!missing[j]) agreement += dot(planes.normals[i], planes.normals[j]);
    if (agreement < 0) planes.normals[i] = -1.0 * planes.normals[i];
  }
  options.progress.step("normals", 1.0);
  return planes;
}

namespace {

/// Points lie on a line, without a plane, if their second principal variance is below this fraction of the first.
constexpr double collinear_ratio = 1e-10;

}  // namespace

PlaneFit fit_plane(std::span<const Vec3> points, Index i, std::span<const Index> neighbors) {
  const Vec3 origin = points[i];
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (Index j : neighbors) {
    const Vec3 offset = points[j] - origin;
    const Eigen::Map<const Eigen::Vector3d> v(offset.data());
    mean += v;
    second.noalias() += v * v.transpose();
  }
  const double count = static_cast<double>(neighbors.size()) + 1.0;  // with the point itself
  mean /= count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(second / count - mean * mean.transpose());
  const auto& variance = eigen.eigenvalues();
  const double ratio = variance[2] > 0 ? variance[1] / variance[2] : 0.0;
  if (!(ratio > collinear_ratio)) return {};
  const auto axis = [&](int k) {
    const Eigen::Vector3d v = eigen.eigenvectors().col(k);
    return normalized(Vec3{v[0], v[1], v[2]});
  };
  return {axis(0), axis(2), ratio, std::max(0.0, variance[0]) / variance[1]};
}

}  // namespace ahm::pointcloud
