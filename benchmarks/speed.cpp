#include "speed.hpp"

#include <time.h>

#include "cholesky/registers.hpp"

namespace ahm::bench {

double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double copy_bandwidth() {
  static Stream arrays;
  return 16.0 * Stream::length / median_cpu_seconds([&] {
           arrays.copy();
           asm volatile("" : : "r"(arrays.c.data()) : "memory");  // keeps the compiler from removing the copy
         });
}

double arithmetic_speed() {
  constexpr int steps = 1 << 23;
  volatile double factor = 0.999, sink = 0;
  return in_widest_registers([&](auto N) {
    using Vector = typename Lanes<N()>::Type;
    constexpr int sums = 2 * N();  // enough to hide the latency of an operation; they fit into the registers
    const double seconds = median_cpu_seconds([&] {
      const double f = factor;
      Vector sum[sums];
      for (int k = 0; k < sums; ++k) sum[k] = Vector{} + k * f;  // different, so that the compiler keeps all
      for (int k = 0; k < steps; ++k)
#pragma GCC unroll 16
        for (int i = 0; i < sums; ++i) sum[i] = sum[i] * f + f;
      for (int i = 0; i < sums; ++i) sink = sink + sum[i][0];
    });
    return 2.0 * steps * sums * N() / seconds;
  });
}

}  // namespace ahm::bench
