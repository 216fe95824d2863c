#include "speed.hpp"

#include <time.h>

#include "cholesky/blas.hpp"

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

double gemm_speed(bool is_complex) {
  OneBlasThread one_thread;
  const auto speed = [](auto product) { return product.flops / median_cpu_seconds(product); };
  return is_complex ? speed(ComplexProduct()) : speed(RealProduct());
}

}  // namespace ahm::bench
