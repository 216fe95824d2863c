/// \file
/// A progress bar on a terminal, for whatever takes longer than a second.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "ahm/progress.hpp"

namespace ahm::app {

/// Draws on standard error while it lives, and leaves the line empty. Draws nothing when standard error is no terminal,
/// and nothing in the first second.
class ProgressDisplay {
 public:
  /// @param shown  false: draws nothing, ever
  explicit ProgressDisplay(bool shown = true);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// Names what is running; `fraction` is the part of it that is done.
  void update(std::string_view stage, double fraction);

  /// Hands `update` to the library. The display must outlive the calls it is passed to.
  Progress progress();

  /// Clears the line, so that something else can be printed, until the next update.
  void clear();

 private:
  void run(const std::stop_token& stop);
  void draw();

  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::string stage_;
  double fraction_ = 0;
  bool drawn_ = false;
  std::jthread painter_;  // last: it uses the members above
};

}  // namespace ahm::app
