/// \file
/// Generated triangle meshes with known log maps.
#pragma once

#include <span>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::test {

struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
  /// Position of each vertex in the plane, for flat meshes and meshes bent from the plane; faces are counter-clockwise in
  /// it.
  std::vector<Vec2> plane;

  Index vertices() const { return static_cast<Index>(positions.size()); }
  /// Position in the plane of a point of a face.
  Vec2 plane_point(Index face, const Vec3& barycentric) const;
  /// Diagonal of the bounding box in the plane.
  double diameter() const;
};

/// Two meshes as one mesh. Positions of `other` are moved by `shift`, and its vertices follow those of `mesh`.
Mesh joined(Mesh mesh, const Mesh& other, const Vec3& shift = {0, 0, 0});

/// A tilted unit square whose points are inserted one by one into random faces, without improvement: needles and caps of
/// all shapes.
Mesh sliver_square(Index n, unsigned seed = 1);
/// A square lattice of n x n vertices. Every second vertex of the lowest row is moved inwards, and slivers fill these
/// dents.
Mesh dented_square(Index n);
/// A jittered grid with random diagonals on a tilted rectangle 1 x `aspect`, with two round holes.
Mesh holed_square(Index side, unsigned seed = 1, double aspect = 1.0);
/// A planar maze of `cells` x `cells` cells. Corridors are one cell wide, and a cell consists of 2 x 2 quads.
Mesh maze(Index cells, unsigned seed = 1);
/// A flat strip folded like a fan along lines of edges.
Mesh folded_strip(Index side, unsigned seed = 1);
/// A jittered grid on a unit square rolled to a cylinder of radius `radius` about the x axis.
Mesh rolled_square(Index side, double radius, unsigned seed = 1);
/// A jittered patch of a cone of total angle `angle`, at 0.5 to 1.5 from the apex.
Mesh cone_patch(Index side, double angle, unsigned seed = 1);
/// A Moebius band of unit radius and half-width 0.4, jittered, with `around` x `across` quads.
Mesh moebius_mesh(Index around, Index across);
/// A torus of radii 1 and 0.4 with about n vertices, jittered along the surface. Quads are cut at random: faces 2 f and 2 f
/// + 1 are the halves of quad f.
Mesh torus(Index n);

/// A unit square of side x side points with random diagonals. Inner points move by up to `jitter` spacings, those of the
/// middle row only along the row. `side` is odd.
Mesh flat_square(Index side, double jitter = 0.24, unsigned seed = 1);
/// A hexagon of equilateral triangles: `rings` rings of edges of length 1 around the central vertex, which is vertex 0.
Mesh hexagon(Index rings);

/// The unit sphere: an icosahedron with every edge cut into `parts` of equal length in the flat face.
Mesh icosphere(Index parts);
/// The unit sphere: an icosahedron whose faces are split in four, with midpoints moved to the sphere, until there are at
/// least n vertices (10 4^s + 2). Triangle sizes vary less than in `icosphere`.
Mesh split_icosphere(Index n);

/// The vertex of a flat mesh that is nearest to a point of the plane.
Index nearest(const Mesh& mesh, const Vec2& point);

/// Largest distance between a map (u, v) and plane coordinates relative to `origin` with the unit axis `axis`. Infinite
/// unless every coordinate is finite.
double plane_error(const std::vector<Vec2>& plane, std::span<const double> u, std::span<const double> v,
                   const Vec2& origin, const Vec2& axis);

}  // namespace ahm::test
