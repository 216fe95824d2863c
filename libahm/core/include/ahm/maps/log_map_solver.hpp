/// \file
/// Logarithmic maps by the affine heat method, on any tangent graph.
///
/// \code
/// ahm::LogMapSolver solver(graph);                                  // factors once
/// ahm::LogMap map = solver.solve(ahm::Source::at_vertex(ahm::Vertex{42}));      // then each map costs a few triangular solves
///
/// ahm::LogMapSolver once(huge_graph, {.expected_maps = 1});    // nothing is factored: one map by marching
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

/// What may differ from map to map; what is not given is the solver's.
struct MapOptions {
  std::optional<Variant> variant = {};
  /// Vertices farther than this from the source get `Status::beyond_radius`, and a march ends there. World units; > 0.
  double radius = std::numeric_limits<double>::infinity();
  std::optional<unsigned> threads = {};
  bool frames = false;  ///< keep the transported frames
  bool spread = true;   ///< find and keep `LogMap::spread`; where distances are unfolded it is a fifth of the work
  /// Find `LogMap::distance`. Without, a map is coordinates alone, from factors in about half the time: its distance is |phi|, and it
  /// has no spread (and so no quality).
  bool distances = true;
  std::optional<Progress> progress = {};
};

/// Solves for log maps on one graph. Immutable: `solve` is const and may be called from many threads at once.
class LogMapSolver {
 public:
  /// Chooses the strategy, and for a global one factors the graph's two operators.
  /// @param graph  must outlive the solver
  /// @throws as `HeatOperators`; InvalidArgument (accuracy, expected_maps)
  explicit LogMapSolver(const TangentGraph& graph, const HeatOptions& options = {});
  explicit LogMapSolver(TangentGraph&&, const HeatOptions& = {}) = delete;
  ~LogMapSolver();
  LogMapSolver(LogMapSolver&&) noexcept;
  LogMapSolver& operator=(LogMapSolver&&) noexcept;

  /// The log map of one source (Alg. 1 or Alg. 2 with the homogeneous coordinate eliminated, docs/concepts/method.md).
  ///
  /// Where a global solve leaves vertices beyond its reach, strategy `automatic` marches on from what it has reached.
  /// @throws InvalidArgument when the source does not fit the graph (index, dimension, a reflection on a `rotation2`
  /// graph) or an option is out of range; NotPositiveDefinite (of a band), ResourceExhausted, Cancelled
  LogMap solve(const Source& source, const MapOptions& options = {}) const;

  /// Many sources. Global: as blocks of right-hand sides, the same numbers in the same order as one block at a time on
  /// one thread. Marched: one after the other on each thread.
  /// @throws as for one; ResourceExhausted where the maps alone would fill the memory, before any is made
  std::vector<LogMap> solve(std::span<const Source> sources, const MapOptions& options = {}) const;

  const TangentGraph& graph() const noexcept;
  const HeatOptions& options() const noexcept;
  /// What was chosen: `global` or `march`.
  Strategy strategy() const noexcept;
  /// The factored operators of the whole graph. Under strategy `march` the first call factors them.
  /// @throws as `HeatOperators`; ResourceExhausted where a marching solver's would not fit into memory
  const HeatOperators& operators() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace ahm
