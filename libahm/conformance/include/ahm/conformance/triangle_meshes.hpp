/// \file
/// Generated triangle meshes whose log maps are known.
#pragma once

#include <span>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::test {

struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
  /// Position in the plane, counter-clockwise like the faces, for flat meshes and meshes bent from the plane.
  std::vector<Vec2> plane;

  Index vertices() const { return static_cast<Index>(positions.size()); }
  /// Position in the plane of a point of a face.
  Vec2 plane_point(Index face, const Vec3& barycentric) const;
  /// Largest extent in the plane.
  double diameter() const;
};

/// One mesh, and beside it another one moved by `shift`, numbered on.
Mesh joined(Mesh mesh, const Mesh& other, const Vec3& shift = {0, 0, 0});

/// A tilted unit square, its points inserted one by one into random faces, never improved: needles and caps of every
/// degree.
Mesh sliver_square(Index n, unsigned seed = 1);
/// A lattice of n x n vertices whose lowest row dents between every second one, and slivers that fill the dents.
Mesh dented_square(Index n);
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
/// A Moebius band of unit radius and half-width 0.4, jittered, with `around` x `across` quads.
Mesh moebius_mesh(Index around, Index across);
/// A torus of radii 1 and 0.4, about n vertices, jittered along the surface, its quads cut at random: faces 2 f and
/// 2 f + 1 are the halves of quad f.
Mesh torus(Index n);

/// A unit square of side x side points with random diagonals; points move by up to `jitter` spacings inside, but those
/// of the middle row only along it. `side` is odd.
Mesh flat_square(Index side, double jitter = 0.24, unsigned seed = 1);
/// A hexagon of equilateral triangles with `rings` rings of unit edges about its middle vertex, number 0.
Mesh hexagon(Index rings);

/// The unit sphere: an icosahedron, every edge cut into `parts`, at equal lengths in the flat face.
Mesh icosphere(Index parts);
/// The unit sphere: an icosahedron whose faces were split in four, each time on the sphere, until there are at least n
/// vertices: 10 4^s + 2. Triangles differ less in size than those of `icosphere`.
Mesh split_icosphere(Index n);

/// Vertex of a flat mesh nearest to a point of the plane.
Index nearest(const Mesh& mesh, const Vec2& point);

/// Largest distance between a map (u, v) and the plane seen from `origin` with unit axis `axis`; infinite unless every
/// coordinate is finite.
double plane_error(const std::vector<Vec2>& plane, std::span<const double> u, std::span<const double> v,
                   const Vec2& origin, const Vec2& axis);

}  // namespace ahm::test
