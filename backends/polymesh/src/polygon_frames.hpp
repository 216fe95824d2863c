/// \file
/// Tangent planes of vertices and planes of polygons, and the rotations between them.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "ahm/polymesh/polygon_mesh.hpp"

namespace ahm::polymesh {

/// An orthonormal frame.
struct Axes {
  Eigen::Vector3d x, y, normal;

  /// Components of the projection of a vector, as x + i y.
  std::complex<double> components(const Eigen::Vector3d& v) const { return {x.dot(v), y.dot(v)}; }
};

/// The axes with this normal whose x axis lies as near as possible to a direction.
Axes axes_along(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction);

struct Frames {
  std::vector<Axes> vertex;  ///< perpendicular to the sum of the vector areas around
  std::vector<Axes> face;    ///< perpendicular to the vector area, x along the first side
  /// Per corner z: a tangent vector a + i b of the vertex becomes z (a + i b) in the plane of the face, or, where the
  /// corner is mirrored, the conjugate of that.
  std::vector<std::complex<double>> turn;
};

Frames find_frames(const PolygonMesh& mesh, unsigned threads);

}  // namespace ahm::polymesh
