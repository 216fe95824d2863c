/// \file
/// Generated triangle meshes whose log maps are known.
#pragma once

#include <array>
#include <vector>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {

struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
  /// Position in the plane, counter-clockwise like the faces, for flat meshes and meshes bent from the plane.
  std::vector<std::array<double, 2>> plane;

  Index vertices() const { return static_cast<Index>(positions.size()); }
  /// Position in the plane of a point of the surface.
  std::array<double, 2> plane_point(const FacePoint& point) const;
  /// Largest extent in the plane.
  double diameter() const;
};

/// A tilted unit square, its points inserted one by one into random faces, never improved: needles and caps of every
/// degree.
Mesh sliver_square(Index n, unsigned seed = 1);
/// A jittered grid with random diagonals on a tilted rectangle 1 x `aspect`, with two round holes.
Mesh holed_square(Index side, unsigned seed = 1, double aspect = 1.0);
/// A planar maze of corridors one cell wide, `cells` x `cells` of them, each of 2 x 2 quads.
Mesh maze(Index cells, unsigned seed = 1);
/// A flat strip folded to a fan along lines of edges.
Mesh folded_strip(Index side, unsigned seed = 1);
/// A jittered grid on a unit square rolled to a cylinder of radius `radius` about the x axis.
Mesh rolled_square(Index side, double radius, unsigned seed = 1);
/// A jittered patch of a cone of total angle `angle`, from 0.5 to 1.5 away from the apex.
Mesh cone_patch(Index side, double angle, unsigned seed = 1);
/// The unit sphere: an icosahedron, every edge cut into `parts`.
Mesh icosphere(Index parts);
/// A Moebius band of unit radius and half-width 0.4, jittered, with `around` x `across` quads.
Mesh moebius_mesh(Index around, Index across);

/// A jittered strip of paper 1 long and 0.2 wide, its ends glued with a twist: flat, one-sided, and known by its edge
/// lengths.
struct PaperBand {
  Index around = 0, across = 0;  ///< quads
  std::vector<Triangle> faces;
  std::vector<std::array<double, 3>> lengths;
  /// Positions of corner s of face f in the strip, without wrapping round: 3 per face.
  std::vector<std::array<double, 2>> corners;
  std::vector<std::array<double, 2>> plane;  ///< per vertex

  /// Distance in the strip, through the glued ends where that is shorter.
  double distance(const std::array<double, 2>& p, const std::array<double, 2>& q) const;
};
PaperBand paper_band(Index around, Index across, unsigned seed = 1);

/// Log map of the unit sphere from p with tangent axes x, y.
std::array<double, 2> sphere_log(const Vec3& p, const Vec3& x, const Vec3& y, const Vec3& q);
double dot(const Vec3& a, const Vec3& b);

/// Builds, factors and solves in one go.
struct SolvedMesh {
  explicit SolvedMesh(const Mesh& mesh, const trimesh::MeshOptions& options = {});
  RowLogMap map(const Source& source, Variant variant = Variant::adaptive) const;
  trimesh::TriangleMeshSurface surface;
  LogMapSolver solver;
};

/// Largest distance between the map and the plane seen from `origin` with unit axis `u`; all must be ok.
double plane_error(const Mesh& mesh, const RowLogMap& map, const std::array<double, 2>& origin,
                   const std::array<double, 2>& u);

}  // namespace ahm::test
