/// \file
/// From argv to what is to be done.
#pragma once

#include <functional>
#include <string>

namespace ahm::app {

/// The command line cannot be understood: exit status 2.
struct UsageError {
  std::string message;
};

/// Reads the command line; calling the result does what it asks for. All numbers are checked here, and every message
/// names the option.
/// @throws UsageError
std::function<void()> parse_command_line(int argc, const char* const* argv);

}  // namespace ahm::app
