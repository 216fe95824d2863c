/// \file
/// `ahm logmap --estimate`
#pragma once

#include <string>

#include "cli/options.hpp"

namespace ahm::app {

/// Tells what time and memory a map would take by either strategy, and runs nothing but the reader.
/// @param json  as --json
void run_estimate(const InputOptions& input, const SolveOptions& solve, const std::string& json);

}  // namespace ahm::app
