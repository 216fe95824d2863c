/// \file
/// Polygons glued along their common edges, and oriented alike. Not part of the public interface.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ahm/surface/half_edges.hpp"
#include "ahm/surface/mesh_topology.hpp"
#include "ahm/surface/row_map.hpp"
#include "ahm/types.hpp"

namespace ahm::detail {

/// Sides of the faces as given that lie on each other.
struct Gluing {
  std::vector<Half> partner;           ///< per side of the faces as given, -1: none
  std::vector<std::uint8_t> reversed;  ///< per face: 1 where it must be turned over
  Index reoriented = 0;
  bool orientable = true;
  Index non_manifold_edges = 0;
};

/// "(3, 4), (5, 6)": the first ten items, and how many more there are.
class ItemList {
 public:
  void add(const std::string& item) {
    if (count_++ >= 10) return;
    if (count_ > 1) text_.append(", ");
    text_.append(item);
  }
  Offset count() const { return count_; }
  std::string text() const { return count_ > 10 ? text_ + " and " + std::to_string(count_ - 10) + " more" : text_; }

 private:
  Offset count_ = 0;
  std::string text_;
};

/// Faces that cannot be glued to others, in ascending order.
struct FaceFaults {
  std::vector<Index> outside, small, repeating;  ///< as of `MeshInspection`
};

/// @throws InvalidGeometry (no vertices, no faces, offsets, more than 2^31 - 2 corners)
FaceFaults find_faults(Index vertices, const FaceList& faces);

/// Pairs of equal faces, the later one first, among faces without other faults; sorted.
std::vector<std::pair<Index, Index>> find_duplicates(Index vertices, const FaceList& faces);

/// Checks indices, corners, repeated vertices, duplicate faces and edges with more than two faces, and orients every
/// component like the majority of its faces.
/// @param turned  per face, 1 where it counts as turned over for the majority; empty: none is
/// @throws InvalidGeometry, InvalidArgument (turned: another number of faces)
Gluing glue(Index vertices, const FaceList& faces, NonManifold non_manifold, std::span<const std::uint8_t> turned = {});

/// @throws InvalidGeometry (more than 2^30 positions, a coordinate that is not finite)
void check_positions(std::span<const Vec3> positions);

/// Positions of the vertices of a mesh as numbers of order one.
struct NormalizedPositions {
  std::vector<Vec3> points;      ///< in units, about the middle of the bounding box of their part
  std::vector<double> rounding;  ///< per point, of coordinates as given, in units: that of the largest of its part
  double unit;                   ///< what a length of 1 was before: a power of two
};

/// A part has the same numbers, but for a power of two, whatever lies beside it.
/// @param part  per point, the lowest one of its part
NormalizedPositions normalize_positions(std::vector<Vec3> points, std::span<const Index> part);

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
