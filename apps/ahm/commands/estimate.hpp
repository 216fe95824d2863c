/// \file
/// `ahm logmap --estimate`
#pragma once

#include "commands/logmap.hpp"

namespace ahm::app {

/// Tells what time and memory a map would take by either strategy. Without a source from the size of the input, for which nothing
/// but the reader runs; with one from the graph, which is built.
void run_estimate(const LogmapOptions& options, bool has_source);

}  // namespace ahm::app
