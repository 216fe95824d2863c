/// \file
/// The record of edge flips, and how points and directions of the input mesh are found in the flipped triangulation.
///
/// A flip retires two faces and makes two new ones in the same places of the arrays, so the flips form a directed
/// acyclic graph, as in incremental Delaunay triangulation. A point given by its barycentric coordinates in an input
/// face descends: at each flip that touches its face one sign decides on which side of the new diagonal it lies, and
/// its coordinates are rewritten by additions and multiplications of non-negative numbers. Nothing is traced along the
/// surface and no angle is summed around vertices, so there is nothing to miss and nothing to repair: a point near a
/// diagonal may land on either side of it, on the diagonal, but at the right place. The error of one step is a rounding
/// error of the quadrilateral's size, needles and caps included.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ahm/progress.hpp"
#include "ahm/surface/half_edges.hpp"
#include "ahm/trimesh/triangle_mesh.hpp"
#include "planar.hpp"

namespace ahm::trimesh {

using detail::Corner;
using detail::HalfEdges;
using detail::next;
using detail::previous;

/// Faces (i, j, k) and (j, i, m) on both sides of edge ij, replaced by (m, k, i) and (k, m, j).
///
/// The diagonals cross at alpha i + beta j = gamma k + delta m, alpha + beta = gamma + delta = 1.
struct Flip {
  std::array<Index, 2> face;         ///< places of the two faces
  std::array<std::int32_t, 2> next;  ///< next flip that touches each place, -1: none
  std::array<std::uint8_t, 2> side;  ///< side ij of the one, ji of the other; km and mk afterwards
  bool mirrored;                     ///< the second face was turned over first
  double beta, gamma;
  Vec2 turn;  ///< rotation: layout of the second face (after turning over) -> layout of the first and of both new ones
  Vec2 diagonal;  ///< m -> k in the layout of the new faces
};

/// A map of vectors from one planar layout to another: v -> turn v, or turn conj(v).
struct LayoutMap {
  Vec2 turn{1, 0};
  bool mirrored = false;

  Vec2 operator()(Vec2 v) const { return product(turn, mirrored ? conj(v) : v); }
  Vec2 inverse(Vec2 v) const {
    const Vec2 w = product(conj(turn), v);
    return mirrored ? conj(w) : w;
  }
};

class FlipHistory {
 public:
  explicit FlipHistory(std::size_t faces) : first_(faces, -1), last_(faces, -1) {}

  /// Appends a flip; `next` is filled in here.
  void add(Flip flip);
  /// To be called after the last flip.
  void finish() { last_ = {}; }
  std::size_t size() const { return flips_.size(); }
  std::size_t bytes() const { return flips_.size() * sizeof(Flip) + first_.size() * sizeof(std::int32_t); }

  struct Point {
    Index face;
    std::array<double, 3> weight;
    LayoutMap map;  ///< layout of the input face -> layout of the face
    Index depth;
  };
  /// A point of an input face, found in the flipped triangulation.
  Point locate(Index face, const std::array<double, 3>& weight) const;

  struct Direction {
    Half corner;     ///< half-edge at whose start the direction leaves
    Vec2 direction;  ///< in the layout of its face
    bool mirrored;
  };
  /// A direction that leaves the start of half-edge `corner` of the input mesh into its face, found in the flipped
  /// triangulation.
  Direction locate(Half corner, Vec2 direction) const;

 private:
  std::vector<Flip> flips_;
  std::vector<std::int32_t> first_;  ///< first flip that touches each input face
  std::vector<std::int32_t> last_;   ///< 2 f + b: place b of flip f made the present face; -1: input face
};

/// Half-edge arrays whose faces are laid out in the plane one by one.
class IntrinsicTriangulation {
 public:
  /// The mesh itself. `mollify` adds the least length to every edge that leaves each face a margin in the triangle inequality
  /// ([SC20] Sec. 4.5).
  IntrinsicTriangulation(const TriangleMesh& mesh, bool mollify, unsigned threads);

  /// Flips edges until all are Delaunay. Returns false when a cap on the number of flips was met.
  bool flip_to_delaunay(const Progress& progress);

  HalfEdges half_edges() const { return {tail_, twin_, mirrored_}; }
  /// Faces that the mesh dropped have no part in anything here.
  bool is_dropped(Index face) const { return !dropped_.empty() && dropped_[face]; }
  const FlipHistory& history() const { return history_; }
  /// Side h in the layout of its face, in units of the mesh.
  Vec2 side(Half h) const { return side_[h]; }
  /// The three sides of a face.
  const Vec2* sides(Index face) const { return side_.data() + 3 * static_cast<std::size_t>(face); }
  double length(Half h) const { return norm(side_[h]); }
  double area(Index face) const;
  /// Cotangent of the angle opposite side h.
  double cotangent(Half h) const;
  /// Angle of the face at the start of h.
  double angle(Half h) const;
  bool is_delaunay(Half h) const;
  /// Length added to every edge, in units of the mesh.
  double mollification() const { return mollification_; }
  /// Faces of almost no height.
  std::vector<Index> thin_faces() const;
  /// Whether the angles of all faces have a meaning: no side is so short beside its face that it has no direction.
  bool has_angles() const;
  std::size_t bytes() const;

 private:
  /// Two faces (i, j, k), (j, i, m) in one layout: sides and the diagonal m k as vectors, and the crossing as in
  /// `Flip`.
  struct Quadrilateral {
    Vec2 jk, ki, im, mj, mk, turn;
    double beta, gamma;
  };

  void mollify();
  bool opposite_coincide(Half h) const;
  Half turn_over(Half h);
  Quadrilateral unfold(Half h, Half t) const;
  void flip(Half h);

  std::vector<Index> tail_;
  std::vector<Half> twin_;
  std::vector<std::uint8_t> mirrored_;
  std::vector<Vec2> side_;
  std::vector<std::uint8_t> dropped_;
  FlipHistory history_;
  double mollification_ = 0;
};

}  // namespace ahm::trimesh
