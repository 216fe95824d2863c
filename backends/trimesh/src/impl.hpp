/// \file
/// What a mesh's graph keeps to relate results to the input mesh.
#pragma once

#include "ahm/trimesh/triangle_mesh_graph.hpp"
#include "intrinsic_triangulation.hpp"
#include "vertex_frames.hpp"

namespace ahm::trimesh {

struct TriangleMeshGraph::Impl {
  TriangleMesh mesh;
  IntrinsicTriangulation triangulation;
  VertexFrames frames;
  CsrGraph graph;
  MeshReport report;

  /// A point of the input mesh in the intrinsic triangulation. Weights are those of the corners of `face` as stored.
  /// @throws InvalidArgument
  FlipHistory::Point locate(const SurfacePoint& point) const;
  /// The side from corner `from` to corner `to` of an input face, corners as given, in the layout of the face.
  Vec2 input_side(Index face, int from, int to) const;
  /// The source at a point whose u axis is the given unit vector in the layout of its input face.
  Source source(const SurfacePoint& point, Vec2 u) const;
};

}  // namespace ahm::trimesh
