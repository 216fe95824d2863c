/// \file
/// What `ahm logmap` tells about a run.
#pragma once

#include <optional>
#include <string>

#include "ahm/maps/log_map_solver.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// The parts of a finished run. References live as long as the call that is given them.
struct LogmapRun {
  const std::string& path;
  const SourceSpec& spec;
  const SolveOptions& options;
  const Input& input;
  const std::optional<LogMapSolver>& solver;  ///< of heat
  const PlacedSource& source;
  const LogMap& map;
  const RowLogMap& rows;
  const std::vector<double>& quality;  ///< by row
  bool is_named = false;               ///< whether the text begins with the input and the source
};

/// Delivers the summaries, for programs and for people.
void report(const LogmapRun& run, const OutputOptions& output, Journal& journal);

}  // namespace ahm::app
