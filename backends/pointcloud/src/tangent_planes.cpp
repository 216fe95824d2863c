#include "tangent_planes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <cmath>

#include "ahm/detail/parallel.hpp"
#include "vec3.hpp"

namespace ahm::pointcloud {
namespace {

constexpr Offset chunk = 4096;  // points per task

/// Neighbours on a line have a second principal variance below this share of the first.
constexpr double collinear_ratio = 1e-10;

/// Direction of least variance of the points `indices` and point i; zero when they lie on a line.
Vec3 principal_normal(std::span<const Vec3> points, Index i, std::span<const Index> indices) {
  const Vec3 origin = points[i];
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (Index j : indices) {
    const Vec3 offset = points[j] - origin;
    const Eigen::Map<const Eigen::Vector3d> v(offset.data());
    mean += v;
    second.noalias() += v * v.transpose();
  }
  const double count = static_cast<double>(indices.size()) + 1.0;
  mean /= count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(second / count - mean * mean.transpose());
  const auto& variance = eigen.eigenvalues();
  if (!(variance[1] > collinear_ratio * variance[2])) return {0, 0, 0};
  const Eigen::Vector3d n = eigen.eigenvectors().col(0);
  return normalized({n[0], n[1], n[2]});
}

/// Looks for a plane among more and more neighbours.
Vec3 wider_normal(std::span<const Vec3> points, Index i, const NeighborSearch& search, Index k) {
  for (Index wider : {2 * k, 4 * k}) {
    std::vector<Index> indices(static_cast<std::size_t>(wider) + 1);
    std::vector<double> squared(indices.size());
    const Index found = search.nearest(points[i], indices, squared);
    const Vec3 normal = principal_normal(points, i, std::span(indices).first(static_cast<std::size_t>(found)));
    if (normal != Vec3{0, 0, 0}) return normal;
  }
  return {0, 0, 0};
}

/// Unit vector of a given normal, zero when it has no direction.
Vec3 direction(const Vec3& given) {
  const double largest = std::max({std::abs(given[0]), std::abs(given[1]), std::abs(given[2])});
  if (!(largest > 0) || !std::isfinite(given[0] + given[1] + given[2])) return {0, 0, 0};
  return normalized((1.0 / largest) * given);
}

}  // namespace

Neighborhoods find_neighborhoods(const CleanPoints& cloud, const NeighborSearch& search, const CloudOptions& options) {
  const auto n = static_cast<Offset>(cloud.points.size());
  Neighborhoods result;
  result.k = static_cast<Index>(std::min<Offset>(options.k, n - 1));
  const auto k = static_cast<std::size_t>(result.k);
  result.indices.resize(static_cast<std::size_t>(n) * k);
  result.radius.resize(static_cast<std::size_t>(n));
  std::atomic<Offset> done{0};
  detail::parallel_chunks(n, chunk, options.threads, [&](Offset begin, Offset end) {
    std::vector<Index> indices(k + 1);
    std::vector<double> squared(k + 1);
    for (Offset i = begin; i < end; ++i) {
      search.nearest(cloud.points[i], indices, squared);
      // The point is its own nearest neighbour; a search in lower precision may rank it elsewhere or miss it.
      auto self = std::find(indices.begin(), indices.end(), static_cast<Index>(i));
      if (self == indices.end()) --self;
      indices.erase(self);
      std::copy(indices.begin(), indices.end(), result.indices.begin() + i * static_cast<Offset>(k));
      result.radius[i] = norm(cloud.points[indices.back()] - cloud.points[i]);
      indices.resize(k + 1);
    }
    done += end - begin;
    if (options.progress.stop.stop_requested()) throw Cancelled("cancelled during the neighbour search");
  });
  options.progress.step("neighbours", 1.0);
  return result;
}

TangentPlanes find_tangent_planes(const CleanPoints& cloud, std::span<const Vec3> given, const NeighborSearch& search,
                                  const Neighborhoods& neighborhoods, const CloudOptions& options) {
  const auto n = static_cast<Offset>(cloud.points.size());
  TangentPlanes planes;
  planes.normals.assign(static_cast<std::size_t>(n), Vec3{0, 0, 0});
  std::atomic<Index> estimated{0};
  detail::parallel_chunks(n, chunk, options.threads, [&](Offset begin, Offset end) {
    Index count = 0;
    for (Offset i = begin; i < end; ++i) {
      const auto point = static_cast<Index>(i);
      Vec3& normal = planes.normals[i];
      if (!given.empty()) normal = direction(given[cloud.input[i]]);
      if (normal != Vec3{0, 0, 0}) continue;
      ++count;
      normal = principal_normal(cloud.points, point, neighborhoods.of(point));
      if (normal == Vec3{0, 0, 0}) normal = wider_normal(cloud.points, point, search, neighborhoods.k);
    }
    estimated += count;
    if (options.progress.stop.stop_requested()) throw Cancelled("cancelled during normal estimation");
  });
  planes.estimated = estimated;
  options.progress.step("normals", 1.0);
  return planes;
}

}  // namespace ahm::pointcloud
