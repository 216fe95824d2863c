/// \file
/// What the machine can do on one thread: the speed of memory and of the BLAS, measured beside the kernels.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>

namespace ahm::bench {

/// Bytes per second of a copy as in STREAM (each byte read and each byte written counts), far larger than the caches.
/// Median of five, in CPU time like the kernels' own. Measured anew by each call: a shared machine changes.
double copy_bandwidth();

/// Real floating point operations per second of the BLAS: dgemm or zgemm of matrices 512 x 512. Median of five.
double gemm_speed(bool is_complex);

/// CPU time of the process, seconds.
double cpu_seconds();

/// The same of one call: median of five.
template <class Work>
double median_cpu_seconds(Work&& work) {
  std::array<double, 5> times;
  for (double& time : times) {
    const double start = cpu_seconds();
    work();
    time = cpu_seconds() - start;
  }
  std::ranges::sort(times);
  return times[2];
}

/// Runs the benchmark's iterations; returns the CPU time of one, in seconds.
template <class Work>
double run(benchmark::State& state, const Work& work) {
  const double start = cpu_seconds();
  for (auto _ : state) work();
  return (cpu_seconds() - start) / static_cast<double>(state.iterations());
}

/// Reports bytes of memory traffic as "GB/s" and as a share of `copy_bandwidth()`.
void report_bandwidth(benchmark::State& state, double bytes, double seconds);

/// Reports real operations as "GFlop/s" and as a share of `gemm_speed`.
void report_flops(benchmark::State& state, double flops, bool is_complex, double seconds);

}  // namespace ahm::bench
