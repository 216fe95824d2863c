/// \file
/// The rows of a mesh's graph: cotangent weights, masses, logarithms, transports.
#pragma once

#include "ahm/graph/csr_graph.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "intrinsic_triangulation.hpp"
#include "vertex_frames.hpp"

namespace ahm::trimesh {

/// Every cut of a connected mesh is crossed by an edge of positive weight (the energy of its indicator function is
/// positive), so setting negative weights to 0 disconnects nothing.
CsrGraphData mesh_edges(const TriangleMesh& mesh, const IntrinsicTriangulation& triangulation,
                        const VertexFrames& frames, bool clamp, unsigned threads, MeshDetails& report);

}  // namespace ahm::trimesh
