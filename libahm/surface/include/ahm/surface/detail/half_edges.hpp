/// \file
/// Half-edge arrays of triangle or polygon meshes, and traversal around a vertex. Not part of the public interface.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::detail {

/// A half-edge: one side of a face. Half-edge h starts at corner h, in the numbering of the corners of all faces, and ends at
/// the next corner of the same face. In triangle meshes, side s of face f is 3 f + s.
using Half = std::int32_t;

/// The next or previous half-edge of the same triangle.
template <class H>
H next(H h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
template <class H>
H previous(H h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}

/// A corner in a counterclockwise traversal around its vertex. `half` starts at the vertex. `forward` is true where the face
/// has the orientation of the vertex, which is always so on an orientable mesh.
struct Corner {
  Half half = -1;
  bool forward = true;

  bool operator==(const Corner&) const = default;
};

/// The next corner at the same vertex, across one side of a corner's face.
/// @param twin            twin of the side, >= 0
/// @param after_twin      half-edge after `twin`
/// @param mirrored        whether the adjacent face has the opposite orientation
/// @param vertex_is_tail  whether the vertex is the tail of the side
inline Corner corner_beyond(Half twin, Half after_twin, bool mirrored, bool vertex_is_tail, bool forward) {
  return {vertex_is_tail == mirrored ? twin : after_twin, forward != mirrored};
}

/// Connectivity of faces glued along their sides. Holds spans of a mesh, or of arrays whose edges are being flipped.
struct HalfEdges {
  std::span<const Index> tail;             ///< vertex at the start of each half-edge
  std::span<const Half> twin;              ///< opposite half-edge; on the boundary: -1 - (number of the boundary edge)
  std::span<const std::uint8_t> mirrored;  ///< 1 where the two faces have opposite orientations; empty: nowhere
  std::span<const Offset> face_begin{};    ///< first corner of each face, faces + 1; empty: triangles
  std::span<const Index> face_of{};        ///< face of each half-edge; empty: triangles

  Half size() const { return static_cast<Half>(tail.size()); }
  Half next(Half h) const {
    if (face_of.empty()) return detail::next(h);
    return h + 1 == face_begin[face_of[h] + 1] ? static_cast<Half>(face_begin[face_of[h]]) : h + 1;
  }
  Half previous(Half h) const {
    if (face_of.empty()) return detail::previous(h);
    return static_cast<Half>(h == face_begin[face_of[h]] ? face_begin[face_of[h] + 1] - 1 : h - 1);
  }
  Index head(Half h) const { return tail[next(h)]; }
  bool is_mirrored(Half h) const { return !mirrored.empty() && mirrored[h]; }

  /// The first (right) and the last (left) side of a corner in counterclockwise order.
  Half right(Corner c) const { return c.forward ? c.half : previous(c.half); }
  Half left(Corner c) const { return c.forward ? previous(c.half) : c.half; }
  /// The neighboring corner across the left or right side; half < 0 on the boundary.
  Corner turn_left(Corner c) const { return beyond(left(c), !c.forward, c.forward); }
  Corner turn_right(Corner c) const { return beyond(right(c), c.forward, c.forward); }

  /// The last corner before the boundary when turning clockwise from c; c itself where there is no boundary.
  Corner rightmost(Corner c) const {
    for (Corner at = c;;) {
      const Corner right = turn_right(at);
      if (right.half < 0) return at;
      if (right == c) return c;
      at = right;
    }
  }

  /// Number of a directed edge: the edge of side h, leaving its tail (`from_tail`) or its head. A half-edge has its own number.
  /// The reverse direction of a boundary edge, which has no twin, has a number from size() on.
  std::size_t directed(Half h, bool from_tail) const {
    const Half t = twin[h];
    if (t < 0) return from_tail ? static_cast<std::size_t>(h) : tail.size() + static_cast<std::size_t>(-1 - t);
    if (is_mirrored(h)) return static_cast<std::size_t>(from_tail ? std::min(h, t) : std::max(h, t));
    return static_cast<std::size_t>(from_tail ? h : t);
  }

 private:
  Corner beyond(Half side, bool vertex_is_tail, bool forward) const {
    const Half t = twin[side];
    return t < 0 ? Corner{} : corner_beyond(t, next(t), is_mirrored(side), vertex_is_tail, forward);
  }
};

/// Flips edges of a triangulation until all edges are Delaunay [BS07].
/// @param stack        half-edges to start with, the last one first; one half-edge per edge
/// @param cap          maximum number of flips. Flipping terminates except for rounding on degenerate input
/// @param twin         twin(h): twin of a half-edge
/// @param is_delaunay  is_delaunay(h): whether the edge is Delaunay; always true on the boundary
/// @param flip         flip(h): flips an edge of two faces. Both half-edges keep their places in the faces
/// @return whether all edges are Delaunay
template <class H, class Twin, class IsDelaunay, class Flip>
bool flip_to_delaunay(std::vector<H> stack, std::size_t cap, const Twin& twin, const IsDelaunay& is_delaunay,
                      const Flip& flip) {
  for (std::size_t flips = 0; !stack.empty() && flips < cap;) {
    const H h = stack.back();
    stack.pop_back();
    if (is_delaunay(h)) continue;
    flip(h);
    ++flips;
    for (H side : {next(h), previous(h), next(twin(h)), previous(twin(h))}) stack.push_back(side);
  }
  return stack.empty();
}

/// Moves the four outer sides of two faces to other half-edges. Two of the four sides may be glued to each other.
/// @param mirrored  as `HalfEdges::mirrored`; may be empty
template <class H>
void relink(const std::array<H, 4>& from, const std::array<H, 4>& to, std::span<H> twin,
            std::span<std::uint8_t> mirrored) {
  H outer[4];
  std::uint8_t mirrors[4] = {};
  for (int s = 0; s < 4; ++s) {
    outer[s] = twin[from[s]];
    if (!mirrored.empty()) mirrors[s] = mirrored[from[s]];
  }
  for (int s = 0; s < 4; ++s) {
    H partner = outer[s];
    for (int q = 0; q < 4; ++q)
      if (outer[s] == from[q]) partner = to[q];
    twin[to[s]] = partner;
    if (partner >= 0) twin[partner] = to[s];
    if (mirrored.empty()) continue;
    mirrored[to[s]] = mirrors[s];
    if (partner >= 0) mirrored[partner] = mirrors[s];
  }
}

}  // namespace ahm::detail
