/// \file
/// A map at the corners of faces, cut open where it tears. Not part of the public interface: what `on_corners` of triangle and
/// polygon meshes have in common.
///
/// \code
/// std::vector<ahm::Vec2> phi = detail::unfolded_corners(mesh.half_edges(), {vertices, places, unit, orientable}, map);
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/maps/log_map.hpp"
#include "ahm/surface/half_edges.hpp"
#include "ahm/types.hpp"

namespace ahm::detail {

/// Faces as they lie in planes of their own, per corner as stored.
struct FlatCorners {
  std::span<const Index> vertices;  ///< of the graph
  std::span<const Vec2> places;     ///< in a plane per face, counter-clockwise, in units of `unit`; NaN: no face
  double unit = 1;                  ///< world units, a power of two
  bool orientable = true;
};

/// (u, v) at every corner as stored, world units; NaN in faces with a corner where the map is not ok, or without places.
///
/// One sheet of a map may stretch its faces, but from face to face this changes little: so a tear is told from the stretch of the
/// distant part of a smooth map. Of a face, compared are its sides and diagonals (c, c + 2): its strain is the largest
/// log(mapped length / length), those shorter than half of the longest counting as that half, so that no map needs relative
/// accuracy on thin faces. Going outward from the source over the faces (breadth first) the sheet's strain follows that of its
/// faces by 0.05 a face at the most.
///
/// A face is torn whose strain exceeds the sheet's by log 2, or which is turned over, to a depth of a tenth of its longest side. In
/// maps by heat, which blend the two sheets over a few edges, torn are also faces up to three away from such a one whose strain,
/// or its opposite, exceeds the sheet's by log 1.4. Shrunk faces elsewhere are on the sheet: behind saddles all shortest paths are
/// the same at first. Torn faces are laid out beside the nearest face, counted in faces, that is not: rigidly, but for corners that
/// other neighbours have no farther away than 0.2 of the shortest side.
std::vector<Vec2> unfolded_corners(const HalfEdges& edges, const FlatCorners& faces, const LogMap& map);

}  // namespace ahm::detail
