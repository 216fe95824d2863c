#include "given_planes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ahm/util/parallel.hpp"
#include "ahm/util/quantile.hpp"
#include "ahm/util/vec.hpp"
#include "edge_unfolding.hpp"
#include "points_per_task.hpp"

namespace ahm::pointcloud {
namespace {

/// A given plane is contradicted when its slope is this many times that of the plane fitted to the points, and more than
/// normals written with three digits have.
constexpr double contradiction = 2;
constexpr double least_slope = 2e-3;

/// It is also contradicted when it disagrees with those around it by this many times the angle between fitted planes, and
/// this much: that tells on points too noisy for slopes to tell.
constexpr double disagreement = 2;
constexpr double least_disagreement = 0.1;

constexpr std::size_t most_neighbors = 12;

/// Given planes of neighbours that bend by more than this are told from opposite ones by nothing but their signs, which may be
/// wrong: beside sharper creases the fitted planes count, which bend from point to point.
constexpr double sharpest_cosine = 0.1;
/// Of neighbours in the other sheet of a thin wall: their planes are parallel, and the way there is steep.
constexpr double parallel = 0.7, steep = 0.3;

struct Fit {
  double slope, disagreement;
};

/// The value of the best third.
double third(std::span<double> values) { return detail::value_at(values, values.size() / 3); }

/// How well a field of normals fits the points around point i. Between two planes that are right, a neighbour lies in their
/// mean plane, whatever the curvature: slopes over it, and angles between the planes, in radians, of the best third of the
/// nearest neighbours, so that other faces of a corner and other sheets do not count.
Fit fit_of(const CleanPoints& cloud, const Neighborhoods& neighborhoods, std::span<const Vec3> normals, Index i) {
  std::array<double, most_neighbors> slopes, angles;
  std::size_t count = 0;
  for (Index j : neighborhoods.of(i)) {
    if (count == most_neighbors) break;
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
  return given.slope > std::max(least_slope, contradiction * fitted.slope) ||
         given.disagreement > std::max(least_disagreement, disagreement * fitted.disagreement);
}

/// Marks points, too, most of whose neighbors are marked: noisy normals are right by chance at some points, and not to be trusted
/// there either.
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

/// Whether the given plane of point i meets that of a neighbour in such a crease. The fitted planes, which are half way between both
/// sides of one, tell which sides of the given ones belong together; not so in thin walls, where they are of both sheets.
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

}  // namespace

std::vector<char> take_given_planes(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                    std::span<const Vec3> given, unsigned threads, TangentPlanes& planes) {
  const auto n = static_cast<Offset>(cloud.points.size());
  std::vector<char> missing(static_cast<std::size_t>(n), 0), contradicted = missing, beside_crease = missing;
  detail::parallel_chunks(n, points_per_task, threads, [&](Offset begin, Offset end) {
    for (Offset i = begin; i < end; ++i) {
      const auto point = static_cast<Index>(i);
      missing[i] = given[i] == Vec3{0, 0, 0};
      if (missing[i] || !planes.has_plane(point)) continue;
      contradicted[i] =
          contradicts(fit_of(cloud, neighborhoods, given, point), fit_of(cloud, neighborhoods, planes.normals, point));
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
  return missing;
}

}  // namespace ahm::pointcloud
