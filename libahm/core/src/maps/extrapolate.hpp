/// \file
/// Second order: maps of several diffusion times, extrapolated to time zero (docs/concepts/accuracy.md).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "heat/component_scales.hpp"

namespace ahm {

/// The second of three diffusion times of order 2, by t_coef: c = n^(1/d) / 50, but 1.5 at least, for n vertices in dimension d; 1
/// where c is less than 1: there are two.
double middle_time(double vertices, int dimension);

/// The diffusion times of one order as factors of t_coef, per component: {1}, {1, 2}, or {1, c, 2c}. Longer times shrink the error
/// that comes from the mesh's directions, ~ 1/c, and extrapolation removes the one in sqrt(tau) that grows with them.
class DiffusionTimes {
 public:
  /// @param sizes  vertices of each component
  DiffusionTimes(int order, int dimension, std::span<const Index> sizes);

  /// How many solves: 1; or 3, or 2 where c = 1 everywhere.
  std::size_t count() const { return count_; }
  /// Time number k of a component.
  double factor(std::size_t k, Index component) const;
  double middle(Index component) const { return middle_[component]; }
  /// How far the march of each time goes, world units, where the extrapolated map goes as far as `radius`: maps of different times
  /// differ a little there.
  /// @param edge_lengths  mean ones of all components, in units of `unit`
  double radius_of_each(double radius, std::span<const double> edge_lengths, double unit) const;

 private:
  std::size_t count_;
  std::vector<double> middle_;  ///< c
};

/// What the map of one time says of a vertex, world units.
struct TimedRow {
  Status status;
  std::span<const double> phi;
  double distance;
  double spread;  ///< 0 where it is not known
};

/// What the maps of all times say together; NaN where not ok.
struct ExtrapolatedRow {
  Status status;
  double distance, error;
};

/// The scales of a vertex.
struct ExtrapolationScales {
  double t_coef;
  double middle;  ///< c of `DiffusionTimes`
  double h;       ///< mean edge length of its component, world units
};

/// How the distances of a source are found.
struct DistanceKind {
  bool unfolded;  ///< the same at all times
  bool of_curve;
};

/// Ways along edges that are this many times as long as the distance at the shortest time might as well be infinite.
inline constexpr double longest_way = 1.15;

/// One vertex: see below.
/// @param rows  of the first, the middle and the last time; where these are two, the first twice
/// @param path  length of the shortest way along edges; of unfolded distances it means nothing
/// @param phi   d numbers, for the coordinates
ExtrapolatedRow extrapolate_row(const std::array<TimedRow, 3>& rows, const ExtrapolationScales& scales,
                                DistanceKind kind, double path, double radius, std::span<double> phi);

/// Coordinates extrapolated vertex by vertex from the maps of one source at these times; distances of heat alike, with
/// w_d in place of w.
///
///     phi* = phi(c) + (phi(c) - phi(2c)) / (sqrt 2 - 1)
///     a    = |phi(2c) - phi(c)| / (sqrt(tau_2c) - sqrt(tau_c))
///     b    = |phi* - phi*(1, c)| / |phi* - phi(1)|,   s = spread(2c) / max(d, h)
///     w    = max( clamp((a - 3)/2, 0, 1),  min( clamp((b - .4)/.4, 0, 1), clamp((s - .1)/.1, 0, 1) ) )    b = 0 with two times
///     phi  = (1 - w) phi* + w phi(1)
///     w_d  = max( clamp((a - 3)/2, 0, 1), clamp((e - .02)/.02, 0, 1), clamp((g - .1)/.15, 0, 1), clamp((l/d(1) - 1.1)/.05, 0, 1),
///                 clamp((b_d - .25)/.25, 0, 1) )
///
/// with e = |d* - d(1)| / d(1), g = |spread(2c)^2 / (sqrt(2c) spread(1)^2) - 1|, l the shortest way along edges and b_d the b
/// of distances (0 with two times).
///
/// No distance is made longer than the shortest way along edges, and phi no longer than its distance, if the shortest time
/// did not make them so already: there phi is as near to phi* as it may be on the line to phi(1). (Not from curves, where
/// |phi| is no distance.)
///
/// a is about 1 where phi is smooth in sqrt(tau), and g small where the variance of the ways of heat is linear in it; where it is not (cut loci, and with three times beside them), the shortest
/// time is kept. A vertex that
/// lacks coordinates at any of the times keeps that status.
/// @param with_distances, with_spread  whether the result has them; the maps have distances, and those of heat need the spread of
/// the first and the last map all the same
LogMap extrapolate(const TangentGraph& graph, const ComponentScales& scales, double t_coef, const DiffusionTimes& times,
                   const std::vector<const LogMap*>& maps, double radius, bool with_distances, bool with_spread);

}  // namespace ahm
