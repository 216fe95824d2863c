/// \file
/// The options that an input was opened with, as they stand in a command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ahm/applications/any_solver.hpp"
#include "cli/journal.hpp"
#include "cli/options.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// Without the path; those that are not as usual.
std::vector<std::string> words(const InputOptions& options);

/// The solver of the options, which also sets variant and threads of all maps.
/// @param maps  how many are expected; 0: many
/// @throws ResourceExhausted where a global solve would swap
LogMapSolver make_solver(const SolveOptions& options, const TangentGraph& graph, Journal& journal, int maps = 1);

/// What the options say of single maps: the radius. With frames, for directions in space.
MapOptions map_options(const SolveOptions& options);

/// What they say of exact maps: the radius, too.
ExactMapOptions exact_options(const SolveOptions& options, Journal& journal);

/// One map; the journal tells the strategy.
LogMap solve(const SolveOptions& options, const LogMapSolver& solver, const Source& source, Journal& journal);

/// What makes the maps of a subcommand that needs several, by the method of the options.
struct Maps {
  /// @param count  maps that are expected; 0: many. @throws as `make_solver`, `ExactGeodesics`
  Maps(const SolveOptions& options, const Input& input, Journal& journal, int count);
  /// One of them. @param source  of `spec`. @throws as `solve`
  LogMap map(const SolveOptions& options, const Input& input, const SourceSpec& spec, const SurfaceSource& source,
             Journal& journal) const;
  AnySolver maker() const {
    return solver ? AnySolver(*solver) : polar ? AnySolver(*polar, exact.threads) : AnySolver(*geodesics, exact);
  }

  std::optional<LogMapSolver> solver;
  std::optional<PolarMapSolver> polar;
  std::optional<ExactGeodesics> geodesics;
  ExactMapOptions exact;
};

/// The one map of a subcommand, by the method of the options.
/// @param source  of `spec`
/// @throws InvalidArgument where the method needs faces that the input does not have, and as `make_solver`
LogMap solve(const SolveOptions& options, const Input& input, const SourceSpec& spec, const SurfaceSource& source,
             Journal& journal);

}  // namespace ahm::app
