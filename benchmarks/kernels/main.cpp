// The kernels one by one, on one thread: bench_kernels [--benchmark_filter=REGEX ...]
//
// Times and rates are in CPU time, so that a busy machine distorts them less. Rates stand beside what the same thread can
// do: "of copy" is the share of a copy of memory as in STREAM, "of gemm" the share of the BLAS's matrix product, both
// measured right after the kernel. Where n is small enough for the caches, the share may be above 1.
#include <benchmark/benchmark.h>

#include "ahm/heat/heat_operators.hpp"
#include "heat/blas_control.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  const ahm::LinearAlgebraInfo info = ahm::linear_algebra_info();
  benchmark::AddCustomContext("CHOLMOD", info.cholmod);
  benchmark::AddCustomContext("BLAS", info.blas);
  ahm::without_openmp_regions([] { benchmark::RunSpecifiedBenchmarks(); });
}
