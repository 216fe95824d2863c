/// \file
/// What a mesh's graph keeps to relate results to the input mesh.
#pragma once

#include <array>

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
  std::vector<Index> face_rows;  ///< at the corners of the faces as given

  /// A point in a face that was kept, by the weights of its corners as stored.
  struct StoredPoint {
    Index face;
    std::array<double, 3> weight;
  };
  StoredPoint stored(const FacePoint& point) const;
  /// A point of the input mesh in the intrinsic triangulation. Weights are those of the corners of `face` as stored.
  FlipHistory::Point locate(const FacePoint& point) const;
  /// The side from corner `from` to corner `to` of an input face, corners as given, in the layout of the face that was kept;
  /// zero where it was contracted.
  Vec2 input_side(Index face, int from, int to) const;
  /// A face that was kept with an edge between two rows, and its corners there, as given; none where there is no such edge,
  /// or it was contracted.
  struct Edge {
    Index face;
    int from, to;
  };
  std::optional<Edge> edge(Row from, Row to) const;
  /// The source at a point whose u axis is the given unit vector in the layout of its input face.
  Source source(const FacePoint& point, Vec2 u) const;
  /// Position and axes of a face in space; none without positions or area.
  std::optional<Frame> frame(const FacePoint& point) const;
};

/// The three sides of a face as vectors of the plane, counter-clockwise, side 0 along the x axis. Each side is kept by
/// itself, so that short sides and flat caps have vectors accurate to their own length: lengths alone determine the
/// height y of a cap only to eps / y.
using FaceLayout = std::array<Vec2, 3>;

FaceLayout layout_of_positions(const Vec3& a, const Vec3& b, const Vec3& c);
/// @param l0, l1, l2  lengths of the sides; beyond the triangle inequality the face is flat
FaceLayout layout_of_lengths(double l0, double l1, double l2);

/// Height over the longest side, divided by that side: 0.87 for an equilateral triangle, 0 for a degenerate one.
double relative_height(const Vec2* sides);

/// A height below this multiple of the longest side is almost none.
constexpr double least_relative_height = 1e-10;

}  // namespace ahm::trimesh
