/// \file
/// Solvers and maps of a subcommand, from its options.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ahm/applications/any_solver.hpp"
#include "cli/journal.hpp"
#include "cli/options.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// A solver with the options, which also set the variant and threads of all maps.
/// @param maps  expected number of maps; 0: many
/// @throws ResourceExhausted (the factors of a global solve do not fit the memory)
LogMapSolver make_solver(const SolveOptions& options, const TangentGraph& graph, Journal& journal, int maps = 1);

/// Options of single maps: the radius. Maps keep their frames, which directions in space require.
MapOptions map_options(const SolveOptions& options);

/// Options of exact maps: the radius and the threads.
ExactMapOptions exact_options(const SolveOptions& options, Journal& journal);

/// Computes one map, and reports its strategy with --verbose.
LogMap solve(const SolveOptions& options, const LogMapSolver& solver, const Source& source, Journal& journal);

/// The solver of the method in the options, for a subcommand with several maps.
struct Maps {
  /// @param count  expected number of maps; 0: many. @throws as `make_solver`, `ExactGeodesics`
  Maps(const SolveOptions& options, const Input& input, Journal& journal, int count);
  /// Computes one map. @param source  the source of `spec`. @throws as `solve`
  LogMap map(const SolveOptions& options, const Input& input, const SourceSpec& spec, const SurfaceSource& source,
             Journal& journal) const;
  AnySolver maker() const {
    return solver  ? AnySolver(*solver)
           : polar ? AnySolver(*polar, exact.threads)
                   : AnySolver(*geodesics, exact.threads);
  }

  std::optional<LogMapSolver> solver;
  std::optional<PolarMapSolver> polar;
  std::optional<ExactGeodesics> geodesics;
  ExactMapOptions exact;
};

/// Computes the single map of a subcommand by the method in the options.
/// @param source  the source of `spec`
/// @throws InvalidArgument (the method requires faces, and the input has none), and as `make_solver`
LogMap solve(const SolveOptions& options, const Input& input, const SourceSpec& spec, const SurfaceSource& source,
             Journal& journal);

}  // namespace ahm::app
