/// \file
/// Medians and other order statistics. Not part of the public interface.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "ahm/types.hpp"
#include "ahm/util/parallel.hpp"

namespace ahm::detail {

/// The value at position `at` of the sorted values. Reorders the values.
/// @param values  without NaN
inline double nth_value(std::span<double> values, std::size_t at) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(at);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// As `nth_value`, on several threads. For many values, two quantiles of a sample exclude most values as too small or too large.
inline double value_at(std::span<double> values, std::size_t at, unsigned threads = 1) {
  constexpr std::size_t max_unsampled = 1 << 15, sample_size = 1 << 10, around = sample_size / 16;
  constexpr Offset chunk = 1 << 16;
  if (values.size() <= max_unsampled) return nth_value(values, at);
  std::array<double, sample_size> sample;
  for (std::size_t k = 0; k < sample_size; ++k) sample[k] = values[k * (values.size() / sample_size)];
  std::sort(sample.begin(), sample.end());
  const auto near =
      static_cast<std::size_t>(static_cast<double>(at) / static_cast<double>(values.size()) * sample_size);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double low = near < around ? -infinity : sample[near - around];
  const double high = near + around < sample_size ? sample[near + around] : infinity;

  const auto n = static_cast<Offset>(values.size());
  std::vector<std::vector<double>> between(static_cast<std::size_t>((n + chunk - 1) / chunk));
  std::atomic<std::size_t> below{0}, within{0};
  parallel_chunks(n, chunk, threads, [&](Offset begin, Offset end) {
    std::size_t smaller = 0, some = 0;
    for (Offset k = begin; k < end; ++k) {
      const double value = values[static_cast<std::size_t>(k)];
      if (value < low) {
        ++smaller;
      } else if (value <= high) {
        ++some;
        if (low < high) between[static_cast<std::size_t>(begin / chunk)].push_back(value);
      }
    }
    below += smaller;
    within += some;
  });
  if (at < below || at >= below + within) return nth_value(values, at);  // the sample was not representative
  if (low == high) return low;
  std::vector<double> all;
  all.reserve(within);
  for (const auto& part : between) all.insert(all.end(), part.begin(), part.end());
  return nth_value(all, at - below);
}

/// The median of at least one value; the larger of the two middle values if their number is even. May reorder the values.
inline double median(std::span<double> values, unsigned threads = 1) {
  return value_at(values, values.size() / 2, threads);
}

}  // namespace ahm::detail
