/// \file
/// The faces of a surface as flat triangles: what exact geodesics run on.
#pragma once

#include <vector>

#include "ahm/surface/exact/polyhedral_surface.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// Flat triangles whose vertices are those of a surface's graph, with the same numbers. The x axis of a vertex's frame is
/// direction 0 of `exact::ExactMap::direction` there.
struct FlatTriangles {
  exact::PolyhedralSurface surface;  ///< in units of `length_unit`
  std::vector<Vec3> positions;       ///< of the vertices, world units; empty where there are none
  double length_unit = 1;            ///< a power of two
};

}  // namespace ahm
