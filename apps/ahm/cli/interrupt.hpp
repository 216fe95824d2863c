/// \file
/// Ctrl-C, kill and exceptions that nobody can catch: no half-written file, gone within a second.
#pragma once

#include <string>

namespace ahm::app {

/// On SIGINT, SIGTERM and (unless it is ignored, as under nohup) SIGHUP removes unfinished output files and ends the
/// process with 128 + the signal's number; makes writing to a closed pipe, or past a limit of the file size, an error
/// instead of a signal. Likewise, with status 1 and a message, where memory runs out in what may not throw. Call once, before any
/// thread is started.
///
/// The process ends without unwinding: the longest stage, the factorization, cannot be interrupted.
/// @param program  its name, as it appears in what is said then
void install_interrupt_handling(const std::string& program);

}  // namespace ahm::app
