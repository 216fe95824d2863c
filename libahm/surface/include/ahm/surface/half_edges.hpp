/// \file
/// Flat half-edge arrays of triangles or polygons, and how to turn about a vertex in them. Not part of the public
/// interface.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::detail {

/// A side of a face: number h of the corners of all faces, from the vertex there to that of the face's next corner. Of
/// triangles, 3 f + s is side s of face f.
using Half = std::int32_t;

/// In triangles.
template <class H>
H next(H h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
template <class H>
H previous(H h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}

/// A corner met while turning counter-clockwise about its vertex. `half` starts at the vertex; `forward` says whether
/// its face is oriented like the vertex, which on an orientable mesh is always so.
struct Corner {
  Half half = -1;
  bool forward = true;

  bool operator==(const Corner&) const = default;
};

/// The corner at the same vertex beyond a side of a corner's face.
/// @param twin            of the side, and the half-edge after it; >= 0
/// @param mirrored        whether the face there is oppositely oriented
/// @param vertex_is_tail  of the side
inline Corner corner_beyond(Half twin, Half after_twin, bool mirrored, bool vertex_is_tail, bool forward) {
  return {vertex_is_tail == mirrored ? twin : after_twin, forward != mirrored};
}

/// Connectivity of faces glued along their sides: spans of a mesh, or of arrays being flipped.
struct HalfEdges {
  std::span<const Index> tail;             ///< vertex at the start of each half-edge
  std::span<const Half> twin;              ///< opposite half-edge; -1 - the number of the boundary edge on the boundary
  std::span<const std::uint8_t> mirrored;  ///< 1 where the two faces at it are oppositely oriented; empty: nowhere
  std::span<const Offset> face_begin{};    ///< empty: triangles
  std::span<const Index> face_of{};        ///< per half-edge; empty: triangles

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

  /// The side of a corner met first when turning counter-clockwise, and the one met last.
  Half right(Corner c) const { return c.forward ? c.half : previous(c.half); }
  Half left(Corner c) const { return c.forward ? previous(c.half) : c.half; }
  /// The corner beyond the left or right side; half < 0 on the boundary.
  Corner turn_left(Corner c) const { return beyond(left(c), !c.forward, c.forward); }
  Corner turn_right(Corner c) const { return beyond(right(c), c.forward, c.forward); }

  /// The last corner before the boundary when turning clockwise from c, or c itself when there is no boundary.
  Corner rightmost(Corner c) const {
    for (Corner at = c;;) {
      const Corner right = turn_right(at);
      if (right.half < 0) return at;
      if (right == c) return c;
      at = right;
    }
  }

  /// Numbers directed edges: the one that leaves, along side h, its tail (`from_tail`) or its head. Each half-edge has
  /// the number of itself; boundary edges, which lack a twin, get numbers from size() on for their other direction.
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

/// Flips edges of a triangulation until all are Delaunay [BS07].
/// @param stack         of half-edges to begin with, the last first; of both halves of an edge, one
/// @param cap           flips at the most: flipping ends by itself, but for rounding on degenerate input
/// @param twin          of a half-edge
/// @param is_delaunay   whether an edge is, on the boundary always
/// @param flip          turns an edge of two faces; both its halves keep their places in them
/// @return whether all are Delaunay
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

/// Moves the four outer sides of two faces to other half-edges. A side may be glued to another one of the four.
/// @param mirrored  as of `HalfEdges`; may be empty
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
