/// \file
/// What a march has found behind its front, and how it enters the next band: as Dirichlet data.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "maps/affine_heat.hpp"

namespace ahm {

/// Powers of two that a solve's numbers are to be multiplied by.
struct HeatExponents {
  std::int32_t heat = 0;   ///< of lambda, the variant's unknown and its second moment
  std::int32_t frame = 0;  ///< of U~
};

/// lambda, U~, the variant's unknown and its second moment of every vertex, as mantissas with exponents of their own: nothing underflows at
/// any distance.
class KnownValues {
 public:
  KnownValues(const TangentGraph& graph, const VariantSystem& system);

  /// Takes over what vertex `place` of a solve found for `vertex`.
  void take(Index vertex, Index place, const AffineHeat& heat, std::size_t source, HeatExponents exponents);

  double heat(Index vertex) const { return lambda_[vertex]; }
  /// -log lambda
  double level(Index vertex) const;
  /// U_i as d x d numbers, row major.
  void axes(Index vertex, double* out) const;

  /// The exponents that bring the largest value of these vertices to `heat_scale`.
  HeatExponents exponents_for(std::span<const Index> vertices) const;
  /// Adds to the last entry of `in` what vertex j = star.neighbors[edge] gives to the right-hand sides of the star's own
  /// vertex: A gets tau w_ij lambda_j, B gets tau w_ij R_ji U~_j, and so on for the other systems.
  void add_to(Inflow& in, const Star& star, std::size_t edge, double conductance, HeatExponents exponents) const;

 private:
  std::span<const double> value(Index vertex) const { return std::span(value_).subspan(vertex * d_, d_); }
  std::span<const double> frame(Index vertex) const { return std::span(frame_).subspan(vertex * width_, width_); }

  const VariantSystem& system_;
  TransportLayout layout_;
  std::size_t d_, width_;
  double to_units_;  ///< from the graph's lengths to those of the solution
  std::vector<double> lambda_, value_, square_, frame_;
  std::vector<HeatExponents> exponents_;
};

}  // namespace ahm
