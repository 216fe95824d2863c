/// \file
/// Polyhedral surfaces for tests, random points on them, and curves in space.
#pragma once

#include <random>
#include <vector>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/surface/exact/geodesic_path.hpp"
#include "ahm/trimesh/triangle_mesh.hpp"

namespace ahm::test {

/// A mesh in space as a polyhedral surface.
struct Polyhedron {
  explicit Polyhedron(const Mesh& mesh);

  Vec3 position(const exact::MeshPoint& point) const;
  /// Length of the polygon through these points.
  double length(const std::vector<exact::MeshPoint>& points) const;

  trimesh::TriangleMesh mesh;
  exact::PolyhedralSurface surface;
};

/// An icosahedron with points inserted into its faces, one after the other, beside their corners, as near as 1e-6 to
/// `farthest` of a face, and a little off.
Mesh nested_needles(unsigned seed, double farthest = 0.3);

/// As the triangle backend lays it out, without faces that it drops.
FlatTriangles flat_triangles(const Mesh& mesh);
exact::PolyhedralSurface surface_of(const trimesh::TriangleMesh& mesh);

/// Uniformly distributed barycentric coordinates in a random face.
exact::MeshPoint random_point(const exact::PolyhedralSurface& surface, std::mt19937_64& random);

double distance(const Vec3& a, const Vec3& b);

/// A cone with this angle about its apex (vertex 0), cut into sectors of the plane and these into triangles: flat but for
/// the apex, so that it unrolls. The outer boundary is a convex polygon.
struct PolarCone {
  PolarCone(double angle, Index sectors, Index rings);
  /// Distance of two vertices when unrolled.
  double distance(Index a, Index b) const;

  double angle;
  std::vector<Vec2> polar;  ///< per vertex: radius and angle
  std::vector<Triangle> faces;
  std::vector<std::array<double, 3>> lengths;
};

}  // namespace ahm::test
