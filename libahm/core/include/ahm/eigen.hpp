/// \file
/// Results seen as Eigen matrices, without a copy. Header only, so that no Eigen object crosses the library's border
/// and the caller's own compiler flags decide its alignment.
///
/// Eigen 3.4 is the caller's: libahm is built with it but its package neither needs nor looks for it. Before including this
/// header, find_package(Eigen3) and link Eigen3::Eigen.
///
/// \code
/// auto phi = ahm::coordinates(map);              // n x d
/// Eigen::VectorXd distance = phi.rowwise().norm();
/// \endcode
#pragma once

#include <Eigen/Core>

#include "ahm/fields/vector_heat.hpp"
#include "ahm/maps/log_map.hpp"

namespace ahm {

using RowMajorMap = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

/// phi, n x d; valid while the map lives.
inline RowMajorMap coordinates(const LogMap& map) { return {map.coordinates().data(), map.size(), map.dimension()}; }
RowMajorMap coordinates(LogMap&&) = delete;

/// n x width; valid while the field lives.
inline RowMajorMap values(const VertexField& field) {
  return {field.values.data(), static_cast<Eigen::Index>(field.status.size()), field.width};
}
RowMajorMap values(VertexField&&) = delete;

}  // namespace ahm
