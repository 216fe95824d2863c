/// \file
/// Standard output, standard error, progress display and the user's browser.
#pragma once

#include <memory>
#include <string>
#include <string_view>

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
  struct Painter;
  std::unique_ptr<Painter> painter_;  ///< null: draws nothing
};

}  // namespace ahm::app
