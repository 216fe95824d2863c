/// \file
/// Progress and cancellation of long calls.
///
/// \code
/// ahm::StopSource stop;                        // stop.request_stop() from any thread cancels
/// ahm::Progress progress{[](std::string_view stage, double f) { show(stage, f); }, stop.get_token()};
/// \endcode
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "ahm/error.hpp"
#include "ahm/stop_token.hpp"

namespace ahm {

/// Callbacks of a long call: progress reports and cancellation. Default: no reports, no cancellation.
struct Progress {
  /// Receives the name of the stage and its completed fraction in [0, 1]. Called from any thread, one call at a time.
  std::function<void(std::string_view stage, double fraction)> report;
  /// Checked between stages and between the blocks of a stage. A sparse factorization is one block: it takes about a second
  /// for 200,000 vertices and cannot be interrupted.
  StopToken stop;

  /// Reports progress, then throws `Cancelled` if a stop was requested.
  void step(std::string_view stage, double fraction) const {
    if (report) report(stage, fraction);
    if (stop.stop_requested()) throw Cancelled("cancelled during " + std::string(stage));
  }
};

}  // namespace ahm
