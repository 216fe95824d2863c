/// \file
/// Triangle meshes as polyhedral surfaces, points on them, and cones that unroll.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/surface/exact/geodesic_path.hpp"
#include "ahm/util/vec.hpp"
#include "surface/surfaces.hpp"

namespace ahm::test {

inline exact::PolyhedralSurface polyhedral(const trimesh::TriangleMesh& mesh) {
  std::vector<exact::FaceSides> sides;
  for (Index f = 0; f < mesh.face_count(); ++f) sides.push_back(mesh.layout(f));
  return {mesh.topology().half_edges(), sides, mesh.corners()};
}

/// A triangle mesh and its polyhedral surface, in units of `mesh.length_unit()`.
struct Polyhedron {
  explicit Polyhedron(const Mesh& shape)
      : mesh(trimesh::TriangleMesh::from_positions(shape.positions, shape.faces)), surface(polyhedral(mesh)) {}
  explicit Polyhedron(trimesh::TriangleMesh triangles) : mesh(std::move(triangles)), surface(polyhedral(mesh)) {}

  exact::MeshPoint vertex(Index v) const { return surface.vertex_point(Vertex(v)); }
  exact::ExactMap map(Index source, const exact::ExactOptions& options = {}) const {
    return exact::exact_map(surface, vertex(source), options);
  }
  exact::GeodesicPath path(const exact::MeshPoint& from, const exact::MeshPoint& to) const {
    return exact::geodesic_path(surface, from, to);
  }
  Vec3 position(Index v) const { return mesh.position(Vertex(v)); }
  Vec3 position(const exact::MeshPoint& point) const {
    Vec3 sum{};
    for (int s = 0; s < 3; ++s) sum = sum + point.barycentric[s] * position(surface.record(3 * point.face + s).tail);
    return sum;
  }
  /// Length of the polygon through these points.
  double length(const std::vector<exact::MeshPoint>& points) const {
    double sum = 0;
    for (std::size_t k = 1; k < points.size(); ++k) sum += distance(position(points[k - 1]), position(points[k]));
    return sum;
  }

  /// Expects that the polygon through the points of a path has its length, in units of the surface.
  void expect_length(const exact::GeodesicPath& path, double tolerance = 1e-12) const {
    EXPECT_NEAR(length(path.points), path.length, tolerance);
  }

  trimesh::TriangleMesh mesh;
  exact::PolyhedralSurface surface;
};

struct NamedMesh {
  const char* name;
  Mesh mesh;
};

/// Curved, flat, folded, with holes, with boundary, and one-sided meshes.
inline std::vector<NamedMesh> shapes() {
  return {{"sphere", icosphere(7)},
          {"torus", torus(300)},
          {"slivers", sliver_square(300)},
          {"holes", holed_square(14)},
          {"folds", folded_strip(11)},
          {"Moebius band", moebius_mesh(40, 6)},
          {"maze", maze(3)}};
}

/// Scales barycentric coordinates to sum 1.
inline void normalize(exact::MeshPoint& point) {
  const double sum = point.barycentric[0] + point.barycentric[1] + point.barycentric[2];
  for (double& weight : point.barycentric) weight /= sum;
}

/// Uniformly distributed barycentric coordinates in a random face.
inline exact::MeshPoint random_point(const exact::PolyhedralSurface& surface, std::mt19937_64& random) {
  std::exponential_distribution<double> share;
  exact::MeshPoint point{static_cast<Index>(random() % static_cast<unsigned>(surface.face_count())), {}};
  for (double& weight : point.barycentric) weight = share(random);
  normalize(point);
  return point;
}

inline std::vector<exact::MeshPoint> random_points(const exact::PolyhedralSurface& surface, int count,
                                                   std::mt19937_64& random) {
  std::vector<exact::MeshPoint> points;
  while (count-- > 0) points.push_back(random_point(surface, random));
  return points;
}

/// An icosahedron with 400 points inserted into random faces near their corners, at 1e-6 to 0.3 of the size of the face, and
/// slightly off the face. Empty if a face has no area.
inline std::optional<FlatTriangles> nested_needles(unsigned seed) {
  Mesh mesh = icosphere(1);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 400; ++k) {
    const std::size_t f = random() % mesh.faces.size();
    const auto [a, b, c] = mesh.faces[f];
    const double near = std::pow(10, -6 + (6 + std::log10(0.3)) * uniform(random)),
                 off = 0.3 * near * (uniform(random) - 0.5);
    Vec3 weights{near / 2, near / 2, near / 2};
    weights[random() % 3] = 1 - near;
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    const Vec3 normal = cross(q - p, r - p);
    const Index v = mesh.vertices();
    mesh.positions.push_back(weights[0] * p + weights[1] * q + weights[2] * r +
                             (off / std::sqrt(norm(normal))) * normal);
    mesh.faces[f] = {a, b, v};
    mesh.faces.push_back({b, c, v});
    mesh.faces.push_back({c, a, v});
  }
  try {
    return surface_of(mesh).flat_triangles();
  } catch (const InvalidGeometry&) {
    return {};
  }
}

/// A cone of this angle around its apex (vertex 0), cut into sectors of the plane and these into triangles. It is flat except
/// at the apex, so it unrolls. The outer boundary is a convex polygon.
struct PolarCone {
  PolarCone(double angle, Index sectors, Index rings) : angle(angle), polar{{0, 0}} {
    for (Index i = 1; i <= rings; ++i)
      for (Index j = 0; j < sectors; ++j) polar.push_back({static_cast<double>(i) / rings, angle * j / sectors});
    using Corner = std::array<Index, 2>;  // ring, side of the sector
    const auto add = [&](Index sector, const std::array<Corner, 3>& corners) {
      Triangle face;
      std::array<Vec2, 3> place;
      for (int s = 0; s < 3; ++s) {
        const auto [ring, side] = corners[s];
        const double r = static_cast<double>(ring) / rings, a = side * angle / sectors;
        face[s] = ring == 0 ? 0 : 1 + (ring - 1) * sectors + (sector + side) % sectors;
        place[s] = {r * std::cos(a), r * std::sin(a)};
      }
      faces.push_back(face);
      lengths.push_back({norm(place[1] - place[0]), norm(place[2] - place[1]), norm(place[0] - place[2])});
    };
    for (Index j = 0; j < sectors; ++j) {
      add(j, {{{0, 0}, {1, 0}, {1, 1}}});
      for (Index i = 1; i < rings; ++i) {
        add(j, {{{i, 0}, {i + 1, 0}, {i + 1, 1}}});
        add(j, {{{i, 0}, {i + 1, 1}, {i, 1}}});
      }
    }
  }
  trimesh::TriangleMesh mesh() const {
    return trimesh::TriangleMesh::from_edge_lengths(static_cast<Index>(polar.size()), faces, lengths);
  }
  /// Distance of two vertices on the unrolled cone.
  double distance(Index a, Index b) const {
    const double apart = std::abs(polar[a][1] - polar[b][1]), turn = std::min(apart, angle - apart);
    const double r = polar[a][0], s = polar[b][0];
    return turn >= std::numbers::pi ? r + s : std::sqrt(std::max(0.0, r * r + s * s - 2 * r * s * std::cos(turn)));
  }

  double angle;
  std::vector<Vec2> polar;  ///< radius and angle of each vertex
  std::vector<Triangle> faces;
  std::vector<std::array<double, 3>> lengths;
};

}  // namespace ahm::test
