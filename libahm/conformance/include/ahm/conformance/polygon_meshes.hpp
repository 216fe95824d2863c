/// \file
/// Generated polygon meshes whose log maps are known.
#pragma once

#include <vector>

#include "ahm/types.hpp"

namespace ahm::test {

struct Polygons {
  std::vector<Vec3> positions;
  std::vector<Offset> begin{0};
  std::vector<Index> corners;
  /// Positions in the plane, counter-clockwise like the faces, for flat meshes.
  std::vector<Vec2> plane;

  Index vertices() const { return static_cast<Index>(positions.size()); }
  Index faces() const { return static_cast<Index>(begin.size()) - 1; }
  void add(const std::vector<Index>& face);
  std::vector<Index> face(Index f) const { return {corners.begin() + begin[f], corners.begin() + begin[f + 1]}; }
  /// The same with the corners of a face in the opposite order.
  void reverse(Index f);
  double diameter() const;
};

/// Puts flat positions on a tilted plane.
void tilt(Polygons& mesh);

/// Voronoi cells of random points, cut off at the unit square.
Polygons voronoi_square(Index cells, unsigned seed = 1);
/// Every 2 x 2 block of a grid cut into an L of eight corners (one of them concave) and a square; `stretch` makes the
/// cells longer and slants them.
Polygons l_shapes(Index blocks, double stretch = 1.0);
/// Every 3 x 2 block of a grid cut into a U of twelve corners and the square in its opening: no point sees all of a U.
Polygons u_shapes(Index blocks);
/// A wall of bricks, each of six corners, two of them in the middle of sides; half bricks at the ends.
Polygons brick_wall(Index rows);
/// A jittered grid of quads, each cut into two triangles along a random diagonal or (`triangles` false) left whole.
Polygons quad_grid(Index side, bool triangles = false, unsigned seed = 1);

/// The unit sphere: the sides of a cube, `side` x `side` quads each.
Polygons cube_sphere(Index side);
/// The unit sphere: hexagons and twelve pentagons, one for each vertex of an icosahedron with edges cut into `parts`.
Polygons dual_sphere(Index parts);
/// The unit sphere: Voronoi cells of random points.
Polygons voronoi_sphere(Index cells, unsigned seed = 1);
/// A Moebius band of quads.
Polygons moebius_quads(Index around, Index across);

}  // namespace ahm::test
