/// \file
/// What a source says of its own vertices.
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

/// Distance and vector of a source's own vertices as it was given with them, each from the nearest of its points: they are known
/// better than from heat, which smears a point over its neighbours. Of curves the distances alone, since coordinates from curves
/// are no vectors to a point.
class SourceVertices {
 public:
  struct Known {
    double distance;
    std::vector<double> vector;  ///< d numbers, world units; empty: not known
  };

  SourceVertices(const Source& source, int dimension) {
    const auto d = static_cast<std::size_t>(dimension);
    for (std::size_t k = 0; k < source.vertices().size(); ++k) {
      if (!(source.weights()[k] > 0)) continue;
      const double distance = source.place(k).distance;
      const auto [at, is_new] = known_.try_emplace(source.vertices()[k].index);
      if (!is_new && !(distance < at->second.distance)) continue;
      at->second.distance = distance;
      if (source.is_curve()) continue;
      at->second.vector.assign(d, 0.0);
      if (source.offsets().empty()) continue;
      const auto offset = source.offsets().subspan(k * d, d);
      at->second.vector.assign(offset.begin(), offset.end());
    }
  }

  /// Null for other vertices.
  const Known* find(Index vertex) const {
    const auto found = known_.find(vertex);
    return found == known_.end() ? nullptr : &found->second;
  }
  auto begin() const { return known_.begin(); }
  auto end() const { return known_.end(); }

 private:
  std::unordered_map<Index, Known> known_;
};

/// Right-hand sides at `vertices`; parallel arrays, d the dimension.
struct RightHandSide {
  std::vector<Index> vertices;
  std::vector<double> heat;          ///< b: enters A lambda
  std::vector<double> frames;        ///< b U: enters B U~; stored as transports are
  std::vector<double> values;        ///< of the variant's own: enters its system; d numbers
  std::vector<double> translations;  ///< enters rho, hence every variant; d numbers in the vertex's frame
  std::vector<double> squares;       ///< b |z|^2: enters the second moment
  std::vector<double> pairs;         ///< of known vertices, d x d numbers: enters the second moment with U; or empty
  std::vector<double> lengths;  ///< of known vertices: enters the second moment of distances instead of both; or empty
};

/// @throws InvalidArgument when the source does not fit the graph
void check_source(const Source& source, const TangentGraph& graph);

/// The outside length of 1 in x and Y: a power of two near the mean edge length, times the graph's own unit. It keeps x
/// and Y in the range of lambda, which is used up to both ends.
double solution_unit(const TangentGraph& graph);

/// The right-hand side that stands for a weight of 1 at these vertices: `heat_scale`, less where a tiny mass would make
/// the solution overflow.
double source_heat(const TangentGraph& graph, const HeatOperators& operators, std::span<const Vertex> vertices);

/// The samples of positive weight of a checked source. The largest b becomes `source_heat`; the factor cancels in every
/// quotient by lambda.
/// @param keep  which of them; none given: all
RightHandSide right_hand_side_of(const Source& source, const TangentGraph& graph, const HeatOperators& operators,
                                 Variant variant, const std::function<bool(Index)>& keep = {});
std::vector<RightHandSide> right_hand_side_of(std::span<const Source> sources, const TangentGraph& graph,
                                              const HeatOperators& operators, Variant variant);

/// Whether the component of a vertex holds a sample of positive weight.
class SourceComponents {
 public:
  /// @param component_of_vertex  as `HeatOperators::components`; must outlive this object
  SourceComponents(const Source& source, std::span<const Index> component_of_vertex);
  bool hold(Index vertex) const { return has_source_[component_[vertex]] != 0; }

 private:
  std::span<const Index> component_;
  std::vector<char> has_source_;
};

/// How distances are measured: unfolded on triangulations and from curves, elsewhere by the second moment of heat.
inline bool unfolds(const TangentGraph& graph, const Source& source) {
  return graph.is_delaunay() || source.is_curve();
}

/// From |phi| and the root mean square of z at a vertex, all in the same unit.
///
/// The root mean square holds at cut loci, where vectors cancel; within a few times sqrt(tau) of the source, where heat has
/// taken all ways there are, it is too long, and |phi| is right. Both are exact on flat graphs.
inline double heat_distance(double length, double root_mean_square, double root_tau) {
  const double w = std::clamp(0.5 * (root_mean_square / root_tau - 2), 0.0, 1.0);
  return length + w * (root_mean_square - length);
}

/// How far the direction of phi is that of one way: not where |phi| is much shorter than the distance, since there several
/// ways cancel.
inline double trust_in_direction(double length, double distance) {
  return std::clamp((length / distance - 0.8) / 0.15, 0.0, 1.0);
}

/// Puts a source's own vertices at the distances it was given with, which are known better than by the root of a difference:
/// each at that from the nearest of its points.
inline void set_source_distances(const Source& source, std::span<double> distances) {
  const auto of_samples = [&](const auto& each) {
    for (std::size_t k = 0; k < source.vertices().size(); ++k)
      if (source.weights()[k] > 0) each(distances[source.vertices()[k].index], source.place(k).distance);
  };
  of_samples([](double& distance, double) { distance = std::numeric_limits<double>::infinity(); });
  of_samples([](double& distance, double given) { distance = std::min(distance, given); });
}

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
    return lambda(source)[vertex] >= min_heat_[source] && frames(source).heat(vertex) >= min_heat_[source];
  }
  /// The heat that counts: `min_heat_share` of the source's.
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
  std::vector<double> min_heat_;        ///< one per source
  std::vector<double> frame_solution_;  ///< U~, frame_size() per source
  std::vector<double> unknown_;         ///< n x d per source
  std::vector<double> squares_;         ///< n per source
  std::vector<double> lengths_;         ///< n per source
};

}  // namespace ahm
