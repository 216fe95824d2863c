/// \file
/// The faces of a surface as flat triangles: the domain of exact geodesics.
#pragma once

#include <cstdint>
#include <vector>

#include "ahm/surface/exact/polyhedral_surface.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// Flat triangles whose vertices have the numbers of a surface's graph. The x axis of a vertex's frame is direction 0 of
/// `exact::ExactMap::direction` there, unless `angles` is set.
struct FlatTriangles {
  exact::PolyhedralSurface surface;  ///< in units of `length_unit`
  std::vector<Vec3> positions;       ///< positions of the vertices, world units; empty where there are none
  double length_unit = 1;            ///< world units, a power of two
  bool approximate = false;          ///< whether the triangles are only near the surface, as for clouds
  std::vector<double> angles = {};   ///< angle of direction 0 in the frame of each vertex, radians; empty: 0
  std::vector<std::uint8_t> mirrored =
      {};  ///< 1 where directions turn clockwise in the frame of a vertex; empty: nowhere
};

}  // namespace ahm
