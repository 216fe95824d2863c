/// \file
/// Faces glued to a manifold, oriented alike where that is possible, their vertices numbered. Not part of the public
/// interface: what triangle and polygon meshes have in common.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "ahm/surface/half_edges.hpp"
#include "ahm/surface/mesh_topology.hpp"
#include "ahm/surface/row_map.hpp"

namespace ahm::detail {

/// Faces keep their number. One that was turned over has its corners in the opposite order, the first staying first.
/// Vertices are numbered anew without the unreferenced ones, in the order of the input; copies made by splitting come
/// last.
class GluedMesh {
 public:
  /// @param turned  as of `glue`
  /// @throws InvalidGeometry (no faces, index out of range, fewer than three corners, vertex repeated in a face, duplicate
  ///         face; faults non_manifold_edges, non_manifold_vertices), naming the first ten and the count
  GluedMesh(Index vertices, const FaceList& faces, NonManifold non_manifold, std::span<const std::uint8_t> turned = {});

  const TopologyReport& report() const { return report_; }
  Index vertex_count() const { return static_cast<Index>(input_of_vertex_.size()); }
  Index face_count() const { return static_cast<Index>(reversed_.size()); }
  HalfEdges half_edges() const {
    return face_of_.empty() ? HalfEdges{tail_, twin_, mirrored_}
                            : HalfEdges{tail_, twin_, mirrored_, face_begin_, face_of_};
  }
  std::span<const Offset> face_begin() const { return face_begin_; }
  std::span<const std::uint8_t> reversed() const { return reversed_; }
  Index face_of(Offset corner) const { return face_of_.empty() ? static_cast<Index>(corner / 3) : face_of_[corner]; }
  /// Corner of the face as stored, for a corner of the face as given, and the other way round.
  Index stored_corner(Index face, Index corner) const {
    return !reversed_[face] || corner == 0 ? corner
                                           : static_cast<Index>(face_begin_[face + 1] - face_begin_[face]) - corner;
  }
  /// The lowest half-edge that starts at each vertex; the vertex is oriented like its face.
  std::span<const Half> corners() const { return corner_; }
  /// First vertex of each input vertex, -1 where no face uses it.
  std::span<const Index> vertex_of_input() const { return vertex_of_input_; }
  /// Input vertex of each vertex.
  std::span<const Index> input_of_vertex() const { return input_of_vertex_; }
  /// The lowest vertex of the connected component of each vertex.
  std::span<const Index> parts() const { return part_; }
  /// Input vertices at all corners of the faces as given.
  std::vector<Index> given_corners() const;

  /// Contracts edges of triangles: their ends become one vertex, that of the lowest of the input vertices. A face with such a
  /// side has nothing left: it is dropped, and what lies beyond its two other sides is glued together. It keeps its number
  /// and half-edges, but nothing turns into it any more. A vertex in such faces alone is none any more; a mesh of such faces
  /// alone stays as it is. Where two boundaries meet in one point, that vertex is split.
  /// @param contracted  one per half-edge, 1 for both halves of the edges concerned
  void contract(std::vector<std::uint8_t> contracted);
  bool is_dropped(Index face) const { return !dropped_.empty() && dropped_[face]; }
  /// One per face; empty without contracted edges.
  std::span<const std::uint8_t> dropped() const { return dropped_; }
  /// For each corner of a dropped face as stored, the corner of a face that was kept, one for all three, with which it
  /// fell together; -1 where none is left.
  std::array<Half, 3> stand_in(Index face) const { return stand_in_[face]; }
  /// Input vertices that fell on another one, and that one, in ascending order.
  std::span<const std::pair<Index, Index>> merged() const { return merged_; }
  /// All input vertices and their vertices, those of one input vertex in the order of `vertex_of_input`.
  std::vector<RowVertex> rows() const;

 private:
  void build_half_edges(const FaceList& faces, NonManifold non_manifold, std::span<const std::uint8_t> turned);
  void number_vertices(NonManifold non_manifold);
  void find_parts();
  void renumber_contracted();
  void place_dropped_corners();

  TopologyReport report_;
  std::vector<Offset> face_begin_;
  std::vector<Index> face_of_;  ///< empty: triangles
  std::vector<Index> tail_;
  std::vector<Half> twin_;
  std::vector<std::uint8_t> mirrored_, reversed_;
  std::vector<Half> corner_;
  std::vector<Index> vertex_of_input_, input_of_vertex_, part_;
  // Empty without contracted edges:
  std::vector<Index> given_corners_;
  std::vector<std::uint8_t> dropped_;
  std::vector<std::array<Half, 3>> stand_in_;
  std::vector<std::pair<Index, Index>> merged_;
};

}  // namespace ahm::detail
