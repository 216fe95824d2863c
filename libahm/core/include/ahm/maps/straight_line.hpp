/// \file
/// The position of a source in space. No path on the surface is shorter than the straight line from there.
#pragma once

#include <optional>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// Position of a source that is a single point, world units. nullopt for curves, for several points, and if the graph has no frames.
std::optional<Vec3> source_position(const TangentGraph& graph, const Source& source);

/// Position from which the straight-line bound of distances is measured, world units; nullopt if the bound does not apply. It applies to
/// single points: on triangulations to vertices only, on other graphs to all. (Between the vertices of a mesh the position of the source
/// is accurate to second order; the distances nearby are more accurate.)
std::optional<Vec3> straight_line_origin(const TangentGraph& graph, const Source& source);

/// The larger of a distance along a surface and the straight line. A relative difference of up to 1e-12 is rounding and ignored. NaN
/// distances stay NaN.
inline double bounded_distance(double line, double distance) { return line > distance * (1 + 1e-12) ? line : distance; }

}  // namespace ahm
