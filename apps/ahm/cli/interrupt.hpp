/// \file
/// Ctrl-C and kill: no half-written file, gone within a second.
#pragma once

namespace ahm::app {

/// On SIGINT, SIGTERM and (unless it is ignored, as under nohup) SIGHUP removes unfinished output files and ends the
/// process with 128 + the signal's number; makes writing to a closed pipe, or past a limit of the file size, an error
/// instead of a signal. Call once, before any thread is started.
///
/// The process ends without unwinding: the longest stage, the factorization, cannot be interrupted.
void install_interrupt_handling();

}  // namespace ahm::app
