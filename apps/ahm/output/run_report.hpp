/// \file
/// What `ahm logmap` tells about a run.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "ahm/maps/log_map_solver.hpp"
#include "cli/options.hpp"
#include "cli/stage_times.hpp"
#include "input/backend.hpp"
#include "output/map_rows.hpp"

namespace ahm::app {

/// The parts of a finished run. References live as long as the call that is given them.
struct Run {
  const RunOptions& options;
  const io::Geometry& input;
  std::string backend;
  const Model& model;
  const LogMapSolver& solver;
  const ResolvedSource& source;
  const LogMap& map;
  const MapRows& rows;
  const StageTimes& times;
  const std::vector<std::string>& warnings;
};

/// The summary for programs.
nlohmann::ordered_json run_as_json(const Run& run);

/// The summary for people, a few lines.
std::string run_as_text(const Run& run);

/// What was done instead of or besides a factorization: "march: 18 bands, largest of 23675 vertices".
std::string strategy_as_text(const LogMap& map);

/// Writes JSON to standard output ("-"), to a file, or not at all (""). Names that are not UTF-8 are made so.
/// @throws IoError, BrokenPipe
void write_json(const std::string& target, const nlohmann::ordered_json& json);

}  // namespace ahm::app
