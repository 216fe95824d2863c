/// \file
/// Coordinates of a map at the corners of faces. Not part of the public interface.
#pragma once

#include <span>
#include <vector>

#include "ahm/maps/log_map.hpp"
#include "ahm/surface/detail/half_edges.hpp"
#include "ahm/types.hpp"

namespace ahm::detail {

/// Faces laid out in planes of their own; one entry per corner, in the stored order.
struct FlatCorners {
  std::span<const Index> vertices;  ///< vertices of the graph
  std::span<const Vec2> places;     ///< in one plane per face, counterclockwise, in units of `unit`; NaN: no face
  double unit = 1;                  ///< world units, a power of two
  bool orientable = true;
};

/// (u, v) at every stored corner, world units. NaN in faces without places and in faces with a corner where the map is not ok.
///
/// A sheet of a map may stretch its faces, but the stretch changes little from face to face. This distinguishes a tear from the
/// stretch in distant parts of a smooth map. The strain of a face is the largest log(mapped length / length) over its sides and
/// its diagonals (c, c + 2). Lengths below half of the longest one are replaced by that half, so that thin faces require no
/// relative accuracy. The strain of the sheet propagates outward from the source over the faces (breadth first). It follows the
/// strain of the faces by at most 0.05 per face.
///
/// A face is torn if its strain exceeds the sheet's by log 2. It is also torn if the map reverses it to a depth of a tenth of
/// its longest side. Heat maps blend the two sheets over a few edges. So a face at most three faces away from a torn one is torn
/// if its strain, or the negative of it, exceeds the sheet's by log 1.4. Shrunk faces elsewhere belong to the sheet: behind
/// saddles all shortest paths coincide at first.
///
/// A torn face is laid out rigidly next to the nearest face that is not torn, counted in faces. A corner takes its position in
/// another neighboring face where the two positions differ by at most 0.2 of the shortest side.
std::vector<Vec2> unfolded_corners(const HalfEdges& edges, const FlatCorners& faces, const LogMap& map);

}  // namespace ahm::detail
