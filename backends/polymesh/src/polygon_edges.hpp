/// \file
/// The edges of the graph of a polygon mesh.
#pragma once

#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "polygon_frames.hpp"

namespace ahm::polymesh {

/// Weights, logs, transports and masses of all pairs of corners of all faces.
CsrGraphData polygon_edges(const PolygonMesh& mesh, const Frames& frames, const PolygonOptions& options,
                           PolygonDetails& report);

}  // namespace ahm::polymesh
