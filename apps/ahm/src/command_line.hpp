/// \file
/// From argv to options.
#pragma once

#include <string>
#include <variant>

#include "options.hpp"

namespace ahm::app {

/// The command line cannot be understood: exit status 2.
struct UsageError {
  std::string message;
};

/// The command line asks only for text (help, version).
struct TextRequest {
  std::string text;
};

using Command = std::variant<LogmapOptions, LocalMapsOptions, CoverageCommandOptions, InfoOptions, TextRequest>;

/// Reads the command line. All numbers are checked here, and every message names the option.
/// @throws UsageError
Command parse_command_line(int argc, const char* const* argv);

}  // namespace ahm::app
