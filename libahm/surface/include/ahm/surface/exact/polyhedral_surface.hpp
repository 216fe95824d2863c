/// \file
/// Flat triangles glued along their sides: the input of exact geodesics.
///
/// \code
/// ahm::exact::PolyhedralSurface surface(mesh.topology().half_edges(), layouts);
/// ahm::exact::ExactMap map = ahm::exact::exact_map(surface, surface.vertex_point(ahm::Vertex{42}));
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ahm/surface/detail/half_edges.hpp"
#include "ahm/types.hpp"

namespace ahm::exact {

using detail::Corner;
using detail::Half;
using detail::HalfEdges;
using detail::next;
using detail::previous;

/// The three sides of a face laid out in the plane, counterclockwise, as vectors that sum to zero. Any rotation is valid.
using FaceSides = std::array<Vec2, 3>;

/// A point of a face by barycentric weights, in the stored order of corners. One zero: on a side; two: at a vertex.
struct MeshPoint {
  Index face = 0;
  std::array<double, 3> barycentric{1, 0, 0};
};

/// The data needed to cross the face of a half-edge. The frame of a half-edge has the tail at the origin and the head at
/// (length, 0). The third corner of the face, the apex, is above.
struct HalfRecord {
  double length, apex_x, apex_y;
  double back_x;       ///< length - apex_x, without cancellation where the apex is near the head
  double left, right;  ///< lengths of the sides tail - apex and head - apex
  Index tail, head, apex;
  Half beyond_left, beyond_right;  ///< half-edges across these sides; negative on the boundary
  std::uint8_t mirrored;  ///< bit 0: the face across the left side has the opposite orientation; bit 1: the right side
};

/// An immutable polyhedral surface, with or without boundary, of any number of components, orientable or not. Sides of one face
/// may be glued to each other.
class PolyhedralSurface {
 public:
  /// Triangles flatter than this multiple of their longest side are rejected.
  static constexpr double min_height = 1e-13;

  /// @param edges    half-edges of triangles
  /// @param sides    one per face; both faces of an edge have the same length for it to 1e-9
  /// @param corners  per vertex: a half-edge that starts there, whose face defines the orientation of the vertex; -1 for a
  ///                 vertex without faces; empty: the lowest half-edge
  /// @param threads  0: one per core. No result depends on it
  /// @throws InvalidGeometry naming the face or half-edge: a side that is not finite or zero, a triangle flatter than 1e-13 of
  /// its longest side, sides that do not close, lengths that differ, twins that are not mutual or join other vertices, a vertex
  /// with several fans or none
  PolyhedralSurface(const HalfEdges& edges, std::span<const FaceSides> sides, std::span<const Half> corners = {},
                    unsigned threads = 1);
  /// Calls `sides_of` once for each face, on several threads if `threads` is not 1.
  PolyhedralSurface(const HalfEdges& edges, const std::function<FaceSides(Index)>& sides_of,
                    std::span<const Half> corners = {}, unsigned threads = 1);
  /// Builds the surface from edge lengths: length s of a face is that of its side s. Flat cap triangles are accurate only to
  /// 1e-8.
  /// @throws InvalidGeometry (as the constructor)
  static PolyhedralSurface from_lengths(const HalfEdges& edges, std::span<const std::array<double, 3>> lengths,
                                        std::span<const Half> corners = {});

  Index vertex_count() const noexcept { return static_cast<Index>(corner_.size()); }
  Index face_count() const noexcept { return static_cast<Index>(face_.size()); }

  [[gnu::always_inline]] HalfRecord record(Half h) const {
    const auto [face, s] = split(h);
    const Face& f = face_[face];
    const std::uint32_t n = s == 2 ? 0 : s + 1, p = s == 0 ? 2 : s - 1;
    return {f.length[s], f.apex_x[s],
            f.apex_y[s], f.apex_x[n] * f.length[n] / f.length[s],
            f.length[p], f.length[n],
            f.tail[s],   f.tail[n],
            f.tail[p],   f.beyond[p],
            f.beyond[n], static_cast<std::uint8_t>((f.mirrored >> p & 1) | (f.mirrored >> n & 1) << 1)};
  }
  /// Angle of the face at the tail of a half-edge.
  double angle(Half h) const {
    const auto [face, s] = split(h);
    return face_[face].angle[s];
  }
  /// Sum of the angles around a vertex.
  double angle_sum(Index vertex) const { return angle_sum_[vertex]; }
  bool on_boundary(Index vertex) const { return on_boundary_[vertex] != 0; }
  /// Whether shortest paths may bend at a vertex: on the boundary, or where the angle sum exceeds 2 pi.
  bool bends_paths(Index vertex) const;
  /// The corner where angles around a vertex start: the rightmost one on the boundary, else the one of the constructor.
  Corner first_corner(Index vertex) const { return corner_[vertex]; }
  /// Factor from angles on the surface to angles in the tangent space, as in the frames of the triangle backend: 2 pi / angle
  /// sum at interior vertices, 1 on the boundary.
  double angle_scale(Index vertex) const;
  /// Number of the vertex' connected component, from 0.
  Index component(Index vertex) const { return component_[vertex]; }
  Index component(const MeshPoint& point) const { return component_[face_[point.face].tail[0]]; }
  struct Component {
    Index vertices = 0;
    double mean_length = 0;  ///< of the sides of all faces
  };
  const Component& component_details(Index component) const { return components_[component]; }

  /// The neighboring corner across the last (left) or first (right) side in counterclockwise order; half < 0: boundary.
  Corner turn_left(Corner c) const { return beyond(c.forward ? previous(c.half) : c.half, !c.forward, c.forward); }
  Corner turn_right(Corner c) const { return beyond(c.forward ? c.half : previous(c.half), c.forward, c.forward); }
  /// The angle around a vertex from the right side of its first corner to the right side of `corner`.
  double turned(Corner corner) const;

  /// A vertex as a point of a face. @throws InvalidArgument (out of range), InvalidGeometry (fault "vertex_without_triangles")
  MeshPoint vertex_point(Vertex vertex) const;
  /// Position of a point in the frame of side 0 of its face.
  Vec2 place(const MeshPoint& point) const;

 private:
  /// Data of one face, in two cache lines. Arrays are indexed by side, or by the corner where the side starts.
  struct alignas(64) Face {
    double length[3], apex_x[3], apex_y[3], angle[3];
    Index tail[3];
    Half beyond[3];         ///< half-edge across each side; negative on the boundary
    std::uint8_t mirrored;  ///< bit s: the face across side s has the opposite orientation
  };

  struct FaceSide {
    std::uint32_t face, side;
  };
  static FaceSide split(Half h) {
    const auto u = static_cast<std::uint32_t>(h);
    return {u / 3, u % 3};
  }
  Corner beyond(Half side, bool vertex_is_tail, bool forward) const {
    const Face& f = face_[side / 3];
    const Half twin = f.beyond[side % 3];
    if (twin < 0) return {};
    return detail::corner_beyond(twin, next(twin), (f.mirrored >> side % 3 & 1) != 0, vertex_is_tail, forward);
  }
  void set_face(Index face, const HalfEdges& edges, const FaceSides& sides);
  void check_lengths(Index face) const;
  void set_fans(const HalfEdges& edges, std::span<const Half> corners, unsigned threads);
  void set_components();

  std::vector<Face> face_;
  std::vector<double> angle_sum_;
  std::vector<std::uint8_t> on_boundary_;
  std::vector<Corner> corner_;
  std::vector<Index> component_;
  std::vector<Component> components_;
};

}  // namespace ahm::exact
