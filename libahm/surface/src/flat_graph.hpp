/// \file
/// The edges of flat triangles as a graph: what a front runs on where the triangles are not those of the surface's own graph.
#pragma once

#include "ahm/graph/csr_graph.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"

namespace ahm::detail {

/// Vertices and the axes of their tangent planes are those of the surface's graph. All weights and masses are 1: it is no graph to
/// solve on. Vertices without triangles have no edges.
CsrGraph flat_graph(const FlatTriangles& flat);

}  // namespace ahm::detail
