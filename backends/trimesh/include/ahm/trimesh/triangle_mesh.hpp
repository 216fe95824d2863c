/// \file
/// A checked triangle mesh: what the graph of a surface is built from.
///
/// \code
/// auto mesh = ahm::trimesh::TriangleMesh::from_positions(positions, faces);            // ahm::Vec3s, ahm::Triangles
/// auto same = ahm::trimesh::TriangleMesh::from_edge_lengths(n, faces, lengths);        // the metric alone
/// std::cout << mesh.report().components << " components\n";
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ahm/surface/gluing.hpp"
#include "ahm/types.hpp"

namespace ahm::trimesh {

/// A half-edge of a mesh: 3 f + s is side s of face f, from its corner s to its corner s + 1 (mod 3).
using detail::Half;

using ahm::NonManifold;
using ahm::TopologyReport;

/// An immutable triangle mesh in flat half-edge arrays, consistently oriented where that is possible.
///
/// Faces keep their number. A face that was turned over has its corners 1 and 2 swapped. Vertices are numbered anew
/// without the unreferenced ones, in the order of the input; copies made by splitting come last.
///
/// The ends of an edge without length are one vertex, and the faces on its sides are dropped: nothing turns into them
/// (`is_dropped`). In space an edge counts as one up to 2e-12 of the largest coordinate of its component, where rounding begins
/// to decide how the faces lie; by lengths alone up to 1e-15 of the longest. Vertices in such faces alone are left out; a mesh of
/// such faces alone keeps them.
class TriangleMesh {
 public:
  /// A mesh in space.
  /// @param turned  per face, 1 where it counts as turned over already when neighbours are oriented like the majority of their
  ///                component (`face_parts`); empty: none does
  /// @throws InvalidGeometry (no faces, index out of range, vertex repeated in a face, duplicate face, coordinate not
  ///         finite, non-manifold edge or vertex), naming the first ten elements and the count
  static TriangleMesh from_positions(std::span<const Vec3> positions, std::span<const Triangle> faces,
                                     NonManifold non_manifold = NonManifold::error,
                                     std::span<const std::uint8_t> turned = {});
  /// A mesh given by its metric alone.
  /// @param vertices  number of vertices
  /// @param lengths   one triple per face, length s is that of the side from corner s to corner s + 1; finite, >= 0, equal
  ///                  (to 1e-9 of it) in both faces of an edge, and within the triangle inequality
  /// @throws InvalidGeometry as above
  static TriangleMesh from_edge_lengths(Index vertices, std::span<const Triangle> faces,
                                        std::span<const std::array<double, 3>> lengths,
                                        NonManifold non_manifold = NonManifold::error);

  Index vertex_count() const noexcept { return topology_.vertex_count(); }
  Index face_count() const noexcept { return topology_.face_count(); }
  const TopologyReport& report() const noexcept { return topology_.report(); }
  const detail::GluedMesh& topology() const noexcept { return topology_; }

  /// Vertex at the start of each half-edge.
  std::span<const Index> tails() const noexcept { return topology_.half_edges().tail; }
  /// Opposite half-edge; negative, -1 minus the number of the boundary edge, on the boundary.
  std::span<const Half> twins() const noexcept { return topology_.half_edges().twin; }
  /// 1 where the two faces at a half-edge are oppositely oriented; empty on an orientable mesh.
  std::span<const std::uint8_t> mirrored() const noexcept { return topology_.half_edges().mirrored; }
  /// 1 where a face was turned over.
  std::span<const std::uint8_t> reversed() const noexcept { return topology_.reversed(); }
  /// One half-edge that starts at each vertex; the vertex is oriented like its face.
  std::span<const Half> corners() const noexcept { return topology_.corners(); }

  /// First vertex of each input vertex, -1 where no face uses it.
  std::span<const Index> vertex_of_input() const noexcept { return topology_.vertex_of_input(); }
  /// Input vertex of each vertex.
  std::span<const Index> input_of_vertex() const noexcept { return topology_.input_of_vertex(); }

  bool has_positions() const noexcept { return !position_.empty(); }
  /// Position of a vertex in units of `length_unit()` about the middle of the bounding box of its component.
  const Vec3& position(Vertex vertex) const { return position_[vertex.index]; }
  /// Position of a vertex as given.
  const Vec3& original_position(Vertex vertex) const { return input_[input_of_vertex()[vertex.index]]; }
  /// Positions of all input vertices as given; empty without positions.
  std::span<const Vec3> input_positions() const noexcept { return input_; }
  /// A power of two near the size of the mesh.
  double length_unit() const noexcept { return length_unit_; }
  /// Rounding of the coordinates as given of the component of a vertex, in units of `length_unit()`.
  double rounding(Vertex vertex) const noexcept { return rounding_.empty() ? 0x1p-52 : rounding_[vertex.index]; }
  /// The face laid out in the plane, counter-clockwise, side 0 along the x axis: its three sides as vectors, in units
  /// of `length_unit()`.
  std::array<Vec2, 3> layout(Index face) const;

  /// Corner of the face as stored, for a corner of the face as given, and the other way round.
  int stored_corner(Index face, int corner) const { return topology_.stored_corner(face, corner); }

  bool is_dropped(Index face) const { return topology_.is_dropped(face); }
  /// For a corner of a face as given, the half-edge that starts there: of the face itself or, where that was dropped, of one
  /// and the same face that was kept. @throws InvalidArgument (nothing of the face is left)
  Half kept_corner(Index face, int corner) const;

 private:
  TriangleMesh(Index vertices, std::span<const Triangle> faces, NonManifold non_manifold,
               std::span<const std::uint8_t> turned = {});
  void contract(std::vector<std::uint8_t> contracted);

  detail::GluedMesh topology_;
  std::vector<Vec3> position_;    ///< per vertex, or empty
  std::vector<Vec3> input_;       ///< per input vertex, or empty
  std::vector<double> rounding_;  ///< per vertex, or empty
  std::vector<double> length_;    ///< per half-edge, or empty
  double length_unit_ = 1.0;
};

}  // namespace ahm::trimesh
