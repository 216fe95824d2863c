/// \file
/// `ahm logmap --estimate`
#pragma once

#include "commands/logmap.hpp"

namespace ahm::app {

/// Prints the estimated time and memory of a map for each strategy. Without a source it only reads the input and estimates from its
/// size. With a source it builds the graph and estimates from that.
void run_estimate(const LogmapOptions& options, bool has_source);

}  // namespace ahm::app
