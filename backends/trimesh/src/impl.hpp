/// \file
/// What a mesh's graph keeps to relate results to the input mesh.
#pragma once

#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "intrinsic_triangulation.hpp"
#include "vertex_frames.hpp"

namespace ahm::trimesh {

struct TriangleMeshSurface::Impl {
  TriangleMesh mesh;
  IntrinsicTriangulation triangulation;
  VertexFrames frames;
  CsrGraph graph;
  MeshDetails details;
  RowMap rows;
  std::vector<Offset> face_begin;  ///< of the faces as given
  std::vector<Index> face_rows;

  /// A point of the input mesh in the intrinsic triangulation. Weights are those of the corners of `face` as stored.
  FlipHistory::Point locate(const FacePoint& point) const;
  /// The side from corner `from` to corner `to` of an input face, corners as given, in the layout of the face.
  Vec2 input_side(Index face, int from, int to) const;
  /// The source at a point whose u axis is the given unit vector in the layout of its input face.
  Source source(const FacePoint& point, Vec2 u) const;
  /// Position and axes of a face in space; none without positions or area.
  std::optional<Frame> frame(const FacePoint& point) const;
};

}  // namespace ahm::trimesh
