// Parallel loops: each index once, on any number of threads; the caller gets the first error.
#include "ahm/util/parallel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace ahm::test {
namespace {

TEST(ParallelChunks, CoverEachIndexOnceInFixedChunks) {
  for (Offset n : {0, 1, 9, 10, 11, 1000})
    for (unsigned threads : {1u, 3u, 64u}) {
      std::vector<std::atomic<int>> visits(static_cast<std::size_t>(n));
      std::atomic<int> uneven{0};
      detail::parallel_chunks(n, 10, threads, [&](Offset begin, Offset end) {
        uneven += begin % 10 != 0 || (end != n && end != begin + 10);
        for (Offset i = begin; i < end; ++i) ++visits[static_cast<std::size_t>(i)];
      });
      EXPECT_EQ(uneven, 0);
      for (const auto& count : visits) ASSERT_EQ(count, 1) << "n " << n << ", threads " << threads;
    }
}

TEST(ParallelSort, OrdersAsOnOneThread) {
  for (const std::size_t n : {0u, 1u, 65'536u, 65'537u, 200'000u, 524'289u}) {
    std::vector<std::uint32_t> values(n);
    std::uint32_t state = 7;
    for (std::uint32_t& value : values) value = state = state * 1664525u + 1013904223u;  // all different
    std::vector<std::uint32_t> expected = values;
    std::sort(expected.begin(), expected.end());
    for (const unsigned threads : {1u, 2u, 5u}) {
      std::vector<std::uint32_t> sorted = values;
      detail::parallel_sort(sorted, threads, std::less<>());
      ASSERT_EQ(sorted, expected) << "n " << n << ", threads " << threads;
    }
  }
}

TEST(ParallelChunks, PassOnTheFirstErrorAndStop) {
  std::atomic<int> chunks{0};
  auto body = [&](Offset begin, Offset) {
    ++chunks;
    if (begin == 0) throw std::runtime_error("first");
  };
  EXPECT_THROW(detail::parallel_chunks(1000, 1, 1, body), std::runtime_error);
  EXPECT_EQ(chunks, 1);
  EXPECT_THROW(detail::parallel_chunks(1000, 1, 4, body), std::runtime_error);
}

/// The first chunk fails when a later one has.
TEST(ParallelChunks, PassOnTheErrorOfTheFirstChunk) {
  if (detail::thread_count(2) < 2) GTEST_SKIP() << "for builds with threads";
  std::atomic<bool> later{false};
  const auto body = [&](Offset begin, Offset) {
    if (begin == 0) later.wait(false);
    later = true;
    later.notify_all();
    throw std::runtime_error(begin == 0 ? "first" : "later");
  };
  try {
    detail::parallel_chunks(2, 1, 2, body);
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "first");
  }
}

TEST(ForEachIndex, VisitsEachOnce) {
  std::vector<int> visits(40000, 0);
  detail::for_each_index(visits.size(), 4, [&](std::size_t i) { ++visits[i]; });
  for (int count : visits) ASSERT_EQ(count, 1);
}

TEST(RunBoth, RunsBothTasksAndPassesOnTheErrorOfOne) {
  for (unsigned threads : {1U, 2U}) {
    int first = 0, second = 0;
    detail::run_both(
        threads, [&] { first = 1; }, [&] { second = 2; });
    EXPECT_EQ(std::pair(first, second), std::pair(1, 2));
    EXPECT_THROW(detail::run_both(
                     threads, [] {}, [] { throw std::logic_error("second"); }),
                 std::logic_error);
  }
}

TEST(ThreadCount, IsTheArgumentOrTheNumberOfCores) {
#ifdef AHM_NO_THREADS
  EXPECT_EQ(detail::thread_count(3), 1u);
  return;
#endif
  EXPECT_EQ(detail::thread_count(3), 3u);
  EXPECT_GE(detail::thread_count(0), 1u);
}

}  // namespace
}  // namespace ahm::test
