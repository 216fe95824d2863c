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

  /// Whether U~_i was large enough to be meaningful.
  bool valid(Index vertex) const { return valid_[static_cast<std::size_t>(vertex)] != 0; }

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
  std::vector<char> valid_;
};

/// Smallest solution of a heat equation, right-hand side at `heat_scale`, that counts as heat. Denormal numbers, which
/// lose digits, begin at 2^-1022; they would spoil the vertices up to some 40 powers of two above them.
inline constexpr double least_heat = 0x1p-970;

/// Right-hand sides are scaled up by this much, which doubles the distance at which solutions underflow.
inline constexpr double heat_scale = 0x1p960;

}  // namespace ahm
