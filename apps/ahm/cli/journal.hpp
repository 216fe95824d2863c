/// \file
/// Stage times, progress and warnings of a run.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/console.hpp"
#include "cli/options.hpp"
#include "cli/system_info.hpp"
#include "output/wording.hpp"

namespace ahm::app {

/// Wall-clock seconds of the stages in the order in which they ran. `start` ends the previous stage.
class StageTimes {
 public:
  void start(std::string stage) {
    finish();
    running_ = true;
    seconds_.emplace_back(std::move(stage), 0.0);
    begin_ = Clock::now();
  }

  void finish() {
    if (running_) seconds_.back().second = std::chrono::duration<double>(Clock::now() - begin_).count();
    running_ = false;
  }

  const std::vector<std::pair<std::string, double>>& seconds() const noexcept { return seconds_; }

  double total() const {
    double sum = 0;
    for (const auto& [stage, s] : seconds_) sum += s;
    return sum;
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::vector<std::pair<std::string, double>> seconds_;
  Clock::time_point begin_;
  bool running_ = false;
};

/// Stage times, progress and warnings of one run.
class Journal {
 public:
  explicit Journal(Verbosity verbosity) : verbosity_(verbosity), display_(verbosity != Verbosity::quiet) {}

  void start(const std::string& stage) {
    finish();
    times_.start(stage);
    display_.update(stage, 0);
  }

  void finish() {
    times_.finish();
    if (!is_verbose() || times_.seconds().size() == reported_) return;
    display_.clear();
    const auto& [stage, seconds] = times_.seconds()[reported_++];
    print_to_stderr(
        fmt::format("ahm: {:<8}{:8.3f} s   peak memory {}\n", stage, seconds, bytes_as_text(peak_rss_bytes())));
  }

  /// Prints a line with --verbose.
  void add_detail(const std::string& text) {
    finish();
    if (is_verbose()) print_to_stderr(fmt::format("ahm: {}\n", text));
  }

  void add_warning(const std::string& text) {
    display_.clear();
    if (verbosity_ != Verbosity::quiet) warn(text);
    warnings_.push_back(text);
  }

  void add_warnings(const std::vector<Warning>& warnings) {
    for (const Warning& warning : warnings) add_warning(worded(warning));
  }

  /// Records that the picture could not be written. `deliver` writes all other outputs, and then throws this message.
  void add_view_failure(const std::string& text) { view_failure_ = text; }
  const std::optional<std::string>& view_failure() const { return view_failure_; }

  Progress progress() { return display_.progress(); }
  void clear_display() { display_.clear(); }
  const StageTimes& times() const { return times_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  bool is_verbose() const { return verbosity_ == Verbosity::verbose; }

  Verbosity verbosity_;
  StageTimes times_;
  std::size_t reported_ = 0;
  std::vector<std::string> warnings_;
  std::optional<std::string> view_failure_;
  ProgressDisplay display_;
};

}  // namespace ahm::app
