/// \file
/// How deep the bands of a march are, in heat distance.
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
#include "ahm/util/vec.hpp"
#include "heat/component_scales.hpp"
#include "heat/heat_system.hpp"
#include "maps/affine_heat.hpp"
#include "maps/known_values.hpp"
#include "maps/vertex_row.hpp"

namespace ahm {

/// Heat distance accepted per band, where the front is as regular as the graph's edges. Measured: deeper bands cost more
/// fill per vertex, thinner ones solve each vertex more often.
inline constexpr double march_step = 32;

/// How far a band goes beyond what is accepted: what lies ahead by x influences what lies behind by exp(-2 x).
inline double march_margin(double accuracy) { return 1.6 - 0.5 * std::log(accuracy); }

/// How much of the decay exp(-x) of heat an edge brings: its length over sqrt(tau), or what the one edge lets through at
/// the least, where it is far longer than sqrt(tau). An upper bound, for ordering vertices.
/// @param root_tau  sqrt(tau)
/// @param diagonal  called for the diagonal entry m + tau sum w of A at the edge's end, if it is needed
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

/// An edge along which the search for a band comes to a vertex of another member.
struct Crossing {
  Index vertex;
  double distance;  ///< heat distance of the near end
  double length, weight;
};

/// A vertex of another member next to one's own.
struct HaloVertex {
  Index vertex;
  std::int64_t row;  ///< among the band's vertices, those of the first member first
};

/// A member's part of a band as a graph: its own vertices with their stars, then the halo's, without edges and of mass 1.
struct BandPart {
  const CsrGraph& graph;
  std::span<const HaloVertex> halo;
  std::vector<double> tau;  ///< of each vertex, the same at both ends of an edge
};

/// All but `owns` and `reach` are called by all members at the same time, as often, in the same order.
class MarchTeam {
 public:
  virtual ~MarchTeam() = default;

  virtual bool owns(Index vertex) const = 0;

  /// Of the members' values.
  virtual double least(double value) = 0;
  virtual double greatest(double value) = 0;
  virtual std::int64_t sum(std::int64_t value) = 0;

  /// Hands crossings over to the owners of their vertices. @return those that come to one's own
  virtual std::vector<Crossing> cross(std::span<const Crossing> leaving) = 0;
  /// Tells of own vertices to all who own a neighbour of them; row i is that of vertices[i]. @return what others tell
  virtual std::vector<HaloVertex> share(std::span<const Index> vertices) = 0;

  /// Heat distance from the largest value of a solution to where it is right: shallower bands are accepted where errors are
  /// relative to the largest value. Infinite where each number is right by itself.
  virtual double reach() const = 0;
  /// Solves on own rows; of the halo it fills in what the owners found.
  /// @throws as `HeatOperators`
  virtual std::unique_ptr<const HeatSystem> system(BandPart part, const HeatOptions& options) = 0;
};

/// A team of one, which solves by factors in the plane and by conjugate gradients in volumes, where the factors of a band
/// would fill the memory.
class Alone final : public MarchTeam {
 public:
  /// @param heat_first  whether B is wanted later than A, while the next band's A is under way
  explicit Alone(int dimension, bool heat_first = false) : iterative_(dimension > 2), heat_first_(heat_first) {}
  bool owns(Index) const override { return true; }
  double least(double value) override { return value; }
  double greatest(double value) override { return value; }
  std::int64_t sum(std::int64_t value) override { return value; }
  std::vector<Crossing> cross(std::span<const Crossing>) override { return {}; }
  std::vector<HaloVertex> share(std::span<const Index>) override { return {}; }
  /// Measured: the cost of a vertex does not grow with a band's depth, but what has decayed further loses digits.
  double reach() const override { return iterative_ ? 8 : std::numeric_limits<double>::infinity(); }
  std::unique_ptr<const HeatSystem> system(BandPart part, const HeatOptions& options) override {
    return (iterative_    ? iterative_system
            : heat_first_ ? deferred_system
                          : factored_system)(part.graph, std::move(part.tau), options.factor());
  }

 private:
  bool iterative_, heat_first_;
};

/// Of one member of a team, halo included.
struct MarchState {
  MarchStatistics statistics;
  double depth = 0;                      ///< of bands
  Offset accepted = 0;                   ///< own vertices
  std::vector<Index> front;              ///< vertices from which the march goes on, in its order
  std::vector<Index> vertices;           ///< accepted ones that the front has not passed, ascending
  std::vector<double> values;            ///< of each of these as many, as `KnownValues` has them, and what was found
  std::vector<HeatExponents> exponents;  ///< of each of these
  std::vector<Index> passed;             ///< begin and end of each run of vertices that the front has passed, ascending
};

class March;

/// Keeps a march's state where it is to survive the process.
class MarchKeeper {
 public:
  virtual ~MarchKeeper() = default;
  /// Where to go on; none: from the source.
  virtual std::optional<MarchState> begin() = 0;
  /// Called after each band, by all members of a team: `march.state()` is what `begin` may return.
  virtual void end_band(const March& march) = 0;
};

/// The scales of the component that a vertex is in.
class MarchScales {
 public:
  virtual ~MarchScales() = default;
  /// Diffusion time, squared graph units.
  virtual double tau(Index vertex) const = 0;
  /// Mean edge length, graph units.
  virtual double h(Index vertex) const = 0;
};

/// The same of all vertices of a component.
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
  std::vector<double> tau_;  ///< per component
};

/// Takes what a march finds of a vertex when it is accepted, each vertex once.
class MarchSink {
 public:
  virtual ~MarchSink() = default;
  /// phi is NaN where too little heat arrived.
  virtual void accept(Index vertex, const HeatRow& found) = 0;
};

/// Distances that are known before the march.
class KnownDistances {
 public:
  virtual ~KnownDistances() = default;
  /// Of a vertex that the march has come to, world units.
  virtual double of(Index vertex) const = 0;
};

/// How far a march goes.
struct MarchReach {
  double radius = INFINITY;  ///< world units
  /// By which it ends. Null: those of heat, which ways that leave the radius may shorten, so that it ends where the straight
  /// line in space is longer as well, if the source has a place there.
  const KnownDistances* distances = nullptr;
};

/// What a march looks for.
enum class MarchGoal {
  map,
  coordinates,  ///< of a map, without what distances and spread need; the radius must be infinite
  distances,  ///< alone, without frames: coordinates are those of z in the frame of each vertex; the variant must be localized
};

class March {
 public:
  /// @param options  accuracy, ordering, kind of factorization; the graph must have been checked
  /// @param scales   must outlive this object
  /// @param sink     null: what is found is kept, and told below. Else it is handed over, and forgotten when the front
  ///                 has passed the vertex, so that memory grows with the front
  /// @param team     null: alone. Else one of those who march together, which takes a sink; it is told of own vertices
  March(const TangentGraph& graph, const HeatOptions& options, const MarchScales& scales, Variant variant,
        const MarchReach& reach, unsigned threads, Progress progress, MarchSink* sink = nullptr,
        MarchTeam* team = nullptr, MarchGoal goal = MarchGoal::map);

  /// Marches from a checked source.
  /// @param keeper  null: nothing is kept. Else the march, which has a sink, goes on from where it says
  void run(const Source& source, MarchKeeper* keeper = nullptr);
  /// At the end of a band.
  MarchState state() const;
  /// Marches on from where a solve on the whole graph ended, source number `s` of `heat`.
  void run_on(const AffineHeat& heat, std::size_t s, const Source& source);

  /// phi_i in world units; NaN where `accepted` is false or too little heat arrived.
  std::span<const double> coordinates(Index vertex) const {
    return accepted(vertex) ? std::span(found_[numbers_.find(vertex)], d_) : std::span(nothing_);
  }
  /// sqrt(q_i / lambda_i) in world units; NaN as `coordinates`.
  double root_mean_square(Index vertex) const {
    return accepted(vertex) ? found_[numbers_.find(vertex)][d_] : nothing_[0];
  }
  /// In world units; NaN as `coordinates`.
  double distance(Index vertex) const { return accepted(vertex) ? found_[numbers_.find(vertex)][d_ + 1] : nothing_[0]; }
  /// Whether the march came to the vertex.
  bool accepted(Index vertex) const {
    const Index number = numbers_.find(vertex);
    return number >= 0 ? ways_[number]->accepted : number == ReachedNumbers::forgotten;
  }
  /// U_i as d x d numbers, row major; the identity where `accepted` is false.
  void axes(Index vertex, double* out) const;
  const MarchStatistics& statistics() const { return statistics_; }
  /// Memory taken by what is known of vertices.
  std::size_t bytes() const { return numbers_.bytes() + ways_.bytes() + known_.bytes() + found_.bytes(); }

 private:
  struct Band {
    std::vector<Index> vertices;  ///< own ones, then the halo
    std::vector<HaloVertex> halo;
    std::vector<Index> edge;  ///< places of own ones at the far end: with neighbours ahead of the band
    std::size_t own = 0;      ///< vertices
  };
  struct Link {  ///< an edge from a vertex of the band back to an accepted one
    Index place;
    std::size_t edge;
    Index number;  ///< of the accepted one
  };
  struct Ahead {  ///< an edge to a vertex that is not accepted yet
    Index vertex;
    double weight, length;
  };
  struct Way {  ///< where a vertex is on its way
    bool accepted = false;
    Index place = -1;            ///< in the band at hand
    float tentative = INFINITY;  ///< heat distance, less that of the front
  };
  struct Tentative {  ///< the heat distances of a search
    March& march;
    float& operator[](Index vertex) const { return march.way(vertex).tentative; }
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
  bool keep_to_reach();
  Way& way(Index vertex);
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
  bool looks_ahead_;  ///< to the next band's heat, before the rest of this one is found
  std::unique_ptr<MarchTeam> alone_;
  MarchTeam& team_;
  double margin_, step_;
  MarchReach reach_;
  std::optional<Vec3> start_;  ///< of straight lines
  double depth_;               ///< of bands
  Progress progress_;
  unsigned threads_;
  std::size_t d_;

  ReachedNumbers numbers_;     ///< of the vertices that were looked at
  GrowingRows<Way> ways_;      ///< of these
  KnownValues known_;          ///< of the accepted ones
  GrowingRows<double> found_;  ///< of the accepted ones: coordinates, root mean square, distance
  std::vector<double> nothing_;
  std::vector<Index> front_;  ///< own accepted vertices with neighbours that are not
  MarchStatistics statistics_;
  Offset accepted_count_ = 0;  ///< own ones
};

}  // namespace ahm
