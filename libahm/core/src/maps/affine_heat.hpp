/// \file
/// The affine heat method for a block of inflows: the steps between sources and coordinates, once for every caller.
///
/// The paper's 3n x 3n systems are block triangular in the homogeneous coordinate lambda; eliminating it leaves solves
/// with the two fixed operators A and B (docs/method.md):
///
///     lambda = A^-1 b                                   b: source weights
///     U~     = B^-1 (b U_p),  U_i = U~_i / |U~_i|
///     rho_i  = -tau sum_j w_ij e_ij lambda_j            in frame i
///     adaptive:   x = A^-1 (rho / U + b z),   phi = x / lambda
///     localized:  Y = B^-1 (rho + b U z),     phi = (Y / lambda) / U
#pragma once

#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/log_map.hpp"
#include "maps/frame_field.hpp"
#include "maps/inflow.hpp"

namespace ahm {

class AffineHeat {
 public:
  /// The numbers do not depend on `threads`.
  AffineHeat(const TangentGraph& graph, const HeatOperators& operators, std::vector<Inflow> inflows,
             unsigned threads = 1);

  /// Solves for lambda and the frames, which everything below needs.
  void diffuse();
  /// Solves for lambda alone: enough for `localized`.
  void diffuse_heat();

  /// x of every source: columns of n numbers, d per source. In units of `solution_unit(graph)`.
  std::vector<double> adaptive() const;
  /// Y of every source: columns of n vectors of d numbers. In units of `solution_unit(graph)`.
  std::vector<double> localized() const;
  std::vector<double> solve(Variant variant) const { return variant == Variant::adaptive ? adaptive() : localized(); }
  /// x_i or Y_i of one source, from its part of `solve`.
  void solution_at(Variant variant, std::span<const double> solution, Index vertex, double* out) const;
  /// phi_i of one source in world units, from its part of `solve`: x / lambda, or (Y / lambda) / U.
  void coordinates_at(Variant variant, std::size_t source, std::span<const double> solution, Index vertex,
                      double* phi) const;

  /// Whether enough heat reached the vertex, by both operators, for its numbers to be right.
  bool reached(std::size_t source, Index vertex) const {
    return lambda(source)[vertex] >= least_heat_[source] && frames(source).heat(vertex) >= least_heat_[source];
  }
  /// The heat that counts: `least_share` of the source's.
  double least_heat(std::size_t source) const { return least_heat_[source]; }
  std::span<const double> lambda(std::size_t source) const { return std::span(lambda_).subspan(source * n_, n_); }
  FrameField frames(std::size_t source) const;
  /// For each vertex, whether its component holds a source sample.
  std::vector<bool> connected(std::size_t source) const;

 private:
  void diffuse_frames();
  std::vector<double> translations() const;
  std::size_t frame_size() const { return static_cast<std::size_t>(frames_.columns()) * n_ * d_; }

  const TangentGraph& graph_;
  const HeatOperators& operators_;
  std::vector<Inflow> inflows_;
  std::size_t n_, d_;
  FrameField frames_;  ///< of no source: the shape alone
  unsigned threads_;
  std::vector<double> lambda_;          ///< n per source
  std::vector<double> least_heat_;      ///< one per source
  std::vector<double> frame_solution_;  ///< U~, frame_size() per source
};

}  // namespace ahm
