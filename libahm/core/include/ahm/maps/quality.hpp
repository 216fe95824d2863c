/// \file
/// Where a log map can be trusted.
///
/// \code
/// ahm::LogMap map = solver.solve(source);
/// std::vector<double> q = ahm::map_quality(graph, map);
/// if (q[i] < ahm::trusted_quality) ...                          // near a cut locus, behind a hole, or too coarse
/// \endcode
#pragma once

#include <limits>
#include <optional>
#include <stop_token>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/unfolding_front.hpp"

namespace ahm {

/// Vertices of a lower quality have, as a rule, a vector that is wrong by more than a tenth of its length.
inline constexpr double trusted_quality = 0.5;

/// How far the vector phi can be trusted: by the spread of the ways that heat took, and by how well it agrees with the vector
/// psi of geodesic polar coordinates, distance and direction of an `UnfoldingFront`.
///
///     s_i = | (spread_i / 0.3, |phi_i - psi_i| / 0.1) | / max(d_i, h_i)
///     c_i^2 = min(1 - sum_j |phi_j - phi_i|^2 / sum_j |e_ij|^2,
///                 sum_j |(phi_j - phi_i) - (psi_j - psi_i)|^2 / sum_j max(|e_ij|, |psi_j - psi_i|)^2),  at least 0
///     q_i = 1 / (1 + s_i^2 + (c_i / 0.5)^2)
///
/// with d the distance, no less than the straight line in space where the graph has frames, h the mean edge length of the
/// vertex's component, and h_i that or the mean length of its own edges, whichever is less. |phi - psi| is no less than ||phi| - d|, and comes to that alone as spread_i / d_i goes from 0.01 to 0: there
/// phi is the unrolling of what lies between, as of a plane behind its holes. It is that alone,
/// too, in other dimensions than 2, where fronts see holes if edges lie along orthogonal axes. c is how much of the edges phi loses
/// that psi keeps: far away on a tube |phi - psi| is small beside d, but what lies around the tube has come to lie on a line. Of a
/// map by `Method::exact` there is the spread alone. Where the edges are no Delaunay triangulation a front is less exact: h is
/// forgiven, and of c the first .2 (then (c - .2) / .8); it counts only where stars agree on their triangles, which noise
/// undoes (`UnfoldingFront::agreement`), and elsewhere there is ||phi| - d| with the distance of heat, which sees no holes; and
/// where more than a twentieth to a tenth of the stars are open, directions are not asked for of ways that bend at the boundary, at
/// such stars, by half a radian and more (nor is c).
///
/// From a curve (d = 2) phi and psi count from the coordinates of the sample nearest to the vertex. c is 0, since psi jumps from
/// sample to sample, and h / 4 is forgiven on Delaunay triangulations: samples are half an edge apart.
///
/// It is 1 on flat convex geometry, falls with h on smooth surfaces, and is low across a cut locus, where bumps turn directions,
/// where features are coarser than edges, and behind holes: where the surface is curved, and where the way around is longer by a
/// tenth and more; heat knows the straight line only. Against exact vectors in docs/accuracy.md.
/// @param threads  0: one per core
/// @return n numbers in (0, 1]; NaN where the map is not ok
/// @throws InvalidArgument when the map belongs to another graph, was made without its spread, or is from a curve and d is not 2
std::vector<double> map_quality(const TangentGraph& graph, const LogMap& map, unsigned threads = 0);

/// The front that `map_quality` compares a map of heat with, where the edges are no Delaunay triangulation: most of its work, and
/// nothing that it must know the map for, so that it can be done on a core that the map leaves idle.
class QualityFront {
 public:
  /// @param radius  of the map
  /// @throws Cancelled
  QualityFront(const TangentGraph& graph, const Source& source, double radius = std::numeric_limits<double>::infinity(),
               const std::stop_token& stop = {});
  /// Null on Delaunay triangulations, whose maps have a front of their own.
  const UnfoldingFront* get() const noexcept { return front_ ? &*front_ : nullptr; }

 private:
  std::optional<UnfoldingFront> front_;
};

/// A quality, and how much it tells of.
struct ComparedQuality {
  std::vector<double> quality;
  /// At what share of the mapped vertices it is one of directions, and not of distances alone: 1 on triangulations, less where noise,
  /// clumps or too few neighbours open many stars, behind which ways count as bent, or leave them in disagreement on their triangles.
  double directions_compared = 1;
};

/// The same quality. @param front  from the source of the map, with its radius
ComparedQuality map_quality(const TangentGraph& graph, const LogMap& map, const QualityFront& front,
                            unsigned threads = 0);

}  // namespace ahm
