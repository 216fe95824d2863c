/// \file
/// The two ways to solve for log maps by heat: with factors of the whole graph, and by a march.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "ahm/graph/graph_cache.hpp"
#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/maps/wavefront.hpp"
#include "heat/component_scales.hpp"
#include "maps/map_builder.hpp"
#include "maps/march.hpp"

namespace ahm {

/// A graph with the quantities that all solves on it share.
class HeatGraph {
 public:
  /// @param graph  must outlive this object
  /// @throws as `check_heat_options`
  HeatGraph(const TangentGraph& graph, const HeatOptions& options);
  HeatGraph(const HeatGraph&) = delete;
  HeatGraph& operator=(const HeatGraph&) = delete;

  const TangentGraph& graph;
  const HeatOptions options;
  const Strategy strategy;  ///< `global` or `march`
  const ComponentScales scales;
  const ComponentTimes times;
  const MapBuilder builder;

  GraphSize size() const { return {graph.size(), graph.dimension(), graph.transport_kind()}; }
  /// Computes what all fronts share, before several threads need it at once.
  void prepare_fronts(const MapSettings& map, unsigned threads) const {
    if (map.distances) one_rings(threads);
  }
  /// Runs a front from the source up to the radius of the map. The result is empty if the map has no distances or those of heat
  /// (`unfolds`).
  /// @throws Cancelled
  FrontDistances front(const Source& source, const MapSettings& map, unsigned threads) const;

 private:
  std::shared_ptr<const Wavefront::OneRings> one_rings(unsigned threads) const;

  GraphCache one_rings_;
};

/// Solves for maps by marches.
class MarchSolver {
 public:
  explicit MarchSolver(const HeatGraph& graph) : heat_graph_(graph) {}

  LogMap solve(const Source& source, const MapSettings& map, unsigned threads) const;
  /// Continues the solve of source number s of a global solve beyond its reached vertices.
  LogMap continue_from(AffineHeat& heat, std::size_t s, const Source& source, const FrontDistances& front,
                       const MapSettings& map, unsigned threads) const;

 private:
  March march(const MapSettings& map, const FrontDistances* front, unsigned threads) const;

  const HeatGraph& heat_graph_;
};

/// Solves for maps with the factors of A and B of the whole graph.
class GlobalSolver {
 public:
  explicit GlobalSolver(const HeatGraph& graph) : heat_graph_(graph) {}

  /// The factored operators; the first call factors them.
  /// @throws as `HeatOperators`
  const HeatOperators& operators(const Progress& progress = {}) const;
  /// Solves a block of sources. If vertices are unreached, strategy `automatic` continues by a march.
  std::vector<LogMap> solve(std::span<const Source> sources, const MapSettings& map, unsigned threads) const;

 private:
  LogMap build(AffineHeat& heat, std::size_t s, const Source& source, const FrontDistances& front,
               const MapSettings& map, unsigned threads) const;

  const HeatGraph& heat_graph_;
  mutable std::once_flag once_;
  mutable std::optional<HeatOperators> operators_;
};

}  // namespace ahm
