/// \file
/// A triangulation of a mesh's own metric, flipped to the intrinsic Delaunay triangulation [BS07, SGC21].
#pragma once

#include <array>
#include <vector>

#include "ahm/progress.hpp"
#include "flip_history.hpp"
#include "planar.hpp"

namespace ahm::trimesh {

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
