#include "machine.hpp"

#include <dlfcn.h>
#include <time.h>

#include <algorithm>
#include <complex>
#include <vector>

#include "heat/blas_control.hpp"

namespace ahm::bench {
namespace {

constexpr std::size_t length = std::size_t{1} << 24;  // 128 MiB per array

/// The arrays of STREAM.
struct Stream {
  std::vector<double> a = std::vector<double>(length, 1.0), b = std::vector<double>(length, 2.0),
                      c = std::vector<double>(length, 0.5);

  void copy() { std::copy(a.begin(), a.end(), c.begin()); }
  void triad() {
#pragma omp simd
    for (std::size_t i = 0; i < length; ++i) a[i] = b[i] + 3.0 * c[i];
  }
  double read() const {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t i = 0; i < length; ++i) sum += a[i];
    return sum;
  }
};

Stream& stream() {
  static Stream arrays;
  return arrays;
}

template <class Number>
using Gemm = void(const char*, const char*, const int*, const int*, const int*, const Number*, const Number*,
                  const int*, const Number*, const int*, const Number*, Number*, const int*);

/// A product of two matrices by the BLAS that the process started with, which is CHOLMOD's.
template <class Number>
struct Product {
  static constexpr int side = 512;
  static constexpr bool is_complex = sizeof(Number) > sizeof(double);
  static constexpr double flops = (is_complex ? 8.0 : 2.0) * side * side * side;
  std::vector<Number> x = std::vector<Number>(side * side, 1.0), y = x, z = x;

  Gemm<Number>* gemm = reinterpret_cast<Gemm<Number>*>(dlsym(RTLD_DEFAULT, is_complex ? "zgemm_" : "dgemm_"));

  void operator()() {
    const Number one = 1.0, zero = 0.0;
    gemm("N", "N", &side, &side, &side, &one, x.data(), &side, y.data(), &side, &zero, z.data(), &side);
  }

  double speed() { return flops / median_cpu_seconds(*this); }
};
using RealProduct = Product<double>;
using ComplexProduct = Product<std::complex<double>>;

void copy(benchmark::State& state) {
  Stream& arrays = stream();
  for (auto _ : state) {
    arrays.copy();
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() * 16 * static_cast<std::int64_t>(length));
}
BENCHMARK(copy)->Name("machine/copy")->Unit(benchmark::kMillisecond);

void triad(benchmark::State& state) {
  Stream& arrays = stream();
  for (auto _ : state) {
    arrays.triad();
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() * 24 * static_cast<std::int64_t>(length));
}
BENCHMARK(triad)->Name("machine/triad")->Unit(benchmark::kMillisecond);

void read(benchmark::State& state) {
  const Stream& arrays = stream();
  for (auto _ : state) benchmark::DoNotOptimize(arrays.read());
  state.SetBytesProcessed(state.iterations() * 8 * static_cast<std::int64_t>(length));
}
BENCHMARK(read)->Name("machine/read")->Unit(benchmark::kMillisecond);

template <class Multiply>
void gemm(benchmark::State& state) {
  OneBlasThread one_thread;
  Multiply multiply;
  for (auto _ : state) multiply();
  state.counters["GFlop/s"] = benchmark::Counter(1e-9 * multiply.flops, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(gemm<RealProduct>)->Name("machine/dgemm")->Unit(benchmark::kMillisecond);
BENCHMARK(gemm<ComplexProduct>)->Name("machine/zgemm")->Unit(benchmark::kMillisecond);

}  // namespace

double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double copy_bandwidth() {
  Stream& arrays = stream();
  return 16.0 * length / median_cpu_seconds([&] {
           arrays.copy();
           benchmark::ClobberMemory();
         });
}

double gemm_speed(bool is_complex) {
  OneBlasThread one_thread;
  return is_complex ? ComplexProduct().speed() : RealProduct().speed();
}

void report_bandwidth(benchmark::State& state, double bytes, double seconds) {
  state.counters["GB/s"] = 1e-9 * bytes / seconds;
  state.counters["of copy"] = bytes / seconds / copy_bandwidth();
}

void report_flops(benchmark::State& state, double flops, bool is_complex, double seconds) {
  state.counters["GFlop/s"] = 1e-9 * flops / seconds;
  state.counters["of gemm"] = flops / seconds / gemm_speed(is_complex);
}

}  // namespace ahm::bench
