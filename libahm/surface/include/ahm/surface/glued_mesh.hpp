/// \file
/// Faces glued to a manifold, oriented alike where that is possible, their vertices numbered. Not part of the public
/// interface: what triangle and polygon meshes have in common.
#pragma once

#include <span>
#include <vector>

#include "ahm/surface/half_edges.hpp"
#include "ahm/surface/mesh_topology.hpp"

namespace ahm::detail {

/// Faces keep their number. One that was turned over has its corners in the opposite order, the first staying first.
/// Vertices are numbered anew without the unreferenced ones, in the order of the input; copies made by splitting come
/// last.
class GluedMesh {
 public:
  /// @throws InvalidGeometry (no faces, index out of range, fewer than three corners, vertex repeated in a face, duplicate
  ///         face; faults non_manifold_edges, non_manifold_vertices), naming the first ten and the count
  GluedMesh(Index vertices, const FaceList& faces, NonManifold non_manifold);

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
  /// Input vertices at all corners of the faces as given.
  std::vector<Index> given_corners() const;

 private:
  void build_half_edges(const FaceList& faces, NonManifold non_manifold);
  void number_vertices(NonManifold non_manifold);
  void count_parts();

  TopologyReport report_;
  std::vector<Offset> face_begin_;
  std::vector<Index> face_of_;  ///< empty: triangles
  std::vector<Index> tail_;
  std::vector<Half> twin_;
  std::vector<std::uint8_t> mirrored_, reversed_;
  std::vector<Half> corner_;
  std::vector<Index> vertex_of_input_, input_of_vertex_;
};

}  // namespace ahm::detail
