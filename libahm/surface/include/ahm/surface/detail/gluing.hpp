/// \file
/// Gluing of polygons along common edges, with consistent orientation. Not part of the public interface.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ahm/surface/detail/half_edges.hpp"
#include "ahm/surface/mesh_topology.hpp"
#include "ahm/surface/row_map.hpp"
#include "ahm/types.hpp"

namespace ahm::detail {

/// Pairs of coincident sides of the input faces.
struct Gluing {
  std::vector<Half> partner;           ///< partner of each side of the input faces; -1: none
  std::vector<std::uint8_t> reversed;  ///< per face: 1 where it must be reversed
  Index reoriented = 0;
  bool orientable = true;
  Index non_manifold_edges = 0;
};

/// A list for messages, "(3, 4), (5, 6)": the first ten items and the number of the others.
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

/// Faces that cannot be glued, in ascending order.
struct FaceFaults {
  std::vector<Index> outside, small, repeating;  ///< as in `MeshInspection`
};

/// Finds faces with a vertex out of range, with fewer than three corners, or with a repeated vertex.
/// @throws InvalidGeometry (no vertices, no faces, offsets, more than 2^31 - 2 corners)
FaceFaults find_faults(Index vertices, const FaceList& faces);

/// Pairs of equal faces (later, earlier) among faces without other faults; sorted.
std::vector<std::pair<Index, Index>> find_duplicates(Index vertices, const FaceList& faces);

/// Checks indices, corners, repeated vertices, duplicate faces and edges with more than two faces. Orients every component like
/// the majority of its faces.
/// @param counts_as_reversed  per face: 1 where the majority vote treats it as reversed; empty: none
/// @throws InvalidGeometry, InvalidArgument (counts_as_reversed: another number of faces)
Gluing glue(Index vertices, const FaceList& faces, NonManifold non_manifold,
            std::span<const std::uint8_t> counts_as_reversed = {});

/// Checks the positions that faces use; others may be NaN or infinite.
/// @param corners  vertices of the faces; those out of range are ignored
/// @throws InvalidGeometry (more than 2^30 positions, a coordinate that is not finite)
void check_positions(std::span<const Vec3> positions, std::span<const Index> corners);

/// Positions of the vertices of a mesh, scaled to order one.
struct NormalizedPositions {
  std::vector<Vec3> points;      ///< in units of `unit`, relative to the middle of the bounding box of their part
  std::vector<double> rounding;  ///< per point: rounding error of the largest input coordinate of its part, in `unit`
  double unit;                   ///< input length of a unit: a power of two
};

/// The result for one part does not depend on other parts, except for a power of two.
/// @param part  per point: the lowest point of its part
NormalizedPositions normalize_positions(std::vector<Vec3> points, std::span<const Index> part);

/// A mesh of glued, consistently oriented faces. Faces keep their number. A reversed face has its corners in the opposite
/// order; the first corner stays first. Vertices are renumbered in the order of the input, without the unreferenced ones.
/// Copies made by splitting come last.
class GluedMesh {
 public:
  /// @param counts_as_reversed  as in `glue`
  /// @throws InvalidGeometry (no faces, index out of range, fewer than three corners, vertex repeated in a face, duplicate
  /// face; faults non_manifold_edges, non_manifold_vertices). The message lists the first ten and the count
  GluedMesh(Index vertices, const FaceList& faces, NonManifold non_manifold,
            std::span<const std::uint8_t> counts_as_reversed = {});

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
  /// Converts a corner number of the input face to that of the stored face, and vice versa.
  Index stored_corner(Index face, Index corner) const {
    return !reversed_[face] || corner == 0 ? corner
                                           : static_cast<Index>(face_begin_[face + 1] - face_begin_[face]) - corner;
  }
  /// The lowest half-edge that starts at each vertex. The vertex has the orientation of its face.
  std::span<const Half> corners() const { return corner_; }
  /// First vertex of each input vertex; -1 where no face uses it.
  std::span<const Index> vertex_of_input() const { return vertex_of_input_; }
  /// Input vertex of each vertex.
  std::span<const Index> input_of_vertex() const { return input_of_vertex_; }
  /// The lowest vertex of the connected component of each vertex.
  std::span<const Index> parts() const { return part_; }
  /// Input vertex at every corner of the input faces.
  std::vector<Index> given_corners() const;

  /// Contracts edges of triangles: the two ends become one vertex, that of the lowest input vertex. A face with a contracted
  /// side is dropped, and the faces across its two other sides are glued together. The dropped face keeps its number and
  /// half-edges, but no traversal reaches it. A vertex that is only in dropped faces is removed. A mesh that would lose all
  /// faces stays unchanged. Where two boundaries meet in one point, that vertex is split.
  /// @param contracted  per half-edge: 1 for both halves of the contracted edges
  void contract(std::vector<std::uint8_t> contracted);
  bool is_dropped(Index face) const { return !dropped_.empty() && dropped_[face]; }
  /// 1 for each dropped face; empty without contracted edges.
  std::span<const std::uint8_t> dropped() const { return dropped_; }
  /// For each corner of a dropped face, in the stored order: the corner of a remaining face that has the same position. All
  /// three are corners of one face; -1 where no face remains.
  std::array<Half, 3> stand_in(Index face) const { return stand_in_[face]; }
  /// Pairs (merged input vertex, input vertex that replaces it), in ascending order.
  std::span<const std::pair<Index, Index>> merged() const { return merged_; }
  /// All input vertices with their vertices. Those of one input vertex are in the order of `vertex_of_input`.
  std::vector<RowVertex> rows() const;

 private:
  void build_half_edges(const FaceList& faces, NonManifold non_manifold,
                        std::span<const std::uint8_t> counts_as_reversed);
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
