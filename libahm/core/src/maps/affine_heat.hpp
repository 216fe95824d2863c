/// \file
/// The affine heat method for a block of right-hand sides: the steps between sources and coordinates, once for every caller.
///
/// The paper's 3n x 3n systems are block triangular in the homogeneous coordinate lambda; eliminating it leaves solves
/// with the two fixed operators A and B (docs/concepts/method.md):
///
///     lambda = A^-1 b                                   b: source weights
///     U~     = B^-1 (b U_p),  U_i = U~_i / |U~_i|
///     rho_i  = -tau sum_j w_ij e_ij lambda_j            in frame i
///
/// and then the variant's own system (maps/variants): adaptive, x = A^-1 (rho / U + b z); localized, Y = B^-1 (rho + b U z).
///
/// Isometries of the plane are linear on (|z|^2, z, 1) too, so that the mean square of what heat brings to a vertex costs
/// one more solve:
///
///     s_i = -tau sum_j w_ij (2 <e_ij, z_j> - |e_ij|^2 lambda_j),   q = A^-1 (s + b |z|^2)
///
/// with z_j = x_j (adaptive) or Y_j (localized) seen from i. Where heat comes along several ways their vectors cancel in
/// phi, but their squares do not in q / lambda: its root is a distance that holds at cut loci, and q / lambda - |phi|^2 >= 0
/// is the variance of the map.
///
/// On curved surfaces z is too long or too short. The second moment of distances takes of it the direction alone, carried from
/// frame to frame, and the length from q itself, where the direction is that of one way:
///
///     r_j = d_j lambda_j z_j / |z_j|,  d_j by q_j (`heat_distance`);   p = A^-1 (s(r) + b |z|^2)
///
/// Its root is the distance.
#pragma once

#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/log_map.hpp"
#include "maps/frame_field.hpp"
#include "maps/right_hand_side.hpp"
#include "maps/variants/variant_system.hpp"

namespace ahm {

class AffineHeat {
 public:
  /// The numbers do not depend on `threads`.
  AffineHeat(const TangentGraph& graph, const HeatOperators& operators, Variant variant,
             std::vector<RightHandSide> right_hand_sides, unsigned threads = 1);

  /// Solves for lambda and the frames, which everything below needs.
  void diffuse();
  /// Solves for lambda alone: enough for variants that put no frames into their system, but for `frames` and `coordinates_at`.
  void diffuse_heat();
  /// Solves for the frames alone.
  void diffuse_frames();
  /// Of one source: all but vertices and heat may be given after `diffuse_heat`.
  RightHandSide& right_hand_side(std::size_t source) { return rhs_[source]; }

  /// Solves for the variant's unknown, in units of `solution_unit(graph)`.
  void solve();
  /// Solves for the second moments q, after `solve`.
  void solve_squares();
  /// Solves for the second moments p of distances, after `solve_squares`.
  void solve_lengths();
  bool has_squares() const { return !squares_.empty(); }
  bool has_lengths() const { return !lengths_.empty(); }
  /// The unknown of one source: n x d numbers, laid out as its system wants them.
  std::span<const double> unknown(std::size_t source) const {
    return std::span(unknown_).subspan(source * n_ * d_, n_ * d_);
  }
  /// The unknown of one source at a vertex: d numbers.
  void unknown_at(std::size_t source, Index vertex, double* out) const;
  /// q of one source at a vertex.
  double square_at(std::size_t source, Index vertex) const {
    return squares_[source * n_ + static_cast<std::size_t>(vertex)];
  }
  /// p of one source at a vertex.
  double length_at(std::size_t source, Index vertex) const {
    return lengths_[source * n_ + static_cast<std::size_t>(vertex)];
  }
  /// sqrt(q_i / lambda_i) of one source in world units; 0 without `solve_squares`.
  double root_mean_square_at(std::size_t source, Index vertex) const;
  /// `heat_distance` of one source in world units; 0 without `solve_lengths`.
  double distance_at(std::size_t source, Index vertex) const;
  /// r of one source at a vertex: d numbers in its frame, units of the unknown.
  void radial_at(std::size_t source, Index vertex, double* out) const;
  /// z_i of one source in the frame of the vertex, world units: as long as phi_i.
  void displacement_at(std::size_t source, Index vertex, double* out) const;
  /// phi_i of one source in world units.
  void coordinates_at(std::size_t source, Index vertex, double* phi) const;

  /// Whether enough heat reached the vertex, by both operators, for its numbers to be right.
  bool reached(std::size_t source, Index vertex) const {
    return lambda(source)[vertex] >= least_heat_[source] && frames(source).heat(vertex) >= least_heat_[source];
  }
  /// The heat that counts: `least_share` of the source's.
  double least_heat(std::size_t source) const { return least_heat_[source]; }
  std::span<const double> lambda(std::size_t source) const { return std::span(lambda_).subspan(source * n_, n_); }
  FrameField frames(std::size_t source) const;

 private:
  std::vector<double> translations() const;
  double distance_by(std::size_t source, Index vertex, double second_moment) const;
  std::size_t frame_size() const { return static_cast<std::size_t>(layout_.columns()) * n_ * d_; }

  const TangentGraph& graph_;
  const HeatOperators& operators_;
  const VariantSystem& system_;
  std::vector<RightHandSide> rhs_;
  std::size_t n_, d_;
  TransportLayout layout_;
  UnknownLayout place_;
  unsigned threads_;
  std::vector<double> lambda_;          ///< n per source
  std::vector<double> least_heat_;      ///< one per source
  std::vector<double> frame_solution_;  ///< U~, frame_size() per source
  std::vector<double> unknown_;         ///< n x d per source
  std::vector<double> squares_;         ///< n per source
  std::vector<double> lengths_;         ///< n per source
};

}  // namespace ahm
