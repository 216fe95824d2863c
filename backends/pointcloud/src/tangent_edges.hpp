/// \file
/// Edge logarithms and transports between the tangent planes of a cloud.
#pragma once

#include <optional>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "tangent_planes.hpp"
#include "tufted_cover.hpp"

namespace ahm::pointcloud {

/// Fills the graph from oriented normals and weighted edges: vertices are the points that a triangle touches.
/// Where `trusted` is 0, an edge between opposed normals is a reflection; else it is a rotation by more than 90
/// degrees.
/// @param noise  of offsets across the surface, units of the clean points
/// @param kind  how transports are stored; none: as blocks where there is a reflection
/// @param vertex_of_clean  number of each clean point among the vertices, -1: none
CsrGraphData tangent_edges(const CleanPoints& cloud, const TangentPlanes& planes, const WeightedEdges& edges,
                           const std::vector<Index>& vertex_of_clean, Index vertices, const PerPart& trusted,
                           const PerPart& noise, unsigned threads, CloudDetails& report,
                           std::optional<TransportKind> kind = {});

}  // namespace ahm::pointcloud
