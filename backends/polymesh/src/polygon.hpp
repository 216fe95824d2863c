/// \file
/// One polygon, refined by its virtual vertex [BHKB20].
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <span>
#include <vector>

#include "ahm/polymesh/polygon_mesh.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"

namespace ahm::polymesh {

/// Work space for one polygon after the other. Lengths are in units of the mesh's `length_unit`.
class Polygon {
 public:
  /// Takes the corners of a face and finds its virtual vertex: the point p that minimizes sum |(x_c - p) x (x_c+1 - p)|^2,
  /// as p = sum w_c x_c with sum w_c = 1 and the smallest sum w_c^2.
  void read(const PolygonMesh& mesh, Index face);

  /// Takes the corners alone: enough for `is_collinear`, `vector_area` and `corner`.
  void read_corners(const PolygonMesh& mesh, Index face);

  std::size_t size() const { return corner_.size(); }
  const Eigen::Vector3d& corner(std::size_t c) const { return corner_[c]; }
  const Eigen::Vector3d& middle() const { return middle_; }
  /// w_c
  std::span<const double> weights() const { return weight_; }
  /// Vector area: half the sum of the cross products of consecutive corners.
  Eigen::Vector3d vector_area() const;
  /// Whether all corners lie on one line, to 1e-10 of its length or rounding.
  bool is_collinear() const;
  /// Whether a triangle about p faces away from the vector area.
  bool folds() const;
  /// Appends the triangles of the polygon seen along its vector area, cut off ear by ear, as places of corners. Where the
  /// outline seen crosses itself, a quad is cut along a diagonal; for others, returns false and appends nothing.
  bool cut_ears(std::vector<std::array<std::size_t, 3>>& triangles) const;
  /// sum w_c x_c of other positions of the corners.
  Vec3 blend(std::span<const Vec3> positions, std::span<const Index> corners) const;

  /// Stiffness of the triangles around p restricted to functions with u(p) = sum w_c u_c ([BHKB20] Eq. 11): writes the
  /// m x m weights -K_cd, row major, 0 on the diagonal.
  void stiffness(double* weights);
  /// Lumped mass of the same: row sums, but at least half of what the triangles at the corner give without p.
  void mass(double* masses) const;

 private:
  void find_middle();
  void find_weights();

  std::vector<Eigen::Vector3d> corner_;
  Eigen::Vector3d middle_;
  std::vector<double> weight_, spoke_;
};

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

/// Weights, logs, transports and masses of all pairs of corners of all faces.
CsrGraphData polygon_edges(const PolygonMesh& mesh, const Frames& frames, const PolygonOptions& options,
                           PolygonDetails& report);

/// Per corner as stored: its place in the plane perpendicular to the face's vector area, from the first corner, the first side
/// along the x axis, counter-clockwise; in units of `length_unit`. A face without area lies along that axis.
std::vector<Vec2> flat_faces(const PolygonMesh& mesh);

}  // namespace ahm::polymesh
