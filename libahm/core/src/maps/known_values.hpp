/// \file
/// What a march has found behind its front, and how it enters the next band: as Dirichlet data.
#pragma once

#include <cstdint>
#include <span>

#include "ahm/graph/tangent_graph.hpp"
#include "maps/affine_heat.hpp"
#include "maps/reached_rows.hpp"

namespace ahm {

/// Powers of two that a solve's numbers are to be multiplied by.
struct HeatExponents {
  std::int32_t heat = 0;   ///< of lambda, the variant's unknown and its second moments
  std::int32_t frame = 0;  ///< of U~
};

/// lambda, U~, the variant's unknown and its second moments of vertices, as mantissas with exponents of their own: nothing
/// underflows at any distance. Vertices go by the numbers of `ReachedNumbers`.
class KnownValues {
 public:
  /// @param with_frames  else of solves without frames
  KnownValues(const TangentGraph& graph, const VariantSystem& system, bool with_frames);

  /// Takes over the heat that a solve found at a vertex.
  void take_heat(Index number, double lambda, std::int32_t exponent);
  /// Takes over all else that vertex `place` of a solve found. Others may ask for heat meanwhile.
  void take_values(Index number, Index place, const AffineHeat& heat, std::size_t source, std::int32_t frame_exponent);

  /// All that is known of a vertex but its exponents.
  std::span<const double> row(Index number) const { return {rows_[number], row_width()}; }
  HeatExponents exponents(Index number) const { return *exponents_[number]; }
  std::size_t row_width() const { return 3 + 2 * d_ + width_; }
  void put(Index number, std::span<const double> row, HeatExponents exponents);

  double heat(Index number) const { return *rows_[number]; }
  std::size_t bytes() const { return rows_.bytes() + exponents_.bytes(); }
  /// -log lambda
  double level(Index number) const;
  /// U_i as d x d numbers, row major.
  void axes(Index number, double* out) const;

  /// The exponents that bring the largest of these values to `heat_scale`; of none, less than any other.
  std::int32_t heat_exponent_for(std::span<const Index> numbers) const;
  std::int32_t frame_exponent_for(std::span<const Index> numbers) const;
  /// What a vertex gives to the right-hand side of A at a neighbour: tau w_ij lambda_j.
  double heat_along(Index number, double conductance, std::int32_t exponent) const;
  /// Adds to the last entry of `in` all else that vertex j = star.neighbors[edge], of this number, gives to the right-hand
  /// sides of the star's own vertex: B gets tau w_ij R_ji U~_j, and so on for the other systems.
  void add_to(RightHandSide& in, const Star& star, std::size_t edge, Index number, double conductance,
              HeatExponents exponents) const;

 private:
  double square(Index number) const { return rows_[number][1]; }
  double squared_length(Index number) const { return rows_[number][2]; }
  std::span<const double> value(Index number) const { return {rows_[number] + 3, d_}; }
  std::span<const double> radial(Index number) const { return {rows_[number] + 3 + d_, d_}; }
  std::span<const double> frame(Index number) const { return {rows_[number] + 3 + 2 * d_, width_}; }

  const VariantSystem& system_;
  TransportLayout layout_;
  std::size_t d_, width_;     ///< width of frames, 0 without them
  double to_units_;           ///< from the graph's lengths to those of the solution
  GrowingRows<double> rows_;  ///< lambda, both second moments, the unknown, r, U~
  GrowingRows<HeatExponents> exponents_;
};

}  // namespace ahm
