/// \file
/// The affine heat method for a block of inflows: the steps between sources and coordinates, once for every caller.
///
/// The paper's 3n x 3n systems are block triangular in the homogeneous coordinate lambda; eliminating it leaves solves
/// with the two fixed operators A and B (docs/method.md):
///
///     lambda = A^-1 b                                   b: source weights
///     U~     = B^-1 (b U_p),  U_i = U~_i / |U~_i|
///     rho_i  = -tau sum_j w_ij e_ij lambda_j            in frame i
///
/// and then the variant's own system (maps/variants): adaptive, x = A^-1 (rho / U + b z); localized, Y = B^-1 (rho + b U z).
#pragma once

#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/log_map.hpp"
#include "maps/frame_field.hpp"
#include "maps/inflow.hpp"
#include "maps/variants/variant_system.hpp"

namespace ahm {

class AffineHeat {
 public:
  /// The numbers do not depend on `threads`.
  AffineHeat(const TangentGraph& graph, const HeatOperators& operators, Variant variant, std::vector<Inflow> inflows,
             unsigned threads = 1);

  /// Solves for lambda and the frames, which everything below needs.
  void diffuse();
  /// Solves for lambda alone: enough for variants that put no frames into their system.
  void diffuse_heat();

  /// The variant's unknown for every source, n x d numbers each, in units of `solution_unit(graph)`.
  std::vector<double> solve() const;
  /// The unknown of one source at a vertex, from its part of `solve`: d numbers.
  void solution_at(std::span<const double> solution, Index vertex, double* out) const;
  /// phi_i of one source in world units, from its part of `solve`.
  void coordinates_at(std::size_t source, std::span<const double> solution, Index vertex, double* phi) const;

  /// Whether enough heat reached the vertex, by both operators, for its numbers to be right.
  bool reached(std::size_t source, Index vertex) const {
    return lambda(source)[vertex] >= least_heat_[source] && frames(source).heat(vertex) >= least_heat_[source];
  }
  /// The heat that counts: `least_share` of the source's.
  double least_heat(std::size_t source) const { return least_heat_[source]; }
  std::span<const double> lambda(std::size_t source) const { return std::span(lambda_).subspan(source * n_, n_); }
  FrameField frames(std::size_t source) const;

 private:
  void diffuse_frames();
  std::vector<double> translations() const;
  std::size_t frame_size() const { return static_cast<std::size_t>(layout_.columns()) * n_ * d_; }

  const TangentGraph& graph_;
  const HeatOperators& operators_;
  const VariantSystem& system_;
  std::vector<Inflow> inflows_;
  std::size_t n_, d_;
  TransportLayout layout_;
  unsigned threads_;
  std::vector<double> lambda_;          ///< n per source
  std::vector<double> least_heat_;      ///< one per source
  std::vector<double> frame_solution_;  ///< U~, frame_size() per source
};

}  // namespace ahm
