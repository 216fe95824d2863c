/// \file
/// The user's browser.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "ahm/progress.hpp"

namespace ahm::app {

/// Asks the desktop (xdg-open) to show an address. Whether it does is not known: not where there is no desktop.
/// @return whether it could be asked
bool open_browser(const std::string& address);

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
