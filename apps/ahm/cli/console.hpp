/// \file
/// Printing that neither throws nor ends the process when the other side of a pipe has gone.
#pragma once

#include <string_view>

namespace ahm::app {

/// Writes to standard error; failures are ignored, there is nobody left to tell.
void say(std::string_view text);

/// "ahm: warning: <text>" on standard error.
void warn(std::string_view text);

/// Thrown by `print` when standard output has been closed by its reader. Not an `ahm::Error`: nothing is reported.
struct BrokenPipe {};

/// Writes to standard output and flushes.
/// @throws BrokenPipe, IoError (a full disk)
void print(std::string_view text);

/// True when standard error is a terminal.
bool is_terminal();

}  // namespace ahm::app
