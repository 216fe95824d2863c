/// \file
/// The options that an input was opened with, as they stand in a command line.
#pragma once

#include <string>
#include <vector>

#include "cli/options.hpp"

namespace ahm::app {

/// Without the path; those that are not as usual.
std::vector<std::string> words(const InputOptions& options);

}  // namespace ahm::app
