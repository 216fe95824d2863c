/// \file
/// A source's axes carried to every vertex: the geodesic frame U of the paper, Eq. 11 and 12.
///
/// A frame is stored as a transport is: as a unit complex number (its u axis), which one column of B carries, or as an
/// orthogonal d x d matrix whose column a is source axis a, which d columns carry.
#pragma once

#include <span>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"

namespace ahm {

/// A view of U~, the solution of B for one source, that yields its normalized frames U_i = U~_i / |U~_i| (the orthogonal
/// polar factor in block graphs). A vertex whose U~_i has no length has the identity.
class FrameField {
 public:
  /// @param solution  `layout.columns()` columns of n vectors of d numbers; may be empty while only right-hand sides are made
  FrameField(Index n, TransportLayout layout, std::span<const double> solution = {});

  /// U~_i, stored as a transport is.
  void raw(Index vertex, double* out) const;
  /// Length of U~_i (its largest entry).
  double heat(Index vertex) const;
  /// out = in / U_i: components in frame i -> components in the source's frame (Eq. 12), written `stride` numbers
  /// apart.
  void to_source(Index vertex, const double* in, double* out, std::size_t stride = 1) const;
  /// U_i, stored as a transport is.
  void frame(Index vertex, double* out) const;
  /// U_i as d x d numbers, row major.
  void axes(Index vertex, double* out) const;

 private:
  void rotation(Index vertex, double* out) const;

  std::size_t n_;
  TransportLayout layout_;
  std::span<const double> solution_;
};

/// A vertex is reached when its heat is at least this share of the source's. The triangular factors hold such quotients
/// themselves, and what is below 2^-1022 there is lost: beyond this share, solutions may come from detours.
inline constexpr double min_heat_share = 0x1p-970;

/// Right-hand sides are scaled up by this much, which keeps all heat that counts far from the denormal numbers.
inline constexpr double heat_scale = 0x1p960;

}  // namespace ahm
