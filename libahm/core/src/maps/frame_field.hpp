/// \file
/// A source's axes carried to every vertex: the geodesic frame U of the paper, Eq. 11 and 12.
///
/// In rotation2 graphs a frame is a unit complex number (its u axis) and one column of B carries it; in block graphs it
/// is an orthogonal d x d matrix whose column a is source axis a, and d columns carry it.
#pragma once

#include <span>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"

namespace ahm {

/// A view of U~, the solution of B for one source, that yields its normalized frames U_i = U~_i / |U~_i| (the orthogonal
/// polar factor in block graphs). A vertex whose U~_i has no length has the identity.
class FrameField {
 public:
  /// @param solution  `columns()` columns of n vectors of d numbers; may be empty while only right-hand sides are made
  FrameField(Index n, int dimension, TransportKind kind, std::span<const double> solution = {});

  /// Right-hand sides that carry one frame: 1 or d.
  Index columns() const { return complex_ ? 1 : d_; }
  /// Numbers that hold U~_i: 2 or d x d.
  std::size_t width() const { return complex_ ? 2 : static_cast<std::size_t>(d_) * d_; }

  /// U~_i: a complex number, or d x d numbers, row major.
  void raw(Index vertex, double* out) const;
  /// Length of U~_i (its largest entry).
  double heat(Index vertex) const;
  /// out = in / U_i: components in frame i -> components in the source's frame (Eq. 12), written `stride` numbers
  /// apart.
  void to_source(Index vertex, const double* in, double* out, std::size_t stride = 1) const;
  /// U_i as d x d numbers, row major.
  void axes(Index vertex, double* out) const;

 private:
  void frame(Index vertex, double* out) const;

  std::size_t n_;
  int d_;
  bool complex_;
  std::span<const double> solution_;
};

/// A vertex is reached when its heat is at least this share of the source's. The triangular factors hold such quotients
/// themselves, and what is below 2^-1022 there is lost: beyond this share, solutions may come from detours.
inline constexpr double least_share = 0x1p-970;

/// Right-hand sides are scaled up by this much, which keeps all heat that counts far from the denormal numbers.
inline constexpr double heat_scale = 0x1p960;

}  // namespace ahm
