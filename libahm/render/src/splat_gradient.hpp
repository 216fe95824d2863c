// Gradients of the values of a cloud, in the planes of its discs.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <vector>

#include "drawable.hpp"

namespace ahm::render {

/// Computes the gradients of two values by least squares over the neighbors on the same side of a cut, in the plane of the disc. Zero if
/// the neighbors do not span the plane.
struct SplatGradient {
  const std::vector<Eigen::Vector3f>& normals;
  const std::vector<std::array<std::uint32_t, splat_ring>>& rings;
  double values_per_length;  ///< length of the gradient of an isometric map
  bool is_cells = false;     ///< the first value is the number of a color

  /// @param k           index of the disc
  /// @param position    position(k): position of a disc
  /// @param value       value(k): the two values of a disc
  /// @param has_values  has_values(k): whether a disc has values
  template <class Position, class Value, class HasValues>
  std::array<Eigen::Vector3f, 2> operator()(std::size_t k, const Position& position, const Value& value,
                                            const HasValues& has_values) const {
    using Eigen::Vector3d;
    const Vector3d normal = normals[k].template cast<double>();
    if (!has_values(k) || !(normal.squaredNorm() > 0)) return {Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
    const Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
    Eigen::Matrix2d square = Eigen::Matrix2d::Zero(), right = Eigen::Matrix2d::Zero();
    for (const std::uint32_t other : rings[k]) {
      const Vector3d d = position(other) - position(k);
      const Eigen::Vector2d change = value(other) - value(k);
      if (!has_values(other) || change.norm() > 5 * values_per_length * d.norm()) continue;
      if (is_cells && change.x() != 0) continue;
      const Eigen::Vector2d flat(d.dot(x), d.dot(y));
      square += flat * flat.transpose();
      right += flat * change.transpose();
    }
    const double trace = square.trace();
    if (!(square.determinant() > 1e-3 * trace * trace)) return {Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
    const Eigen::Matrix2d g = square.inverse() * right;  // column c: gradient of value c along x and y
    return {(g(0, 0) * x + g(1, 0) * y).template cast<float>(), (g(0, 1) * x + g(1, 1) * y).template cast<float>()};
  }
};

}  // namespace ahm::render
