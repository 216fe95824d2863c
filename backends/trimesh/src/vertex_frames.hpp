/// \file
/// Tangent spaces of the vertices of a triangle mesh, and the edges of its graph.
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
/// Angle 0 is the reference direction of a vertex, which is fixed on the input mesh: the boundary edge on its right, or the
/// edge of its stored corner. Angles around an interior vertex are scaled to the sum 2 pi. On the boundary they are not scaled,
/// because scaling them to pi would bend every flat corner.
///
/// The angle of a corner between short sides is uncertain by the rounding of positions over the length of the sides. If this
/// uncertainty explains by how much the angles around a vertex differ from 2 pi, only the uncertain corners are corrected. The
/// others, between long sides, keep their angles.
struct VertexFrames {
  std::vector<Corner> start;  ///< per vertex: first corner counter-clockwise; the rightmost one on the boundary
  std::vector<double> scale;  ///< per vertex: 2 pi over the angle sum, 1 on the boundary
  std::vector<double> angle;  ///< per directed edge (HalfEdges::directed)
  std::vector<std::uint8_t>
      sense;  ///< per directed edge: whether the vertex is oriented like the lower of its faces; or empty
  std::vector<std::pair<Half, double>> corrections;  ///< uncertain corners, ascending, and factors of their angles

  /// Whether the vertex at one end of a side is oriented like the face of the side.
  bool forward(const HalfEdges& edges, Half side, bool from_tail) const;
  /// Factor of the angle at the start of a half-edge in the tangent space of its vertex.
  double corner_scale(Half corner, Index vertex) const;
};

VertexFrames find_frames(const TriangleMesh& mesh, const IntrinsicTriangulation& triangulation, unsigned threads);

/// Frames in space. The normal is the mean of the face normals, weighted by angle. The axes x and y are rotated in that plane
/// so that the projected edges lie as close as possible to their angles in the tangent space. Empty without positions. Origins
/// are in world units.
std::vector<Frame> frames_in_space(const TriangleMesh& mesh, unsigned threads);

/// Builds the graph. Setting negative weights to 0 disconnects nothing: an edge of positive weight crosses every cut of a
/// connected mesh, because the energy of the cut's indicator function is positive.
CsrGraphData mesh_edges(const TriangleMesh& mesh, const IntrinsicTriangulation& triangulation,
                        const VertexFrames& frames, bool clamp, unsigned threads, MeshDetails& report);

}  // namespace ahm::trimesh
