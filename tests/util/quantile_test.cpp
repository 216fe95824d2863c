// Order statistics are those of a sort, on any number of threads.
#include "ahm/util/quantile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace ahm::test {
namespace {

using Numbers = std::vector<double>;

Numbers numbers(std::size_t n, const std::function<double(std::size_t)>& number) {
  Numbers result(n);
  for (std::size_t k = 0; k < n; ++k) result[k] = number(k);
  return result;
}

void expect_values_of_a_sort(const Numbers& values) {
  Numbers sorted = values;
  std::sort(sorted.begin(), sorted.end());
  for (const std::size_t at : {std::size_t{0}, sorted.size() / 3, sorted.size() / 2, sorted.size() - 1})
    for (const unsigned threads : {1u, 2u, 5u}) {
      Numbers copy = values;
      ASSERT_EQ(detail::value_at(copy, at, threads), sorted[at]) << at << " of " << sorted.size();
    }
}

TEST(ValueAt, IsThatOfASort) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const std::size_t n : {1u, 2u, 1000u, 32'768u, 32'769u, 300'000u}) {
    expect_values_of_a_sort(numbers(n, [&](std::size_t) { return normal(random); }));
    expect_values_of_a_sort(numbers(n, [](std::size_t) { return 7.0; }));
    expect_values_of_a_sort(numbers(n, [&](std::size_t) { return std::floor(3 * normal(random)); }));
    expect_values_of_a_sort(numbers(n, [](std::size_t k) { return k % 3 == 0 ? -INFINITY : static_cast<double>(k); }));
  }
}

/// The values in the sample differ from all others.
TEST(ValueAt, IsThatOfASortWhereTheSampleMisleads) {
  const std::size_t n = 1 << 17, step = n >> 10;
  const auto small = [](std::size_t k) { return static_cast<double>(k % 97); };
  expect_values_of_a_sort(numbers(n, [&](std::size_t k) { return k % step == 0 ? 1e6 + small(k) : small(k); }));
  expect_values_of_a_sort(numbers(n, [&](std::size_t k) { return k % step == 0 ? small(k) - 1e6 : small(k); }));
}

TEST(Median, IsTheLargerOfTwoInTheMiddle) {
  Numbers odd{5, 1, 3}, even{4, 1, 3, 2};
  EXPECT_EQ(detail::median(odd), 3);
  EXPECT_EQ(detail::median(even), 3);
}

}  // namespace
}  // namespace ahm::test
