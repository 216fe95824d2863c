/// \file
/// The march: solves for a log map band after band, outwards from the source (docs/concepts/march.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/graph/tangent_graph.hpp"
#include "ahm/heat/heat_options.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "heat/component_scales.hpp"
#include "heat/heat_system.hpp"
#include "maps/affine_heat.hpp"
#include "maps/known_values.hpp"

namespace ahm {

/// Heat distance that is accepted per band, less if the front is irregular. Chosen by measurement: deeper bands have more fill per vertex,
/// thinner bands solve each vertex more often.
inline constexpr double march_step = 32;

/// Heat distance by which a band extends beyond its accepted part. Values at a distance x ahead have an influence of exp(-2 x).
inline double march_margin(double accuracy) { return 1.6 - 0.5 * std::log(accuracy); }

/// Heat distance x of an edge, along which heat decays by exp(-x): its length over sqrt(tau). Heat decays over a single edge by at most the
/// diagonal entry over tau w, which bounds x for edges much longer than sqrt(tau). An upper bound, used to order vertices.
/// @param root_tau  sqrt(tau)
/// @param diagonal  returns the diagonal entry m + tau sum w of A at the edge's end; called only if it is needed
template <class Diagonal>
double edge_heat_distance(double length, double weight, double tau, double root_tau, const Diagonal& diagonal) {
  const double by_length = length / root_tau;
  if (by_length <= 3 || !(weight > 0)) return by_length;
  return std::min(by_length, std::log(diagonal() / (tau * weight)));
}

/// m + tau sum w: the diagonal entry of A.
inline double heat_diagonal(const TangentGraph& graph, Index vertex, double tau) {
  double sum = graph.mass(vertex);
  for (const double w : graph.star(vertex).weights) sum += tau * w;
  return sum;
}

/// An edge along which the search for a band reaches a vertex of another member of the team.
struct Crossing {
  Index vertex;
  double distance;  ///< heat distance of the near end
  double length, weight;
};

/// A vertex of another member that is a neighbor of an own vertex.
struct HaloVertex {
  Index vertex;
  std::int64_t row;  ///< number among the vertices of the whole band, in the order of the members
};

/// A member's part of a band as a graph: its own vertices with their stars, then the halo vertices, without edges and with mass 1.
struct BandPart {
  const CsrGraph& graph;
  std::span<const HaloVertex> halo;
  std::vector<double> tau;  ///< diffusion time of each vertex, equal at both ends of an edge
};

/// The members that compute a march together; each owns a part of the vertices. All members call all functions except `owns` and `reach`,
/// in the same order.
class MarchTeam {
 public:
  virtual ~MarchTeam() = default;

  virtual bool owns(Index vertex) const = 0;

  /// Minimum over the members.
  virtual double least(double value) = 0;
  /// Maximum over the members.
  virtual double greatest(double value) = 0;
  /// Sum over the members.
  virtual std::int64_t sum(std::int64_t value) = 0;

  /// Sends crossings to the owners of their vertices. @return the crossings that reach own vertices
  virtual std::vector<Crossing> cross(std::span<const Crossing> leaving) = 0;
  /// Sends own vertices to all members that own a neighbor of them; vertices[i] has row i. @return the vertices received from others
  virtual std::vector<HaloVertex> share(std::span<const Index> vertices) = 0;

  /// Heat distance from the largest value of a solution up to which the values are accurate. It bounds the accepted depth if errors are
  /// relative to the largest value. Infinite if each value has a small relative error.
  virtual double reach() const = 0;
  /// A system that solves for the rows of all members. A solve returns the own rows and, for halo vertices, the values of their owners.
  /// @throws as `HeatOperators`
  virtual std::unique_ptr<const HeatSystem> system(BandPart part, const HeatOptions& options) = 0;
};

/// A team with a single member. It solves by factors in the plane, and by conjugate gradients in volumes, where the factors of a band would
/// need too much memory.
class SingleMember final : public MarchTeam {
 public:
  /// @param defers_frames  whether to postpone the factorization of B, so that it can run at the same time as the next band's solve with A
  explicit SingleMember(int dimension, bool defers_frames = false)
      : iterative_(dimension > 2), defers_frames_(defers_frames) {}
  bool owns(Index) const override { return true; }
  double least(double value) override { return value; }
  double greatest(double value) override { return value; }
  std::int64_t sum(std::int64_t value) override { return value; }
  std::vector<Crossing> cross(std::span<const Crossing>) override { return {}; }
  std::vector<HaloVertex> share(std::span<const Index>) override { return {}; }
  /// Chosen by measurement: the cost per vertex does not depend on the depth of a band, but values that have decayed more lose digits.
  double reach() const override { return iterative_ ? 8 : std::numeric_limits<double>::infinity(); }
  std::unique_ptr<const HeatSystem> system(BandPart part, const HeatOptions& options) override {
    return (iterative_       ? iterative_system
            : defers_frames_ ? deferred_system
                             : factored_system)(part.graph, std::move(part.tau), options.factor());
  }

 private:
  bool iterative_, defers_frames_;
};

/// The state of one member of a team between two bands, including its halo.
struct MarchState {
  MarchStatistics statistics;
  double depth = 0;                      ///< depth of the bands, heat distance
  Offset accepted = 0;                   ///< number of accepted own vertices
  std::vector<Index> front;              ///< vertices from which the march continues, in its order
  std::vector<Index> vertices;           ///< accepted vertices that the front has not passed, ascending
  std::vector<double> values;            ///< for each of `vertices` the row of `KnownValues`, then its results
  std::vector<HeatExponents> exponents;  ///< for each of `vertices`
  std::vector<Index> passed;  ///< begin and end of each range of vertices that the front has passed, ascending
};

class March;

/// Saves the state of a march, so that another process can continue it.
class MarchKeeper {
 public:
  virtual ~MarchKeeper() = default;
  /// The state from which to continue; nullopt: start from the source.
  virtual std::optional<MarchState> begin() = 0;
  /// Called after each band, by all members of a team. `begin` may return `march.state_of()` later.
  virtual void end_band(const March& march) = 0;
};

/// Diffusion time and mean edge length of the component of each vertex.
class MarchScales {
 public:
  virtual ~MarchScales() = default;
  /// Diffusion time, squared graph units.
  virtual double tau(Index vertex) const = 0;
  /// Mean edge length, graph units.
  virtual double h(Index vertex) const = 0;
};

/// Scales computed from `ComponentScales`.
class ComponentTimes final : public MarchScales {
 public:
  /// @param scales  must outlive this object
  /// @throws as `diffusion_time`
  ComponentTimes(const ComponentScales& scales, double t_coef) : scales_(scales) {
    for (const double h : scales.edge_length) tau_.push_back(diffusion_time(t_coef, h));
  }
  double tau(Index vertex) const override { return tau_[scales_.component(vertex)]; }
  double h(Index vertex) const override { return scales_.h(vertex); }

 private:
  const ComponentScales& scales_;
  std::vector<double> tau_;  ///< diffusion time of each component
};

/// The result of the heat method at a vertex, world units.
struct HeatRow {
  std::span<const double> phi;  ///< coordinates
  double root_mean_square;      ///< sqrt(q / lambda)
  double distance;              ///< `heat_distance`
};

/// The row of a vertex in a map, without its coordinates; lengths in world units.
struct VertexRow {
  Status status;  ///< `unreached` where a number is not finite
  double distance, spread;
};

inline VertexRow vertex_row(const HeatRow& found) {
  const double r = length(found.phi), rms = found.root_mean_square;
  const bool ok = all_finite(found.phi) && std::isfinite(rms) && std::isfinite(found.distance);
  return {ok ? Status::ok : Status::unreached, found.distance, rms > r ? std::sqrt(rms - r) * std::sqrt(rms + r) : 0.0};
}

/// Receives the result at each vertex when it is accepted, once per vertex.
class MarchSink {
 public:
  virtual ~MarchSink() = default;
  /// phi is NaN where too little heat arrived.
  virtual void accept(Index vertex, const HeatRow& found) = 0;
};

/// Distances that are computed before the march.
class KnownDistances {
 public:
  virtual ~KnownDistances() = default;
  /// Distance of a vertex that the march has reached, world units.
  virtual double of(Index vertex) const = 0;
};

/// Where a march ends.
struct MarchReach {
  double radius = INFINITY;  ///< world units
  /// The distances that are compared with the radius. Null: the lengths of the vectors by heat. Paths that leave the radius and return may
  /// shorten these. The march then ends only where the straight line in space is longer than the radius, too, if the position of the
  /// source is known.
  const KnownDistances* distances = nullptr;
};

/// What a march computes.
enum class MarchGoal {
  map,          ///< coordinates, distances and spread
  coordinates,  ///< coordinates only; the radius must be infinite
  distances,    ///< distances and spread only, without frames: `coordinates` returns z; the variant must be localized
};

/// Solves for a log map of one source, band after band (docs/concepts/march.md).
class March {
 public:
  /// @param options  accuracy, ordering, threads; the graph must have been checked
  /// @param scales   must outlive this object
  /// @param sink     null: the march stores all results, and the accessors below return them. Otherwise `sink` receives each result, and
  ///                 the march frees it when the front has passed the vertex, so that memory is proportional to the front
  /// @param team     null: a team with a single member. Otherwise a sink is required; it receives own vertices only
  March(const TangentGraph& graph, const HeatOptions& options, const MarchScales& scales, Variant variant,
        const MarchReach& reach, unsigned threads, Progress progress, MarchSink* sink = nullptr,
        MarchTeam* team = nullptr, MarchGoal goal = MarchGoal::map);

  /// Marches from a checked source.
  /// @param keeper  null: the state is not saved. Otherwise the march, which needs a sink, continues from the state of the keeper
  void run(const Source& source, MarchKeeper* keeper = nullptr);
  /// The state at the end of a band.
  MarchState state() const;
  /// Continues a solve on the whole graph beyond its reached vertices. `s` is the number of the source in `heat`.
  void run_on(const AffineHeat& heat, std::size_t s, const Source& source);

  /// phi_i, world units; NaN where `accepted` is false or too little heat arrived.
  std::span<const double> coordinates(Index vertex) const {
    return accepted(vertex) ? std::span(found_[numbers_.find(vertex)], d_) : std::span(nan_);
  }
  /// sqrt(q_i / lambda_i), world units; NaN where `coordinates` is.
  double root_mean_square(Index vertex) const { return accepted(vertex) ? found_[numbers_.find(vertex)][d_] : NAN; }
  /// Distance by heat, world units; NaN where `coordinates` is.
  double distance(Index vertex) const { return accepted(vertex) ? found_[numbers_.find(vertex)][d_ + 1] : NAN; }
  /// Whether the march has reached the vertex.
  bool accepted(Index vertex) const {
    const Index number = numbers_.find(vertex);
    return number >= 0 ? states_[number]->accepted : number == ReachedNumbers::forgotten;
  }
  /// U_i as d x d numbers, row major; the identity where `accepted` is false.
  void axes(Index vertex, double* out) const;
  const MarchStatistics& statistics() const { return statistics_; }
  /// Memory of the values of vertices.
  std::size_t bytes() const { return numbers_.bytes() + states_.bytes() + known_.bytes() + found_.bytes(); }

 private:
  struct Band {
    std::vector<Index> vertices;  ///< own vertices, then the halo
    std::vector<HaloVertex> halo;
    std::vector<Index> edge;  ///< places of own vertices at the far end, which have neighbors ahead of the band
    std::size_t own = 0;      ///< number of own vertices
  };
  struct Link {  ///< an edge from a vertex of the band back to an accepted vertex
    Index place;
    std::size_t edge;
    Index number;  ///< number of the accepted vertex
  };
  struct Ahead {  ///< an edge to a vertex that is not accepted yet
    Index vertex;
    double weight, length;
  };
  struct VertexState {  ///< the state of a vertex
    bool accepted = false;
    Index place = -1;            ///< place in the current band; -1: not in it
    float tentative = INFINITY;  ///< heat distance relative to the front
  };
  struct Tentative {  ///< the heat distances of a search, as an array for `ShortestPaths`
    March& march;
    float& operator[](Index vertex) const { return march.state_of(vertex).tentative; }
  };

  void march(const Source* source);
  void restore(const MarchState& state);
  struct Solve;
  std::unique_ptr<Solve> solve_heat(const Source* source);
  bool accept_near(Solve& solve);
  void solve_values(Solve& solve);
  Band find_band(const Source* source);
  std::vector<Index> search(const Source* source);
  void find_edge(Band& band);
  bool may_be_nearer(Index vertex, double distance) const;
  std::optional<std::vector<Index>> near_part(const Band& band, std::int64_t size,
                                              std::span<const double> lambda) const;
  static std::vector<Index> numbers_behind(const Solve& solve);
  RightHandSide heat_behind(const Solve& solve) const;
  void add_values_behind(const Solve& solve, RightHandSide& in) const;
  double conductance(const Solve& solve, const Link& link) const;
  Index accept(Index vertex, double lambda, std::int32_t exponent);
  void take_values(Index vertex, Index number, Index place, const AffineHeat& heat, std::size_t s,
                   std::int32_t frame_exponent);
  void pass_front(std::span<const Index> added);
  bool drop_out_of_reach();
  VertexState& state_of(Index vertex);
  Index place(Index vertex) const;
  bool has_neighbors_ahead(Index vertex) const;
  bool is_within_reach(Index vertex) const;
  void forget(Index vertex);
  Index known_number(Index vertex) const;
  double tau(Index vertex) const { return scales_.tau(vertex); }

  const TangentGraph& graph_;
  HeatOptions options_;
  Variant variant_;
  const MarchScales& scales_;
  MarchSink* sink_;
  MarchGoal goal_;
  MarchKeeper* keeper_ = nullptr;
  bool looks_ahead_;  ///< whether the next band's heat is computed at the same time as the other values of this band
  std::unique_ptr<MarchTeam> own_team_;
  MarchTeam& team_;
  double margin_, step_;
  MarchReach reach_;
  std::optional<Vec3> start_;  ///< position of the source, for straight lines
  double depth_;               ///< depth of the bands, heat distance
  Progress progress_;
  unsigned threads_;
  std::size_t d_;

  ReachedNumbers numbers_;           ///< numbers of the visited vertices
  GrowingRows<VertexState> states_;  ///< states of the visited vertices
  KnownValues known_;                ///< solved values of the accepted vertices
  GrowingRows<double> found_;        ///< results at the accepted vertices: coordinates, root mean square, distance
  std::vector<double> nan_;
  std::vector<Index> front_;  ///< accepted own vertices with neighbors that are not accepted
  MarchStatistics statistics_;
  Offset accepted_count_ = 0;  ///< number of accepted own vertices
};

}  // namespace ahm
