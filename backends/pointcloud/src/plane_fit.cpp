#include "ahm/pointcloud/plane_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {
namespace {

/// On a line, without a plane: second principal variance below this share of the first.
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
