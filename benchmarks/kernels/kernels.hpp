/// \file
/// The kernels one by one, on one thread: ahm-bench kernels [--benchmark_filter=REGEX ...].
///
/// Times and rates are in CPU time, so that a busy machine distorts them less. Rates stand beside what the same thread
/// can do: "of copy" is the share of a copy of memory as in STREAM, "of gemm" the share of the BLAS's matrix product,
/// both measured right after the kernel. Where n is small enough for the caches, the share may be above 1.
#pragma once

#include <string>
#include <vector>

namespace ahm::bench {

/// Runs Google Benchmark with these options; returns the exit status.
int run_kernels(std::vector<std::string> options);

}  // namespace ahm::bench
