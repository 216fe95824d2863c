/// \file
/// Speed of memory and BLAS on one thread, in processor time, which a busy machine hardly changes. Every call measures
/// again, since the speed of a shared machine varies.
///
/// \code
/// const double share = flops / ahm::bench::median_cpu_seconds(work) / ahm::bench::gemm_speed(false);
/// \endcode
#pragma once

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <complex>
#include <vector>

namespace ahm::bench {

/// CPU time of the process, seconds.
double cpu_seconds();

/// CPU time of one call, seconds.
template <class Work>
double cpu_seconds_of(Work&& work) {
  const double start = cpu_seconds();
  work();
  return cpu_seconds() - start;
}

/// CPU time of a call, seconds: median of five.
template <class Work>
double median_cpu_seconds(Work&& work) {
  std::array<double, 5> times;
  for (double& time : times) time = cpu_seconds_of(work);
  std::ranges::sort(times);
  return times[2];
}

/// Speed of a copy as in STREAM, bytes per second: the bytes read plus the bytes written. The arrays are far larger than
/// the caches. Median of five.
double copy_bandwidth();

/// Real floating point operations per second of the BLAS: dgemm or zgemm of matrices 512 x 512. Median of five.
double gemm_speed(bool is_complex);

/// The arrays of STREAM.
struct Stream {
  static constexpr std::size_t length = std::size_t{1} << 24;  // 128 MiB per array
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

template <class Number>
using Gemm = void(const char*, const char*, const int*, const int*, const int*, const Number*, const Number*,
                  const int*, const Number*, const int*, const Number*, Number*, const int*);

/// A product of two matrices by the BLAS of this process.
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
};
using RealProduct = Product<double>;
using ComplexProduct = Product<std::complex<double>>;

}  // namespace ahm::bench
