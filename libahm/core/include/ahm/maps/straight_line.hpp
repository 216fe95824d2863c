/// \file
/// Where a source lies in space: no way on a surface is shorter than the straight line from there.
#pragma once

#include <optional>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// The place of a source that is one point, world units; none for curves and several points, and where the graph knows no
/// frames.
std::optional<Vec3> source_position(const TangentGraph& graph, const Source& source);

/// The place from which distances of heat may fall below the straight line; none where there is no telling, as above. (Where a source
/// lies between the vertices of a mesh is known to the second order in space, its distances near by better.)
std::optional<Vec3> straight_line_origin(const TangentGraph& graph, const Source& source);

/// A distance along a surface, no less than the straight line but for rounding. NaN stays.
inline double bounded_distance(double line, double distance) { return line > distance * (1 + 1e-12) ? line : distance; }

}  // namespace ahm
