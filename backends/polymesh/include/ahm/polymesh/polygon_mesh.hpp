/// \file
/// A checked polygon mesh: faces of any number of corners, planar or not.
///
/// \code
/// std::vector<ahm::Offset> begin{0, 4, 9};                        // a quad and a pentagon that share a side
/// std::vector<ahm::Index> corners{0, 1, 2, 3, 2, 1, 4, 5, 6};
/// auto mesh = ahm::polymesh::PolygonMesh::from_faces(positions, begin, corners);
/// ahm::polymesh::Refinement triangles = mesh.refined();           // for backends that need triangles
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ahm/surface/detail/gluing.hpp"
#include "ahm/types.hpp"

namespace ahm::polymesh {

/// A polygon mesh cut into triangles. Every face of more than three corners gets a virtual vertex: the point that minimizes the
/// sum of the squared areas of the triangles around it ([BHKB20] Sec. 4). If one of its sides is not visible from that point,
/// as in a U, the face is cut along diagonals instead.
struct Refinement {
  std::vector<Vec3> positions;                  ///< positions of the mesh's vertices, then of the virtual vertices
  std::vector<std::array<Index, 3>> triangles;  ///< (corner, next corner, virtual vertex), or three corners
  std::vector<Offset> face_begin;               ///< start of each face's triangles; faces + 1
  /// Twisted faces of more than four corners: a side is not visible from the virtual vertex, and the outline projected along
  /// the vector area crosses itself. Their triangles overlap, so the refinement differs from the input surface.
  std::vector<Index> folded;
};

/// An immutable polygon mesh, consistently oriented where that is possible.
///
/// Faces keep their numbers. A face that was reversed has its corners in the opposite order, with the same first corner.
/// Vertices are renumbered in the order of the input, without unreferenced ones; copies made by splitting come last.
class PolygonMesh {
 public:
  /// @param face_begin     faces + 1 offsets into `face_vertices`, ascending from 0
  /// @param face_vertices  vertex numbers, face after face
  /// @param counts_as_reversed  per face, 1 if the majority orientation of its component is computed as if the face were
  ///                       (`face_parts`); empty: no face
  /// @throws InvalidGeometry (no faces, index out of range, fewer than three corners, vertex repeated in a face,
  ///         duplicate face, vertex of a face not finite, non-manifold edge or vertex); messages list the first ten and the count
  static PolygonMesh from_faces(std::span<const Vec3> positions, std::span<const Offset> face_begin,
                                std::span<const Index> face_vertices, NonManifold non_manifold = NonManifold::error,
                                std::span<const std::uint8_t> counts_as_reversed = {});

  Index vertex_count() const noexcept { return topology_.vertex_count(); }
  Index face_count() const noexcept { return topology_.face_count(); }
  const TopologyReport& report() const noexcept { return topology_.report(); }
  const detail::GluedMesh& topology() const noexcept { return topology_; }

  std::span<const Offset> face_begin() const noexcept { return topology_.face_begin(); }
  /// Vertices at all corners of the oriented faces.
  std::span<const Index> corners() const noexcept { return topology_.half_edges().tail; }
  std::span<const Index> face(Index f) const { return FaceList{face_begin(), corners()}[f]; }
  /// Numbers of the corners at a vertex. The face of the first one is oriented like the vertex.
  std::span<const Offset> corners_at(Vertex vertex) const {
    const Index v = vertex.index;
    return std::span(at_).subspan(at_begin_[v], at_begin_[v + 1] - at_begin_[v]);
  }
  /// Face of a corner.
  Index face_of(Offset corner) const { return topology_.face_of(corner); }
  /// Whether the face of a corner is oriented against the vertex there; always false on an orientable mesh.
  bool mirrored(Offset corner) const { return !mirrored_.empty() && mirrored_[corner] != 0; }
  /// Whether a face was reversed.
  bool reversed(Index f) const { return topology_.reversed()[f] != 0; }

  /// First vertex of each input vertex; -1: no face uses it.
  std::span<const Index> vertex_of_input() const noexcept { return topology_.vertex_of_input(); }
  /// Input vertex of each vertex.
  std::span<const Index> input_of_vertex() const noexcept { return topology_.input_of_vertex(); }

  /// Position of a vertex relative to the center of its component's bounding box, in units of `length_unit()`.
  const Vec3& position(Vertex vertex) const { return position_[vertex.index]; }
  /// Input position of a vertex.
  const Vec3& original_position(Vertex vertex) const { return input_[input_of_vertex()[vertex.index]]; }
  /// Positions of all input vertices.
  std::span<const Vec3> input_positions() const noexcept { return input_; }
  /// A power of two near the size of the mesh.
  double length_unit() const noexcept { return length_unit_; }

  /// Faces without area: all their corners lie on one line.
  std::vector<Index> collinear_faces() const;
  /// The mesh as triangles. The first `vertex_count()` vertices are those of this mesh.
  Refinement refined() const;

 private:
  explicit PolygonMesh(detail::GluedMesh topology) : topology_(std::move(topology)) {}
  void collect_corners();
  void orient_vertices();

  detail::GluedMesh topology_;
  std::vector<Offset> at_begin_, at_;
  std::vector<std::uint8_t> mirrored_;
  std::vector<Vec3> position_;
  std::vector<Vec3> input_;
  double length_unit_ = 1.0;
};

}  // namespace ahm::polymesh
