/// \file
/// Parses the command line.
#pragma once

#include <functional>
#include <string>

namespace ahm::app {

/// The command line is wrong: exit status 2.
struct UsageError {
  std::string message;
};

/// Parses the command line and returns its action. Checks all numbers; every message names the option.
/// @throws UsageError
std::function<void()> parse_command_line(int argc, const char* const* argv);

}  // namespace ahm::app
