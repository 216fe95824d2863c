/// \file
/// Polygons with virtual vertices [BHKB20]: matrices, tangent frames, and edges of the graph.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <span>
#include <vector>

#include "ahm/polymesh/polygon_mesh.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"

namespace ahm::polymesh {

/// Work space that processes one polygon after the other. Lengths are in units of the mesh's `length_unit`.
class Polygon {
 public:
  /// Reads the corners of a face and finds its virtual vertex: the point p that minimizes sum |(x_c - p) x (x_c+1 - p)|^2,
  /// as p = sum w_c x_c with sum w_c = 1 and the smallest sum w_c^2.
  void read(const PolygonMesh& mesh, Index face);

  /// Reads only the corners: enough for `is_collinear`, `vector_area` and `corner`.
  void read_corners(const PolygonMesh& mesh, Index face);

  std::size_t size() const { return corner_.size(); }
  const Eigen::Vector3d& corner(std::size_t c) const { return corner_[c]; }
  const Eigen::Vector3d& middle() const { return middle_; }
  /// The weights w_c of the corners.
  std::span<const double> weights() const { return weight_; }
  /// Vector area: half the sum of the cross products of consecutive corners.
  Eigen::Vector3d vector_area() const;
  /// Whether all corners lie on one line, to 1e-10 of its length or rounding.
  bool is_collinear() const;
  /// Whether a triangle at p faces away from the vector area.
  bool is_folded() const;
  /// Cuts ears off the polygon, projected along its vector area, and appends them as numbers of corners. If the projected
  /// outline crosses itself, cuts a quad along a diagonal, and appends nothing for other polygons.
  /// @return whether triangles were appended
  bool cut_ears(std::vector<std::array<std::size_t, 3>>& triangles) const;
  /// sum w_c x_c for other positions of the corners.
  Vec3 blend(std::span<const Vec3> positions, std::span<const Index> corners) const;

  /// Stiffness of the triangles around p, restricted to functions with u(p) = sum w_c u_c ([BHKB20] Eq. 11).
  /// @param weights  output: m x m values -K_cd, row major, 0 on the diagonal
  void stiffness(double* weights);
  /// Lumped mass with the same restriction: row sums, but at least half of the mass that the triangles at the corner have
  /// without p.
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

/// Axes with a normal, and with the x axis as near as possible to a direction.
Axes axes_along(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction);

/// Tangent frames of vertices and faces, and rotations between them.
struct Frames {
  std::vector<Axes> vertex;  ///< perpendicular to the sum of the vector areas around the vertex
  std::vector<Axes> face;    ///< perpendicular to the vector area, x along the first side
  /// Per corner, a complex number z of unit length: a tangent vector a + i b of the vertex becomes z (a + i b) in the plane of
  /// the face, or the conjugate of that where the corner is mirrored.
  std::vector<std::complex<double>> turn;
};

Frames find_frames(const PolygonMesh& mesh, unsigned threads);

/// Builds the graph: weights, logarithms, transports and masses of all pairs of corners of all faces.
CsrGraphData polygon_edges(const PolygonMesh& mesh, const Frames& frames, const PolygonOptions& options,
                           PolygonDetails& report);

/// For each corner as stored, its position in the plane perpendicular to the face's vector area, in units of `length_unit`. The
/// first corner is the origin, the first side lies along the x axis, and corners are counter-clockwise. A face without area
/// lies along the x axis.
std::vector<Vec2> flat_faces(const PolygonMesh& mesh);

}  // namespace ahm::polymesh
