/// \file
/// The affine heat method for a block of sources: METHOD steps between sources and coordinates, once for every caller.
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

#include "ahm/heat_operators.hpp"
#include "ahm/source.hpp"
#include "ahm/tangent_graph.hpp"
#include "frame_field.hpp"

namespace ahm {

/// @throws InvalidArgument when the source does not fit the graph
void check_source(const Source& source, const TangentGraph& graph);

/// The right-hand side that stands for a weight of 1 at these vertices: `heat_scale`, less where a tiny mass would make
/// the solution overflow.
double source_heat(const TangentGraph& graph, const HeatOperators& operators, std::span<const Index> vertices);

class AffineHeat {
 public:
  /// Sources must have been checked. The numbers do not depend on `threads`.
  AffineHeat(const TangentGraph& graph, const HeatOperators& operators, std::span<const Source> sources,
             unsigned threads = 1);

  /// Solves for lambda and the frames, which everything below needs.
  void diffuse();
  /// Solves for lambda alone: enough for `localized`.
  void diffuse_heat();

  /// x of every source: columns of n numbers, d per source. Multiply by `length_unit()`.
  std::vector<double> adaptive() const;
  /// Y of every source: columns of n vectors of d numbers. Multiply by `length_unit()`.
  std::vector<double> localized() const;
  /// The outside length of 1 in x and Y: a power of two near the mean edge length, times the graph's own unit. It keeps
  /// x and Y in the range of lambda, which is used up to both ends.
  double length_unit() const;

  /// Whether enough heat reached the vertex, by both operators, for its numbers to be right.
  bool reached(std::size_t source, Index vertex) const {
    return lambda(source)[static_cast<std::size_t>(vertex)] >= least_heat_[source] &&
           frames_[source].heat(vertex) >= least_heat_[source];
  }
  /// The heat that counts: `least_share` of the source's.
  double least_heat(std::size_t source) const { return least_heat_[source]; }
  std::span<const double> lambda(std::size_t source) const { return std::span(lambda_).subspan(source * n_, n_); }
  const FrameField& frames(std::size_t source) const { return frames_[source]; }
  /// For each vertex, whether its component holds a source sample.
  std::vector<bool> connected(std::size_t source) const;

 private:
  void diffuse_frames();
  std::vector<double> translations() const;
  template <class Visit>
  void for_each_sample(std::size_t source, const Visit& visit) const;

  const TangentGraph& graph_;
  const HeatOperators& operators_;
  std::span<const Source> sources_;
  std::size_t n_, d_;
  unsigned threads_;
  std::vector<double> lambda_;      ///< n per source
  std::vector<double> least_heat_;  ///< one per source
  std::vector<FrameField> frames_;  ///< one per source
};

}  // namespace ahm
