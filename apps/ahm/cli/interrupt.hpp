/// \file
/// Handles Ctrl-C, kill and uncaught exceptions: the process ends within a second and leaves no incomplete file.
#pragma once

#include <string>

namespace ahm::app {

/// Installs the handlers. Call once, before any thread is started.
///
/// On SIGINT, SIGTERM and SIGHUP (unless ignored, as under nohup) the process removes unfinished output files and exits with 128 + the
/// number of the signal. If memory runs out in a function that must not throw, it does the same with a message and status 1.
/// Writing to a closed pipe, or beyond a file size limit, becomes an error instead of a signal.
///
/// The process ends without unwinding, because the longest stage, the factorization, cannot be interrupted.
/// @param program  name of the program, for messages
void install_interrupt_handling(const std::string& program);

}  // namespace ahm::app
