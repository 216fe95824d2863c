/// \file
/// The first steps of every subcommand that maps: read, build the graph, factor, solve.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "ahm/maps/log_map_solver.hpp"
#include "cli/journal.hpp"
#include "input/backend.hpp"

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

/// A source where the user wants it. @param option  that asked for it, for messages
/// @throws InvalidArgument
ResolvedSource resolve(const Model& model, const SourceSpec& spec, const std::optional<Vec3>& u_axis,
                       const std::string& option);

/// The vertex of the graph at a row of the input or nearest to a position.
/// @throws InvalidArgument, also for a point in a face
Vertex vertex_at(const Surface& surface, const SourceSpec& spec, const std::string& option);

/// The source of --source and --u-axis.
/// @throws InvalidArgument, also where the surface bends alike in all directions, or its directions are noise
ResolvedSource resolve(const RunOptions& options, const Model& model);

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
