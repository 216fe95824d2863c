/// \file
/// Wall-clock seconds of the stages of a run.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace ahm::app {

/// Stages in the order they ran. `start` ends the stage before.
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

}  // namespace ahm::app
