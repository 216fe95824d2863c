/// \file
/// A checked triangle mesh, from which the graph of a surface is built.
///
/// \code
/// auto mesh = ahm::trimesh::TriangleMesh::from_positions(positions, faces);            // ahm::Vec3s, ahm::Triangles
/// auto same = ahm::trimesh::TriangleMesh::from_edge_lengths(n, faces, lengths);        // only the metric
/// std::cout << mesh.report().components << " components\n";
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ahm/surface/detail/gluing.hpp"
#include "ahm/types.hpp"

namespace ahm::trimesh {

/// A half-edge of a mesh: 3 f + s is side s of face f, from corner s to corner s + 1 (mod 3).
using detail::Half;

using ahm::NonManifold;
using ahm::TopologyReport;

/// An immutable triangle mesh in flat half-edge arrays, consistently oriented where that is possible.
///
/// Faces keep their numbers. A face that was reversed has its corners 1 and 2 swapped. Vertices are renumbered in the order
/// of the input, without unreferenced ones; copies made by splitting come last.
///
/// Edges without length are contracted: their ends become one vertex, and the faces at them are dropped (`is_dropped`). No
/// traversal enters dropped faces. In space an edge has no length up to 2e-12 of the largest coordinate of its component, where
/// rounding begins to decide how its faces lie. In a mesh of edge lengths the limit is 1e-15 of the longest edge. Vertices that
/// lie only in dropped faces are left out, except in a mesh of such faces only.
class TriangleMesh {
 public:
  /// A mesh in space.
  /// @param counts_as_reversed  per face, 1 if the majority orientation of its component is computed as if the face were reversed
  ///                (`face_parts`); empty: no face
  /// @throws InvalidGeometry (no faces, index out of range, vertex repeated in a face, duplicate face, vertex of a
  ///         face not finite, non-manifold edge or vertex); messages list the first ten elements and the count
  static TriangleMesh from_positions(std::span<const Vec3> positions, std::span<const Triangle> faces,
                                     NonManifold non_manifold = NonManifold::error,
                                     std::span<const std::uint8_t> counts_as_reversed = {});
  /// A mesh defined only by its edge lengths.
  /// @param vertices  number of vertices
  /// @param lengths   one triple per face; length s is that of the side from corner s to corner s + 1. Finite, >= 0, within the
  ///                  triangle inequality, and equal (to a relative 1e-9) in both faces of an edge
  /// @throws InvalidGeometry (as `from_positions`; lengths)
  static TriangleMesh from_edge_lengths(Index vertices, std::span<const Triangle> faces,
                                        std::span<const std::array<double, 3>> lengths,
                                        NonManifold non_manifold = NonManifold::error);

  Index vertex_count() const noexcept { return topology_.vertex_count(); }
  Index face_count() const noexcept { return topology_.face_count(); }
  const TopologyReport& report() const noexcept { return topology_.report(); }
  const detail::GluedMesh& topology() const noexcept { return topology_; }

  /// Vertex at the start of each half-edge.
  std::span<const Index> tails() const noexcept { return topology_.half_edges().tail; }
  /// Opposite half-edge; on the boundary -1 minus the number of the boundary edge, which is negative.
  std::span<const Half> twins() const noexcept { return topology_.half_edges().twin; }
  /// 1 where the two faces at a half-edge have opposite orientations; empty on an orientable mesh.
  std::span<const std::uint8_t> mirrored() const noexcept { return topology_.half_edges().mirrored; }
  /// 1 where a face was reversed.
  std::span<const std::uint8_t> reversed() const noexcept { return topology_.reversed(); }
  /// One half-edge that starts at each vertex; the vertex is oriented like its face.
  std::span<const Half> corners() const noexcept { return topology_.corners(); }

  /// First vertex of each input vertex; -1: no face uses it.
  std::span<const Index> vertex_of_input() const noexcept { return topology_.vertex_of_input(); }
  /// Input vertex of each vertex.
  std::span<const Index> input_of_vertex() const noexcept { return topology_.input_of_vertex(); }

  bool has_positions() const noexcept { return !position_.empty(); }
  /// Position of a vertex relative to the center of its component's bounding box, in units of `length_unit()`.
  const Vec3& position(Vertex vertex) const { return position_[vertex.index]; }
  /// Input position of a vertex.
  const Vec3& original_position(Vertex vertex) const { return input_[input_of_vertex()[vertex.index]]; }
  /// Positions of all input vertices; empty without positions.
  std::span<const Vec3> input_positions() const noexcept { return input_; }
  /// A power of two near the size of the mesh.
  double length_unit() const noexcept { return length_unit_; }
  /// Rounding error of the input coordinates in the component of a vertex, in units of `length_unit()`.
  double rounding(Vertex vertex) const noexcept { return rounding_.empty() ? 0x1p-52 : rounding_[vertex.index]; }
  /// The face laid out in the plane, counter-clockwise, side 0 along the x axis: its three sides as vectors, in units of
  /// `length_unit()`.
  std::array<Vec2, 3> layout(Index face) const;

  /// Corner of the stored face that corresponds to a corner of the input face, and vice versa.
  int stored_corner(Index face, int corner) const { return topology_.stored_corner(face, corner); }

  /// Whether a face was dropped because one of its edges has no length.
  bool is_dropped(Index face) const { return topology_.is_dropped(face); }
  /// The half-edge that starts at a corner of an input face. For a dropped face, a half-edge of a face that was kept, the same
  /// face for all three corners. @throws InvalidArgument (no face next to the dropped face was kept)
  Half kept_corner(Index face, int corner) const;

 private:
  TriangleMesh(Index vertices, std::span<const Triangle> faces, NonManifold non_manifold,
               std::span<const std::uint8_t> counts_as_reversed = {});
  void contract(std::vector<std::uint8_t> contracted);

  detail::GluedMesh topology_;
  std::vector<Vec3> position_;    ///< position of each vertex, or empty
  std::vector<Vec3> input_;       ///< position of each input vertex, or empty
  std::vector<double> rounding_;  ///< rounding error at each vertex, or empty
  std::vector<double> length_;    ///< length of each half-edge, or empty
  double length_unit_ = 1.0;
};

}  // namespace ahm::trimesh
