/// \file
/// Views of results as Eigen matrices, without a copy. Header only: no Eigen object is passed to the compiled library, so only the
/// caller's compiler flags determine its alignment.
///
/// The caller provides Eigen 3.4: call find_package(Eigen3) and link Eigen3::Eigen. The CMake package of libahm does not search for
/// it.
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

/// Coordinates phi of all vertices, n x d. Valid while the map exists.
inline RowMajorMap coordinates(const LogMap& map) { return {map.coordinates().data(), map.size(), map.dimension()}; }
RowMajorMap coordinates(const LogMap&&) = delete;

/// Values of all vertices, n x width. Valid while the field exists.
inline RowMajorMap values(const VertexField& field) {
  return {field.values.data(), static_cast<Eigen::Index>(field.status.size()), field.width};
}
RowMajorMap values(const VertexField&&) = delete;

}  // namespace ahm
