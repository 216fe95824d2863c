/// \file
/// The first steps of every subcommand that maps: read, build the graph, factor, solve.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ahm/log_map_solver.hpp"
#include "backend.hpp"
#include "journal.hpp"

namespace ahm::app {

/// The input and what a backend made of it.
struct Surface {
  io::Geometry input;
  std::string backend;
  std::unique_ptr<Model> model;
};

/// Reads the input, chooses the backend and builds the graph; warnings go to the journal.
/// @throws InvalidGeometry where there are no points; what the reader and the backend throw
Surface open_surface(const RunOptions& options, Journal& journal);

/// The solver of the options: t_coef, ordering, strategy, order, accuracy.
/// @param maps  how many are expected
/// @throws ResourceExhausted where a global solve would swap
LogMapSolver make_solver(const RunOptions& options, const Model& model, Journal& journal, int maps = 1);

/// One map by variant, radius and threads of the options, with frames; the journal tells the strategy.
LogMap solve(const RunOptions& options, const LogMapSolver& solver, const Source& source, Journal& journal);

/// The head of a summary for programs: program, input, output, backend.
nlohmann::ordered_json summary(const std::string& program, const RunOptions& options, const Surface& surface);

/// Ends a summary with warnings, times and memory, and delivers it: JSON to --json, text to people, on standard error
/// where standard output is taken.
void deliver(nlohmann::ordered_json summary, const std::string& text, const RunOptions& options,
             const Journal& journal);

}  // namespace ahm::app
