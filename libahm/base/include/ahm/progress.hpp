/// \file
/// Progress and cancellation of long calls.
///
/// \code
/// std::stop_source stop;                       // stop.request_stop() from any thread cancels
/// ahm::Progress progress{[](std::string_view stage, double f) { show(stage, f); }, stop.get_token()};
/// \endcode
#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <string_view>

#include "ahm/error.hpp"

namespace ahm {

/// How a long call reports and is stopped. Default: silent, never stopped.
struct Progress {
  /// Called with the stage's name and the fraction of it that is done, in [0, 1]. May be called from any thread, one at
  /// a time.
  std::function<void(std::string_view stage, double fraction)> report;
  /// Checked between stages and between the blocks of a stage. A sparse factorization is one block: it takes about a second
  /// for 200,000 vertices and cannot be interrupted.
  std::stop_token stop;

  /// Reports, then throws `Cancelled` when a stop was requested.
  void step(std::string_view stage, double fraction) const {
    if (report) report(stage, fraction);
    if (stop.stop_requested()) throw Cancelled("cancelled during " + std::string(stage));
  }
};

}  // namespace ahm
