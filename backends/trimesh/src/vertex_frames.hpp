/// \file
/// Vectors of the plane as complex numbers.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/graph/tangent_graph.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/vec.hpp"
#include "intrinsic_triangulation.hpp"

namespace ahm::trimesh {

/// Angles of all directed edges in the frames of their start vertices.
///
/// Angle 0 is the reference direction of a vertex, fixed on the input mesh: the boundary edge on its right, or the edge
/// it stores a corner of. Angles about an interior vertex are scaled to the sum 2 pi; at the boundary they are kept,
/// since scaling them to pi would bend every flat corner.
///
/// A corner between short sides is known no better than the rounding of the positions over their length. Where such
/// uncertainty alone makes up for what the angles about a vertex lack or exceed 2 pi by, it is put right in those corners,
/// and the others, between long sides, keep their angles.
struct VertexFrames {
  std::vector<Corner> start;  ///< per vertex: the corner to start turning from; the rightmost on the boundary
  std::vector<double> scale;  ///< per vertex: 2 pi over the angle sum, 1 on the boundary
  std::vector<double> angle;  ///< per directed edge (HalfEdges::directed)
  std::vector<std::uint8_t>
      sense;  ///< per directed edge: whether the vertex is oriented like the lower of its faces; or empty
  std::vector<std::pair<Half, double>> mended;  ///< what angles of uncertain corners are multiplied by; ascending

  bool forward(const HalfEdges& edges, Half side, bool from_tail) const;
  /// What angles of the face at the start of a half-edge are multiplied by in the tangent space.
  double corner_scale(Half corner, Index vertex) const;
};

VertexFrames find_frames(const TriangleMesh& mesh, const IntrinsicTriangulation& triangulation, unsigned threads);

/// Frames in space: the normal is the mean of the face normals weighted by angle; x and y are turned in that plane so
/// that the projected edges lie as close as possible to their angles in the tangent space. Empty when the mesh has no
/// positions. Origins in world units.
std::vector<Frame> frames_in_space(const TriangleMesh& mesh, unsigned threads);

/// Every cut of a connected mesh is crossed by an edge of positive weight (the energy of its indicator function is
/// positive), so setting negative weights to 0 disconnects nothing.
CsrGraphData mesh_edges(const TriangleMesh& mesh, const IntrinsicTriangulation& triangulation,
                        const VertexFrames& frames, bool clamp, unsigned threads, MeshDetails& report);

}  // namespace ahm::trimesh
