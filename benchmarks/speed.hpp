/// \file
/// Speed of memory and arithmetic on one thread, in processor time, which a busy machine hardly changes. Every call measures
/// again, since the speed of a shared machine varies.
///
/// \code
/// const double share = flops / ahm::bench::median_cpu_seconds(work) / ahm::bench::arithmetic_speed();
/// \endcode
#pragma once

#include <algorithm>
#include <array>
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

/// Real floating point operations per second where the processor is limited by nothing else: products added to sums in its widest
/// registers. Median of five.
double arithmetic_speed();

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

}  // namespace ahm::bench
