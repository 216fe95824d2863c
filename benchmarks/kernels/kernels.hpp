/// \file
/// Single kernels on one thread: ahm-bench kernels [--benchmark_filter=REGEX ...].
///
/// Times and rates use CPU time, so that a busy machine distorts them less. Rates are compared with the speed of the same
/// thread, measured right after the kernel. "of copy" is the share of a copy of memory as in STREAM; "of
/// arithmetic" the share of multiplications and additions in registers. The share may exceed 1 where n is small enough for the caches.
#pragma once

#include <string>
#include <vector>

namespace ahm::bench {

/// Runs Google Benchmark with these options; returns the exit status.
int run_kernels(std::vector<std::string> options);

}  // namespace ahm::bench
