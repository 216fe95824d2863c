/// \file
/// A checked polygon mesh: faces of any number of corners, planar or not.
///
/// \code
/// std::vector<ahm::Offset> begin{0, 4, 9};                        // a quad and a pentagon that share a side
/// std::vector<ahm::Index> corners{0, 1, 2, 3, 2, 1, 4, 5, 6};
/// auto mesh = ahm::polymesh::PolygonMesh::from_faces(positions, begin, corners);
/// ahm::polymesh::Refinement triangles = mesh.refined();           // for backends that take triangles
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ahm/surface/gluing.hpp"
#include "ahm/types.hpp"

namespace ahm::polymesh {

/// A polygon mesh cut into triangles: every face of more than three corners gets a virtual vertex, the point that
/// minimizes the sum of the squared areas of the triangles around it ([BHKB20] Sec. 4). A face that hides one of its sides
/// from there, such as a U, is cut along diagonals instead.
struct Refinement {
  std::vector<Vec3> positions;                  ///< of the mesh's vertices, then of the virtual ones
  std::vector<std::array<Index, 3>> triangles;  ///< (corner, next corner, virtual vertex), or three corners
  std::vector<Offset> face_begin;               ///< faces + 1: the triangles of each face
  /// Faces of more than four corners that neither show all their sides to their virtual vertex nor have an outline free
  /// of crossings seen along their vector area (twisted ones): their triangles overlap, and the refinement is not the surface that was given.
  std::vector<Index> folded;
};

/// An immutable polygon mesh, consistently oriented where that is possible.
///
/// Faces keep their number; one that was turned over has its corners in the opposite order, the first staying first.
/// Vertices are numbered anew without the unreferenced ones, in the order of the input; copies made by splitting come
/// last.
class PolygonMesh {
 public:
  /// @param face_begin     faces + 1 offsets into `face_vertices`, rising from 0
  /// @param face_vertices  vertex numbers, face after face
  /// @param turned         per face, 1 where it counts as turned over already when neighbours are oriented like the majority
  ///                       of their component (`face_parts`); empty: none does
  /// @throws InvalidGeometry (no faces, index out of range, fewer than three corners, vertex repeated in a face,
  ///         duplicate face, coordinate not finite, non-manifold edge or vertex), naming the first ten and the count
  static PolygonMesh from_faces(std::span<const Vec3> positions, std::span<const Offset> face_begin,
                                std::span<const Index> face_vertices, NonManifold non_manifold = NonManifold::error,
                                std::span<const std::uint8_t> turned = {});

  Index vertex_count() const noexcept { return topology_.vertex_count(); }
  Index face_count() const noexcept { return topology_.face_count(); }
  const TopologyReport& report() const noexcept { return topology_.report(); }
  const detail::GluedMesh& topology() const noexcept { return topology_; }

  std::span<const Offset> face_begin() const noexcept { return topology_.face_begin(); }
  /// Vertices of all corners, oriented.
  std::span<const Index> corners() const noexcept { return topology_.half_edges().tail; }
  std::span<const Index> face(Index f) const { return FaceList{face_begin(), corners()}[f]; }
  /// Faces at a vertex: numbers of its corners, the first oriented like the vertex.
  std::span<const Offset> corners_at(Vertex vertex) const {
    const Index v = vertex.index;
    return std::span(at_).subspan(at_begin_[v], at_begin_[v + 1] - at_begin_[v]);
  }
  /// Face of a corner.
  Index face_of(Offset corner) const { return topology_.face_of(corner); }
  /// Whether the face of a corner is oriented against the vertex there; never on an orientable mesh.
  bool mirrored(Offset corner) const { return !mirrored_.empty() && mirrored_[corner] != 0; }
  /// Whether a face was turned over.
  bool reversed(Index f) const { return topology_.reversed()[f] != 0; }

  /// First vertex of each input vertex, -1 where no face uses it.
  std::span<const Index> vertex_of_input() const noexcept { return topology_.vertex_of_input(); }
  /// Input vertex of each vertex.
  std::span<const Index> input_of_vertex() const noexcept { return topology_.input_of_vertex(); }

  /// Position of a vertex in units of `length_unit()` about the middle of the bounding box of its component.
  const Vec3& position(Vertex vertex) const { return position_[vertex.index]; }
  /// Position of a vertex as given.
  const Vec3& original_position(Vertex vertex) const { return input_[input_of_vertex()[vertex.index]]; }
  /// Positions of all input vertices as given.
  std::span<const Vec3> input_positions() const noexcept { return input_; }
  /// A power of two near the size of the mesh.
  double length_unit() const noexcept { return length_unit_; }

  /// Faces without area, because all their corners lie on one line.
  std::vector<Index> collinear_faces() const;
  /// The mesh as triangles; its first `vertex_count()` vertices are those of this mesh.
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
