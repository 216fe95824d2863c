/// \file
/// Logarithmic maps by the affine heat method, on any tangent graph.
///
/// \code
/// ahm::LogMapSolver solver(graph);                                  // factors once
/// ahm::LogMap map = solver.solve(ahm::Source::at_vertex(42));      // then each map costs a few triangular solves
/// \endcode
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "ahm/heat_operators.hpp"
#include "ahm/log_map.hpp"
#include "ahm/source.hpp"

namespace ahm {

struct MapOptions {
  Variant variant = Variant::adaptive;
  /// Vertices farther than this from the source get `Status::radius`. Outside units; > 0.
  double radius = std::numeric_limits<double>::infinity();
  /// Threads for a batch; 0: one per core. The result does not depend on it.
  unsigned threads = 0;
  Progress progress;
};

/// Solves for log maps on one graph. Immutable: `solve` is const and may be called from many threads at once.
class LogMapSolver {
 public:
  /// Factors the graph's two operators.
  /// @param graph  must outlive the solver
  /// @throws as `HeatOperators`
  explicit LogMapSolver(const TangentGraph& graph, const OperatorOptions& options = {});
  explicit LogMapSolver(TangentGraph&&, const OperatorOptions& = {}) = delete;

  /// The log map of one source (Alg. 1 or Alg. 2 with the homogeneous coordinate eliminated, docs/method.md).
  /// @throws InvalidArgument when the source does not fit the graph (index, dimension, a reflection on a `rotation2`
  /// graph)
  ///         or an option is out of range; Cancelled
  LogMap solve(const Source& source, const MapOptions& options = {}) const;

  /// Many sources as blocks of right-hand sides: the same numbers in the same order as one block at a time on one
  /// thread.
  std::vector<LogMap> solve(std::span<const Source> sources, const MapOptions& options = {}) const;

  const TangentGraph& graph() const noexcept { return *graph_; }
  const HeatOperators& operators() const noexcept { return operators_; }

 private:
  const TangentGraph* graph_;
  HeatOperators operators_;
};

}  // namespace ahm
