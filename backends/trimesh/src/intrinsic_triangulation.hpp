/// \file
/// A triangulation with edge flips, their history, and the search for points and directions of the input mesh in it.
///
/// A flip replaces two faces by two new ones at the same places of the arrays. The flips therefore form a directed acyclic
/// graph, as in incremental Delaunay triangulation. A point with barycentric coordinates in an input face descends through this
/// graph. At each flip that touches its face, one sign decides on which side of the new diagonal it lies, and its coordinates
/// are updated by additions and multiplications of nonnegative numbers.
///
/// Nothing is traced along the surface, and no angles are summed around vertices. A point near a diagonal may end on either
/// side of it, but always at the correct position. The error of one step is a rounding error relative to the size of the
/// quadrilateral, also for needles and caps.
/// The intrinsic triangulation is flipped to the intrinsic Delaunay triangulation [BS07, SGC21].
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ahm/progress.hpp"
#include "ahm/surface/detail/half_edges.hpp"
#include "ahm/trimesh/triangle_mesh.hpp"
#include "planar.hpp"

namespace ahm::trimesh {

using detail::Corner;
using detail::HalfEdges;
using detail::next;
using detail::previous;

/// A flip: faces (i, j, k) and (j, i, m) on both sides of edge ij are replaced by (m, k, i) and (k, m, j).
///
/// The diagonals cross at alpha i + beta j = gamma k + delta m, alpha + beta = gamma + delta = 1.
struct Flip {
  std::array<Index, 2> face;         ///< places of the two faces in the arrays
  std::array<std::int32_t, 2> next;  ///< next flip that touches each of these places, -1: none
  std::array<std::uint8_t, 2> side;  ///< side ij of the first face, ji of the second; then mk and km
  bool mirrored;                     ///< whether the second face was turned over before
  double beta, gamma;
  Vec2 turn;  ///< rotation: layout of the second face (after turning over) -> layout of the first and of both new faces
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

/// The record of all flips, which finds points and directions of the input mesh in the flipped triangulation.
class FlipHistory {
 public:
  explicit FlipHistory(std::size_t faces) : first_(faces, -1), last_(faces, -1) {}

  /// Appends a flip and fills in its `next`.
  void add(Flip flip);
  /// Must be called after the last flip.
  void finish() { last_ = {}; }
  std::size_t size() const { return flips_.size(); }
  std::size_t bytes() const { return flips_.size() * sizeof(Flip) + first_.size() * sizeof(std::int32_t); }

  /// A point in the flipped triangulation.
  struct Point {
    Index face;
    std::array<double, 3> weight;  ///< barycentric coordinates in the face
    LayoutMap map;                 ///< layout of the input face -> layout of the face
    Index depth;                   ///< number of flips on the descent
  };
  /// Finds a point of an input face in the flipped triangulation.
  Point locate(Index face, const std::array<double, 3>& weight) const;

  /// A direction at a corner of the flipped triangulation.
  struct Direction {
    Half corner;     ///< half-edge that starts at the corner
    Vec2 direction;  ///< vector in the layout of the corner's face
    bool mirrored;   ///< whether the layout of this face is mirrored relative to that of the input face
  };
  /// Finds, in the flipped triangulation, a direction that leaves the start of half-edge `corner` of the input mesh into its
  /// face.
  Direction locate(Half corner, Vec2 direction) const;

 private:
  std::vector<Flip> flips_;
  std::vector<std::int32_t> first_;  ///< first flip that touches each input face
  std::vector<std::int32_t> last_;   ///< 2 f + b: the current face is place b of flip f; -1: it is an input face
};

/// Half-edge arrays of a triangulation. Each face has its own layout in the plane.
class IntrinsicTriangulation {
 public:
  /// Copies the mesh. `mollify` adds to every edge the least length that gives each face a margin in the triangle inequality
  /// ([SC20] Sec. 4.5).
  IntrinsicTriangulation(const TriangleMesh& mesh, bool mollify, unsigned threads);

  /// Flips edges until all are Delaunay.
  /// @return false if the limit on the number of flips was reached
  bool flip_to_delaunay(unsigned threads, const Progress& progress);

  HalfEdges half_edges() const { return {tail_, twin_, mirrored_}; }
  /// Whether the mesh dropped a face. All functions here ignore such faces.
  bool is_dropped(Index face) const { return !dropped_.empty() && dropped_[face]; }
  const FlipHistory& history() const { return history_; }
  /// Side h as a vector in the layout of its face, in units of the mesh.
  Vec2 side(Half h) const { return side_[h]; }
  /// The three sides of a face as vectors in its layout.
  const Vec2* sides(Index face) const { return side_.data() + 3 * static_cast<std::size_t>(face); }
  double length(Half h) const { return norm(side_[h]); }
  double area(Index face) const;
  /// Cotangent of the angle opposite side h.
  double cotangent(Half h) const;
  /// Angle of the face of h at the start of h.
  double angle(Half h) const;
  bool is_delaunay(Half h) const;
  /// Length added to every edge, in units of the mesh.
  double mollification() const { return mollification_; }
  /// Faces with almost no height.
  std::vector<Index> thin_faces() const;
  /// Whether the angles of all faces are defined: no side is so short, relative to its face, that it has no direction.
  bool has_angles() const;
  std::size_t bytes() const;

 private:
  /// Two faces (i, j, k), (j, i, m) in one layout: sides and diagonal m k as vectors, and the crossing as in `Flip`.
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
