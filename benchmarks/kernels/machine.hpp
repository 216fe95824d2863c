/// \file
/// Compares kernels with the speed of the machine on one thread.
#pragma once

#include <benchmark/benchmark.h>

#include "speed.hpp"

namespace ahm::bench {

/// Runs the benchmark's iterations; returns the CPU time of one, in seconds.
template <class Work>
double run(benchmark::State& state, const Work& work) {
  const double start = cpu_seconds();
  for (auto _ : state) work();
  return (cpu_seconds() - start) / static_cast<double>(state.iterations());
}

/// Reports bytes of memory traffic as "GB/s" and as a share of `copy_bandwidth()`.
void report_bandwidth(benchmark::State& state, double bytes, double seconds);

/// Reports real operations as "GFlop/s" and as a share of `arithmetic_speed()`.
void report_flops(benchmark::State& state, double flops, double seconds);

}  // namespace ahm::bench
