/// \file
/// Time and memory of a piece of work.
///
/// \code
/// const double seconds = min_seconds([&] { solver.solve(source); });
/// const double megabytes = added_megabytes([&] { ahm::LogMapSolver(graph).solve(source); });
/// \endcode
#pragma once

#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <limits>

#include "measure.hpp"

namespace ahm::bench {

/// The least of up to five times, s. @param measure  runs once and returns its seconds
template <class Measure>
double least_seconds(const Measure& measure) {
  double least = std::numeric_limits<double>::infinity(), sum = 0;
  for (int run = 0; run < 5 && sum < 5; ++run) {
    const double time = measure();
    least = std::min(least, time);
    sum += time;
  }
  return least;
}

/// Shortest wall-clock time of five runs, or of as many as fit into five seconds. Other work of the machine only adds time.
template <class Work>
double min_seconds(const Work& work) {
  return least_seconds([&] { return seconds(work); });
}

/// Largest memory that the work adds, MB, measured in a process of its own. NaN where there can be no process or the work
/// throws.
template <class Work>
double added_megabytes(const Work& work) {
  double added = std::numeric_limits<double>::quiet_NaN();
  int ends[2];
  if (pipe(ends) != 0) return added;
  malloc_trim(0);  // returns free memory to the system, which the work would otherwise use first
  const pid_t child = fork();
  if (child == 0) {
    const double before = peak_megabytes();
    try {
      work();
      added = peak_megabytes() - before;
    } catch (const std::exception&) {
    }
    _exit(write(ends[1], &added, sizeof added) == sizeof added ? 0 : 1);
  }
  close(ends[1]);
  if (child > 0) {
    if (read(ends[0], &added, sizeof added) != sizeof added) added = std::numeric_limits<double>::quiet_NaN();
    waitpid(child, nullptr, 0);
  }
  close(ends[0]);
  return added;
}

}  // namespace ahm::bench
