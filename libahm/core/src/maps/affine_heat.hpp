/// \file
/// The right-hand sides of a source and the solves of the affine heat method.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/source.hpp"
#include "maps/frame_field.hpp"
#include "maps/variants/variant_system.hpp"

namespace ahm {

/// Exact distances and vectors of the source's vertices, relative to the nearest source point. They are more accurate than those by heat,
/// which spreads a point over its neighbors. Curves have distances only, because their coordinates are not vectors to a point.
class SourceVertices {
 public:
  struct ExactValue {
    double distance;
    std::vector<double> vector;  ///< d numbers, world units; empty for curves
  };

  SourceVertices(const Source& source, int dimension) {
    const auto d = static_cast<std::size_t>(dimension);
    for (std::size_t k = 0; k < source.vertices().size(); ++k) {
      if (!(source.weights()[k] > 0)) continue;
      const double distance = source.place(k).distance;
      const auto [at, is_new] = values_.try_emplace(source.vertices()[k].index);
      if (!is_new && !(distance < at->second.distance)) continue;
      at->second.distance = distance;
      if (source.is_curve()) continue;
      at->second.vector.assign(d, 0.0);
      if (source.offsets().empty()) continue;
      const auto offset = source.offsets().subspan(k * d, d);
      at->second.vector.assign(offset.begin(), offset.end());
    }
  }

  /// Null if the vertex does not belong to the source.
  const ExactValue* find(Index vertex) const {
    const auto found = values_.find(vertex);
    return found == values_.end() ? nullptr : &found->second;
  }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }

 private:
  std::unordered_map<Index, ExactValue> values_;
};

/// Right-hand sides at `vertices`: parallel arrays, d the dimension. `pairs` and `lengths` are Dirichlet data of a march; otherwise empty.
struct RightHandSide {
  std::vector<Index> vertices;
  std::vector<double> heat;          ///< b: right-hand side of A lambda
  std::vector<double> frames;        ///< b U: right-hand side of B U~; stored as transports
  std::vector<double> values;        ///< right-hand side of the variant's system; d numbers
  std::vector<double> translations;  ///< contribution to rho, and so to every variant; d numbers in the vertex's frame
  std::vector<double> squares;       ///< b |z|^2: right-hand side of the second moment q
  std::vector<double> pairs;  ///< contribution to q before U is applied (`VariantSystem::sum_of_pairs`); d x d numbers
  std::vector<double> lengths;  ///< right-hand side of the second moment p; empty: `squares`
};

/// @throws InvalidArgument when the source does not fit the graph
void check_source(const Source& source, const TangentGraph& graph);

/// World length of one unit of x and Y: a power of two near the mean edge length, times the graph's unit. It keeps x and Y in the range of
/// lambda, which uses the full range of double precision.
double solution_unit(const TangentGraph& graph);

/// The right-hand side for a weight of 1 at these vertices: `heat_scale`, or less if a tiny mass would make the solution overflow.
double source_heat(const TangentGraph& graph, const HeatOperators& operators, std::span<const Vertex> vertices);

/// Right-hand side of a checked source, from its samples of positive weight. The weights b are scaled so that the largest becomes
/// `source_heat`. The factor cancels in every quotient by lambda.
/// @param keep  keep(vertex): whether to include the samples at this vertex; empty: all
RightHandSide right_hand_side_of(const Source& source, const TangentGraph& graph, const HeatOperators& operators,
                                 Variant variant, const std::function<bool(Index)>& keep = {});
std::vector<RightHandSide> right_hand_side_of(std::span<const Source> sources, const TangentGraph& graph,
                                              const HeatOperators& operators, Variant variant);

/// The connected components that contain a sample of positive weight.
class SourceComponents {
 public:
  /// @param component_of_vertex  as `HeatOperators::components`; must outlive this object
  SourceComponents(const Source& source, std::span<const Index> component_of_vertex);
  bool hold(Index vertex) const { return has_source_[component_[vertex]] != 0; }

 private:
  std::span<const Index> component_;
  std::vector<char> has_source_;
};

/// Whether distances are unfolded (`Wavefront`): on triangulations and from curves. Otherwise the second moment of heat gives the distance.
inline bool unfolds(const TangentGraph& graph, const Source& source) {
  return graph.is_delaunay() || source.is_curve();
}

/// Distance from |phi| and the root mean square of z at a vertex, all in the same unit.
///
/// The root mean square is accurate at cut loci, where vectors cancel. Within a few times sqrt(tau) of the source heat arrives along all
/// paths, so the root mean square is too long there, and |phi| is accurate. Both are exact on flat graphs.
inline double heat_distance(double length, double root_mean_square, double root_tau) {
  const double w = std::clamp(0.5 * (root_mean_square / root_tau - 2), 0.0, 1.0);
  return length + w * (root_mean_square - length);
}

/// Weight in [0, 1] of the direction of phi: 1 if the heat arrives along a single path, 0 if |phi| is much shorter than the distance,
/// because several paths cancel.
inline double trust_in_direction(double length, double distance) {
  return std::clamp((length / distance - 0.8) / 0.15, 0.0, 1.0);
}

/// Sets the distances of the source's vertices to their exact values, relative to the nearest source point.
inline void set_source_distances(const Source& source, std::span<double> distances) {
  const auto of_samples = [&](const auto& each) {
    for (std::size_t k = 0; k < source.vertices().size(); ++k)
      if (source.weights()[k] > 0) each(distances[source.vertices()[k].index], source.place(k).distance);
  };
  of_samples([](double& distance, double) { distance = std::numeric_limits<double>::infinity(); });
  of_samples([](double& distance, double given) { distance = std::min(distance, given); });
}

/// The solves of the affine heat method for a block of sources (docs/concepts/method.md).
class AffineHeat {
 public:
  /// @param threads  the results do not depend on it
  AffineHeat(const TangentGraph& graph, const HeatOperators& operators, Variant variant,
             std::vector<RightHandSide> right_hand_sides, unsigned threads = 1);

  /// Solves for lambda and the frames. All other solves require both.
  void diffuse();
  /// Solves for lambda only. This is sufficient for variants whose system has no frames, except for `frames` and `coordinates_at`.
  void diffuse_heat();
  /// Solves for the frames only.
  void diffuse_frames();
  /// Right-hand side of one source. `vertices` and `heat` are needed by `diffuse_heat`; the other members may be set after it.
  RightHandSide& right_hand_side(std::size_t source) { return rhs_[source]; }

  /// Solves for the variant's unknown, in units of `solution_unit(graph)`.
  void solve();
  /// Solves for the second moments q. Requires `solve`.
  void solve_squares();
  /// Solves for the second moments p, which give the distances. Requires `solve_squares`.
  void solve_lengths();
  bool has_squares() const { return !squares_.empty(); }
  bool has_lengths() const { return !lengths_.empty(); }
  /// The unknown of one source: n x d numbers in the layout of its system.
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
  /// sqrt(q_i / lambda_i) of one source, world units; 0 without `solve_squares`.
  double root_mean_square_at(std::size_t source, Index vertex) const;
  /// `heat_distance` of one source, world units; 0 without `solve_lengths`.
  double distance_at(std::size_t source, Index vertex) const;
  /// lambda_i z_i of one source in the frame of the vertex, stretched to the distance where a single path arrives: d numbers, units of the
  /// unknown.
  void radial_at(std::size_t source, Index vertex, double* out) const;
  /// z_i of one source in the frame of the vertex, world units. Its length is |phi_i|.
  void displacement_at(std::size_t source, Index vertex, double* out) const;
  /// phi_i of one source, world units.
  void coordinates_at(std::size_t source, Index vertex, double* phi) const;

  /// Whether the heat at the vertex, by both operators, is large enough for accurate results.
  bool reached(std::size_t source, Index vertex) const {
    return lambda(source)[vertex] >= min_heat_[source] && frames(source).heat(vertex) >= min_heat_[source];
  }
  /// The smallest heat of a reached vertex: `min_heat_share` of the source's.
  double least_heat(std::size_t source) const { return min_heat_[source]; }
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
  std::vector<double> min_heat_;        ///< smallest heat of a reached vertex, one per source
  std::vector<double> frame_solution_;  ///< U~, frame_size() per source
  std::vector<double> unknown_;         ///< unknown of the variant, n x d per source
  std::vector<double> squares_;         ///< second moments q, n per source
  std::vector<double> lengths_;         ///< second moments p, n per source
};

}  // namespace ahm
