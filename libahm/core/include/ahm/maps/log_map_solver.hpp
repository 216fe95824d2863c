/// \file
/// Logarithmic maps by the affine heat method, on any tangent graph.
///
/// \code
/// ahm::LogMapSolver solver(graph);                                  // factors once
/// ahm::LogMap map = solver.solve(ahm::Source::at_vertex(ahm::Vertex{42}));      // then each map costs a few triangular solves
///
/// ahm::LogMapSolver once(huge_graph, {.expected_maps = 1});    // factors nothing: solves a single map by a march
/// \endcode
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/source.hpp"

namespace ahm {

/// Options of one map. The solver's options apply where these have no value.
struct MapOptions {
  std::optional<Variant> variant = {};
  /// Vertices farther than this from the source get `Status::beyond_radius`, and a march ends there. World units; > 0.
  double radius = std::numeric_limits<double>::infinity();
  std::optional<unsigned> threads = {};
  bool frames = false;  ///< keep the transported frames
  bool spread = true;   ///< compute `LogMap::spread`; a fifth of the work if distances are unfolded
  /// Compute `LogMap::distance`. On triangulations a wavefront computes it, in 0.3 to 0.5 us per vertex and thread, which is most of the
  /// time of an additional map (docs/results/runtime.md). Without it the distance is |phi|, and the map has no spread and no quality.
  bool distances = true;
  std::optional<Progress> progress = {};
};

/// Computes log maps on one graph. Immutable: `solve` is const and may be called from many threads at once.
class LogMapSolver {
 public:
  /// Chooses the strategy. For `global` it also factors the graph's two operators.
  /// @param graph  must outlive the solver
  /// @throws as `HeatOperators`; InvalidArgument (accuracy, expected_maps)
  explicit LogMapSolver(const TangentGraph& graph, const HeatOptions& options = {});
  /// Not available: a temporary graph would not outlive the solver.
  explicit LogMapSolver(const TangentGraph&&, const HeatOptions& = {}) = delete;
  ~LogMapSolver();
  LogMapSolver(LogMapSolver&&) noexcept;
  LogMapSolver& operator=(LogMapSolver&&) noexcept;

  /// The log map of one source: Algorithm 1 or 2 with the homogeneous coordinate eliminated (docs/concepts/method.md).
  ///
  /// If a global solve does not reach all vertices, strategy `automatic` continues by a march.
  /// @throws InvalidArgument when the source does not fit the graph (index, dimension, a reflection on a `rotation2`
  ///         graph) or an option is out of range; NotPositiveDefinite (of a band), ResourceExhausted, Cancelled
  LogMap solve(const Source& source, const MapOptions& options = {}) const;

  /// The log maps of many sources, in their order. The strategy `global` solves blocks of up to 16 right-hand sides. The bits of a map depend
  /// on the list of sources and not on the number of threads; a map solved alone differs from it by rounding
  /// (1e-14 of the distance). The strategy `march` solves one map at a time on each thread.
  /// @throws as for one source; ResourceExhausted before any map is computed, if the maps would exceed the memory
  std::vector<LogMap> solve(std::span<const Source> sources, const MapOptions& options = {}) const;

  const TangentGraph& graph() const noexcept;
  const HeatOptions& options() const noexcept;
  /// The chosen strategy: `global` or `march`.
  Strategy strategy() const noexcept;
  /// The factored operators of the whole graph. Under strategy `march` the first call factors them.
  /// @throws as `HeatOperators`; ResourceExhausted if the strategy is `march` and the factors would not fit into memory
  const HeatOperators& operators() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace ahm
