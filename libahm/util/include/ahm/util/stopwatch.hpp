/// \file
/// Measures wall-clock time. Not part of the public interface.
#pragma once

#include <chrono>
#include <utility>

namespace ahm::detail {

class Stopwatch {
 public:
  /// Seconds since the previous call, or since construction.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace ahm::detail
