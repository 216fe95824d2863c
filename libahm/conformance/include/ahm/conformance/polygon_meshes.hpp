/// \file
/// Generated polygon meshes with known log maps.
#pragma once

#include <vector>

#include "ahm/types.hpp"

namespace ahm::test {

struct Polygons {
  std::vector<Vec3> positions;
  std::vector<Offset> begin{0};
  std::vector<Index> corners;
  /// Position of each vertex in the plane, for flat meshes; faces are counter-clockwise in it.
  std::vector<Vec2> plane;

  Index vertices() const { return static_cast<Index>(positions.size()); }
  Index faces() const { return static_cast<Index>(begin.size()) - 1; }
  void add(const std::vector<Index>& face);
  std::vector<Index> face(Index f) const { return {corners.begin() + begin[f], corners.begin() + begin[f + 1]}; }
  /// Reverses the order of a face's corners.
  void reverse(Index f);
  double diameter() const;
};

/// Moves a flat mesh to a tilted plane and stores its positions in the plane.
void tilt(Polygons& mesh);

/// Voronoi cells of random points, clipped to the unit square.
Polygons voronoi_square(Index cells, unsigned seed = 1);
/// Each 2 x 2 block of a grid is cut into an L of eight corners (one of them concave) and a square. `stretch` lengthens and
/// slants the cells.
Polygons l_shapes(Index blocks, double stretch = 1.0);
/// Each 3 x 2 block of a grid is cut into a U of twelve corners and the square in its opening. A U is not star-shaped.
Polygons u_shapes(Index blocks);
/// A wall of bricks with half bricks at the ends. A brick has six corners, two of them in the middle of sides.
Polygons brick_wall(Index rows);
/// A jittered grid of quads. If `triangles`, each quad is cut along a random diagonal.
Polygons quad_grid(Index side, bool triangles = false, unsigned seed = 1);

/// The unit sphere as the six sides of a cube, with `side` x `side` quads each.
Polygons cube_sphere(Index side);
/// The unit sphere as hexagons and twelve pentagons: the dual of an icosahedron with edges cut into `parts`.
Polygons dual_sphere(Index parts);
/// The unit sphere as Voronoi cells of random points.
Polygons voronoi_sphere(Index cells, unsigned seed = 1);
/// A Moebius band of quads.
Polygons moebius_quads(Index around, Index across);

}  // namespace ahm::test
