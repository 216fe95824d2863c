/// \file
/// The command line of `ahm logmap`.
#pragma once

#include <string>

#include "cli/options.hpp"

namespace ahm::app {

/// Options of one map: one input, one source.
struct LogmapOptions {
  InputOptions input;
  SourceOptions source;
  SolveOptions solve;
  OutputOptions output;
  bool gradient = false;  ///< write columns with the direction away from the source
  std::string corners;    ///< file for the faces with (u, v) at every corner
  bool estimate = false;  ///< print the estimated time and memory instead of running
};

}  // namespace ahm::app
