/// \file
/// Standard output, standard error, progress display and the user's browser.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "ahm/progress.hpp"

namespace ahm::app {

/// Starts xdg-open, which opens an address in the user's browser.
/// @return whether it was started; false without a desktop. Whether the browser opens is unknown
bool open_browser(const std::string& address);

/// Writes to standard error. Ignores failures, which cannot be reported anywhere.
void print_to_stderr(std::string_view text);

/// Writes "ahm: warning: <text>" to standard error.
void warn(std::string_view text);

/// Thrown by `print` when the reader has closed standard output. Not an `ahm::Error`, because it is not reported.
struct BrokenPipe {};

/// Writes to standard output and flushes.
/// @throws BrokenPipe, IoError (a full disk)
void print(std::string_view text);

/// Whether standard error is a terminal.
bool is_terminal();

/// Draws the progress on standard error during its lifetime, and clears the line at the end. Draws nothing in the first second, or if
/// standard error is not a terminal.
class ProgressDisplay {
 public:
  /// @param shown  false: never draws
  explicit ProgressDisplay(bool shown = true);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// Sets the stage that is running and the completed fraction of it.
  void update(std::string_view stage, double fraction);

  /// Callbacks for the library that call `update`. The display must outlive the calls that use them.
  Progress progress();

  /// Clears the line for other output, until the next update.
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
  std::jthread painter_;  // last, because the thread uses the members above
};

}  // namespace ahm::app
