/// \file
/// The faces of a surface as flat triangles: what exact geodesics run on.
#pragma once

#include <cstdint>
#include <vector>

#include "ahm/surface/exact/polyhedral_surface.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// Flat triangles whose vertices are those of a surface's graph, with the same numbers. The x axis of a vertex's frame is
/// direction 0 of `exact::ExactMap::direction` there, unless `angles` are given.
struct FlatTriangles {
  exact::PolyhedralSurface surface;  ///< in units of `length_unit`
  std::vector<Vec3> positions;       ///< of the vertices, world units; empty where there are none
  double length_unit = 1;            ///< a power of two
  bool approximate = false;          ///< the surface is no more than near the triangles, as of clouds
  std::vector<double> angles = {};   ///< of direction 0 in the frame of each vertex, radians; empty: 0
  std::vector<std::uint8_t> mirrored =
      {};  ///< 1 where directions turn clockwise in the frame of a vertex; empty: nowhere
};

}  // namespace ahm
