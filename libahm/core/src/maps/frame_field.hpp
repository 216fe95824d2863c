/// \file
/// The source's axes, parallel transported to every vertex: the geodesic frame U of the paper, Eq. 11 and 12.
///
/// A frame is stored like a transport: as a unit complex number (its u axis), which takes one column of B, or as an orthogonal d x d matrix
/// whose column a is source axis a, which takes d columns.
#pragma once

#include <span>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"

namespace ahm {

/// A view of U~, the solution with B for one source. It returns the normalized frames U_i = U~_i / |U~_i| (in block graphs the orthogonal
/// polar factor), or the identity at a vertex where U~_i is zero.
class FrameField {
 public:
  /// @param solution  `layout.columns()` columns of n vectors of d numbers; may be empty if no frame is read
  FrameField(Index n, TransportLayout layout, std::span<const double> solution = {});

  /// U~_i, stored like a transport.
  void raw(Index vertex, double* out) const;
  /// Largest absolute entry of U~_i.
  double heat(Index vertex) const;
  /// out = in / U_i: components in frame i -> components in the source's frame (Eq. 12), written `stride` numbers
  /// apart.
  void to_source(Index vertex, const double* in, double* out, std::size_t stride = 1) const;
  /// U_i, stored like a transport.
  void frame(Index vertex, double* out) const;
  /// U_i as d x d numbers, row major.
  void axes(Index vertex, double* out) const;

 private:
  void rotation(Index vertex, double* out) const;

  std::size_t n_;
  TransportLayout layout_;
  std::span<const double> solution_;
};

/// A vertex is reached if its heat is at least this share of the source's. The triangular factors contain such quotients, too, and entries
/// below 2^-1022 underflow. A smaller heat may therefore have arrived along a detour.
inline constexpr double min_heat_share = 0x1p-970;

/// Right-hand sides are scaled by this factor. It keeps the heat of reached vertices far from the subnormal numbers.
inline constexpr double heat_scale = 0x1p960;

}  // namespace ahm
