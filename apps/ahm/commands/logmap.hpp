/// \file
/// The command line of `ahm logmap`.
#pragma once

#include <string>

#include "cli/options.hpp"

namespace ahm::app {

/// One map: of one input, from one source.
struct LogmapOptions {
  InputOptions input;
  SourceOptions source;
  SolveOptions solve;
  OutputOptions output;
  bool gradient = false;  ///< columns with the direction away from the source
  std::string corners;    ///< file for the faces with u, v at every corner
  bool estimate = false;  ///< tell what the run would cost instead of running
};

}  // namespace ahm::app
