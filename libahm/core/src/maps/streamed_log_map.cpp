#include "maps/streamed_log_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/text.hpp"
#include "heat/component_scales.hpp"
#include "heat/heat_system.hpp"
#include "maps/affine_heat.hpp"
#include "maps/march.hpp"

namespace ahm {
namespace {

/// Scales computed from `TangentGraph::component_edge_length`.
class GraphScales final : public MarchScales {
 public:
  GraphScales(const TangentGraph& graph, double t_coef) : graph_(graph), t_coef_(t_coef) {}
  double tau(Index vertex) const override { return t_coef_ * h(vertex) * h(vertex); }
  double h(Index vertex) const override { return graph_.component_edge_length(vertex); }

 private:
  const TangentGraph& graph_;
  double t_coef_;
};

/// Converts the results of the march to rows of the map. Provides the march with unfolded distances, if there are any.
class Rows final : public MarchSink, public KnownDistances {
 public:
  Rows(const TangentGraph& graph, const Source& source, double radius, const TeamMarch& how, const Progress& progress,
       MapSink& sink)
      : radius_(radius),
        sink_(sink),
        phi_(how.goal == MarchGoal::map ? static_cast<std::size_t>(graph.dimension()) : 0),
        distances_(how.distances),
        own_(source, graph.dimension()) {
    if (distances_) return;
    if (unfolds(graph, source)) {
      progress.step("unfold", 0);
      front_.emplace(graph);
      front_->add(source);
      front_->run(radius, progress.stop);
    }
  }

  /// Distances computed before the march. Null: the map has the distances by heat.
  const KnownDistances* distances() const { return distances_ ? distances_ : front_ ? this : nullptr; }
  double of(Index vertex) const override { return front_->distance(Vertex(vertex)); }

  void accept(Index vertex, const HeatRow& found) override {
    std::copy_n(found.phi.begin(), phi_.size(), phi_.begin());
    VertexRow row = vertex_row(found);
    const auto* known = own_.find(vertex);
    if (distances())
      row.distance = distances()->of(vertex);
    else if (known)
      row.distance = known->distance;
    if (known) {
      std::copy_n(known->vector.begin(), phi_.size(), phi_.begin());
      row.spread = 0;
    }
    if (row.status == Status::ok && row.distance > radius_) row.status = Status::beyond_radius;
    if (row.status != Status::ok) {
      std::fill(phi_.begin(), phi_.end(), NAN);
      row.distance = row.spread = NAN;
    }
    sink_.add(vertex, {row.status, phi_, row.distance, row.spread});
  }

 private:
  double radius_;
  MapSink& sink_;
  std::vector<double> phi_;  ///< empty if only distances are computed
  const KnownDistances* distances_;
  SourceVertices own_;
  std::optional<Wavefront> front_;  ///< the front that unfolds distances, if they are unfolded here
};

HeatOptions heat_options(const StreamOptions& options) {
  return {.t_coef = options.t_coef,
          .variant = options.variant,
          .accuracy = options.accuracy,
          .threads = options.threads,
          .progress = options.progress};
}

}  // namespace

void check_streamed_map(const TangentGraph& graph, const Source& source, const HeatOptions& options,
                        const MapOptions& map) {
  if (map.frames) throw InvalidArgument("streamed maps have no frames");
  if (!(map.radius > 0))
    throw InvalidArgument("radius is " + detail::number(map.radius) + "; it must be > 0 (infinity: the whole graph)");
  HeatOptions quiet = options;
  quiet.check_graph = false;
  check_heat_options(graph, quiet);
  check_source(source, graph);
  if (source.is_curve()) throw InvalidArgument("the source is a curve; streamed maps require points");
  for (Vertex vertex : source.vertices()) {
    const double h = graph.component_edge_length(vertex.index);
    if (!(h > 0)) throw InvalidArgument("the graph has no mean edge lengths; implement `component_edge_length`");
    diffusion_time(options.t_coef, h);
  }
}

MarchStatistics stream_log_map(const TangentGraph& graph, const Source& source, const StreamOptions& options,
                               MapSink& sink) {
  SingleMember team(graph.dimension());
  return team_log_map(graph, source, heat_options(options), {.radius = options.radius}, sink, team);
}

MarchStatistics stream_distances(const TangentGraph& graph, const Source& source, const StreamOptions& options,
                                 MapSink& sink) {
  SingleMember team(graph.dimension());
  return team_log_map(graph, source, heat_options(options), {.radius = options.radius}, sink, team,
                      {.goal = MarchGoal::distances});
}

MarchStatistics team_log_map(const TangentGraph& graph, const Source& source, const HeatOptions& options,
                             const MapOptions& map, MapSink& sink, MarchTeam& team, const TeamMarch& how) {
  check_streamed_map(graph, source, options, map);
  const GraphScales scales(graph, options.t_coef);
  const Progress progress = map.progress.value_or(options.progress);
  Rows rows(graph, source, map.radius, how, progress, sink);
  const Variant variant = how.goal == MarchGoal::map ? map.variant.value_or(options.variant) : Variant::localized;
  const unsigned threads = detail::thread_count(map.threads.value_or(options.threads));
  March march(graph, options, scales, variant, {map.radius, rows.distances()}, threads, progress, &rows, &team,
              how.goal);
  march.run(source, how.keeper);
  return march.statistics();
}

}  // namespace ahm
