/// \file
/// Data of the surface that relates results to the input mesh, and layouts of faces.
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
  std::vector<Index> face_rows;  ///< rows at the corners of the input faces
  unsigned threads;              ///< for `flat_triangles`; 0: one per core

  /// A point in a face that was kept, by weights of its stored corners.
  struct StoredPoint {
    Index face;
    std::array<double, 3> weight;
  };
  StoredPoint stored(const FacePoint& point) const;
  /// Finds a point of the input mesh in the intrinsic triangulation. The weights belong to the stored corners of the face found.
  FlipHistory::Point locate(const FacePoint& point) const;
  /// The side between two corners of an input face, in the layout of the face that was kept for it; zero if it was contracted.
  Vec2 input_side(Index face, int from, int to) const;
  /// A face that was kept and has an edge between two rows, and the input corners at its ends. None if there is no such edge,
  /// or it was contracted.
  struct Edge {
    Index face;
    int from, to;
  };
  std::optional<Edge> edge(Row from, Row to) const;
  /// The source at a point, with a unit vector in the layout of its input face as u axis.
  Source source(const FacePoint& point, Vec2 u) const;
  /// Position of a point, and axes of its face in space; none without positions or area.
  std::optional<Frame> frame(const FacePoint& point) const;
};

/// The three sides of a face as vectors of the plane, counter-clockwise, side 0 along the x axis. Each side is stored
/// separately, so that short sides and flat caps have vectors accurate relative to their own length. Lengths alone determine
/// the height y of a cap only to eps / y.
using FaceLayout = std::array<Vec2, 3>;

FaceLayout layout_of_positions(const Vec3& a, const Vec3& b, const Vec3& c);
/// @param l0, l1, l2  lengths of the sides; if they violate the triangle inequality, the face is flat
FaceLayout layout_of_lengths(double l0, double l1, double l2);

/// Height over the longest side, divided by that side: 0.87 for an equilateral triangle, 0 for a degenerate one.
double relative_height(const Vec2* sides);

/// A face with a height below this fraction of its longest side is degenerate.
constexpr double min_relative_height = 1e-10;

}  // namespace ahm::trimesh
