/// \file
/// The march, a banded solve: the affine heat method by thin bands in the order of heat distance, so that time and memory grow
/// linearly and nothing underflows at any distance (docs/concepts/march.md).
///
/// A band is the part of the graph just ahead of the front. It is cut out with its natural boundary and solved by the same
/// operators and the same elimination as a whole graph; the accepted values behind the front enter as Dirichlet data. What
/// lies near the band's far end is dropped again, since the graph beyond would have influenced it.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/util/vec.hpp"
#include "heat/component_scales.hpp"
#include "maps/affine_heat.hpp"
#include "maps/known_values.hpp"
#include "maps/march_state.hpp"
#include "maps/march_team.hpp"
#include "maps/reached_rows.hpp"
#include "maps/vertex_row.hpp"

namespace ahm {

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
