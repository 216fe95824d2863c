/// \file
/// Sizes of the scaling experiments, each measured in a process of its own.
///
/// \code
/// for (Index n : sizes(settings, 1000, {10000, 100000})) {
///   const auto numbers = in_own_process(2, [&] { return std::vector{seconds(work), peak_megabytes()}; });
/// }
/// \endcode
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>
#include <vector>

#include "experiments/experiment.hpp"
#include "measure.hpp"

namespace ahm::bench {

/// The sizes of the settings if there are any, otherwise `toy` or `usual`.
inline std::vector<Index> sizes(const Settings& settings, Index toy, std::vector<Index> usual) {
  if (!settings.vertices.empty()) return settings.vertices;
  return settings.toy ? std::vector<Index>{toy} : usual;
}

/// The `count` numbers that `work` returns. It runs in a process of its own, so that the peak memory is that of this work.
/// @throws std::runtime_error (no process, or the work fails)
template <class Work>
std::vector<double> in_own_process(std::size_t count, const Work& work) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("cannot open a pipe for a measurement");
  const auto bytes = static_cast<ssize_t>(count * sizeof(double));
  const pid_t child = fork();
  if (child == 0) {
    bool written = false;
    try {
      const std::vector<double> numbers = work();
      written = numbers.size() == count && write(ends[1], numbers.data(), count * sizeof(double)) == bytes;
    } catch (const std::exception&) {
    }
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  std::vector<double> numbers(count);
  const bool complete = child > 0 && read(ends[0], numbers.data(), count * sizeof(double)) == bytes;
  close(ends[0]);
  if (child > 0) waitpid(child, nullptr, 0);
  if (!complete) throw std::runtime_error("a measurement failed in its process (out of memory?)");
  return numbers;
}

}  // namespace ahm::bench
