/// \file
/// A source's axes carried to every vertex: the geodesic frame U of the paper, Eq. 11 and 12.
///
/// In rotation2 graphs a frame is a unit complex number (its u axis) and one column of B carries it; in block graphs it
/// is an orthogonal d x d matrix whose column a is source axis a, and d columns carry it.
#pragma once

#include <span>
#include <vector>

#include "ahm/source.hpp"
#include "ahm/tangent_graph.hpp"

namespace ahm {

class FrameField {
 public:
  FrameField(Index n, int dimension, TransportKind kind);

  /// Right-hand sides that carry one frame: 1 or d.
  Index columns() const { return complex_ ? 1 : d_; }

  /// Adds U_k `scale` at vertex k to right-hand sides of `columns()` columns of n x d numbers.
  /// @param axes  d x d, row major; empty: identity
  void add_to_rhs(std::span<double> rhs, Index vertex, std::span<const double> axes, double scale) const;

  /// Takes the solution of B for these right-hand sides: U_i = U~_i / |U~_i|, the orthogonal polar factor in block
  /// graphs. A vertex whose U~_i has no length gets the identity.
  void normalize(std::span<const double> solution, unsigned threads);

  /// Length of U~_i before it was normalized (its largest entry).
  double heat(Index vertex) const { return heat_[static_cast<std::size_t>(vertex)]; }

  /// out = in / U_i: components in frame i -> components in the source's frame (Eq. 12), written `stride` numbers
  /// apart.
  void to_source(Index vertex, const double* in, double* out, std::size_t stride = 1) const;

  /// U_i as d x d numbers, row major.
  void axes(Index vertex, double* out) const;

 private:
  Index n_;
  int d_;
  bool complex_;
  std::vector<double> frames_;  ///< n x 2 or n x d x d (row major)
  std::vector<double> heat_;
};

/// A vertex is reached when its heat is at least this share of the source's. The triangular factors hold such quotients
/// themselves, and what is below 2^-1022 there is lost: beyond this share, solutions may come from detours.
inline constexpr double least_share = 0x1p-970;

/// Right-hand sides are scaled up by this much, which keeps all heat that counts far from the denormal numbers.
inline constexpr double heat_scale = 0x1p960;

}  // namespace ahm
