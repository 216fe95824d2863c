/// \file
/// Flat half-edge arrays and how to turn about a vertex in them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "ahm/trimesh/triangle_mesh.hpp"

namespace ahm::trimesh {

inline Half next(Half h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline Half previous(Half h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// A corner met while turning counter-clockwise about its vertex. `half` starts at the vertex; `forward` says whether
/// its face is oriented like the vertex, which on an orientable mesh is always so.
struct Corner {
  Half half = -1;
  bool forward = true;

  /// The side met first when turning counter-clockwise, and the one met last.
  Half right() const { return forward ? half : previous(half); }
  Half left() const { return forward ? previous(half) : half; }
  bool operator==(const Corner&) const = default;
};

/// Connectivity of a triangulation: spans of a mesh, or of arrays being flipped.
struct HalfEdges {
  std::span<const Index> tail;
  std::span<const Half> twin;
  std::span<const std::uint8_t> mirrored;  ///< empty: nowhere

  explicit HalfEdges(const TriangleMesh& mesh) : tail(mesh.tails()), twin(mesh.twins()), mirrored(mesh.mirrored()) {}
  HalfEdges(std::span<const Index> tails, std::span<const Half> twins, std::span<const std::uint8_t> mirrors)
      : tail(tails), twin(twins), mirrored(mirrors) {}

  Half size() const { return static_cast<Half>(tail.size()); }
  Index head(Half h) const { return tail[next(h)]; }
  bool is_mirrored(Half h) const { return !mirrored.empty() && mirrored[h]; }

  /// The corner beyond the left or right side; half < 0 on the boundary.
  Corner turn_left(Corner c) const { return beyond(c.left(), !c.forward, c.forward); }
  Corner turn_right(Corner c) const { return beyond(c.right(), c.forward, c.forward); }

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
    if (t < 0) return static_cast<std::size_t>(from_tail ? h : size() - 1 - t);
    if (is_mirrored(h)) return static_cast<std::size_t>(from_tail ? std::min(h, t) : std::max(h, t));
    return static_cast<std::size_t>(from_tail ? h : t);
  }

 private:
  Corner beyond(Half side, bool vertex_is_tail, bool forward) const {
    const Half t = twin[side];
    if (t < 0) return {};
    const bool mirror = is_mirrored(side);
    return {vertex_is_tail == mirror ? t : next(t), forward != mirror};
  }
};

}  // namespace ahm::trimesh
