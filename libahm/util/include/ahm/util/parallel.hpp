/// \file
/// Loops over threads, for the library and its backends. Not part of the public interface.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::detail {

/// The number of threads asked for; 0 means one per core.
inline unsigned thread_count(unsigned requested) {
  return requested > 0 ? requested : std::max(1u, std::thread::hardware_concurrency());
}

/// Calls body(begin, end) on consecutive chunks of [0, n), each at most `chunk` long. Chunks do not depend on the
/// number of threads. An exception stops the loop; of several that of the first chunk is rethrown, the same on any number of threads.
template <class Body>
void parallel_chunks(Offset n, Offset chunk, unsigned threads, const Body& body) {
  const Offset chunks = (n + chunk - 1) / chunk;
  std::atomic<Offset> next{0};
  Offset failed = chunks;
  std::exception_ptr error;
  std::mutex error_mutex;
  auto work = [&] {
    for (Offset c; (c = next.fetch_add(1)) < chunks;) try {
        body(c * chunk, std::min(n, (c + 1) * chunk));
      } catch (...) {
        std::scoped_lock lock(error_mutex);
        if (c < failed) {
          failed = c;
          error = std::current_exception();
        }
        next = chunks;
      }
  };
  const auto workers = std::min<Offset>(thread_count(threads), chunks);
  {
    std::vector<std::jthread> pool;
    try {
      for (Offset t = 1; t < workers; ++t) pool.emplace_back(work);
    } catch (const std::system_error&) {
      // No more threads to be had: those there are, and this one, do the work.
    }
    work();
  }
  if (error) std::rethrow_exception(error);
}

/// Calls body(i) for every i of [0, n), in chunks shared out over the threads.
template <class Body>
void for_each_index(std::size_t n, unsigned threads, const Body& body) {
  parallel_chunks(static_cast<Offset>(n), 1 << 14, threads, [&](Offset begin, Offset end) {
    for (Offset i = begin; i < end; ++i) body(static_cast<std::size_t>(i));
  });
}

/// Sorts by a strict total order, of which no two values are equal.
template <class T, class Less>
void parallel_sort(std::vector<T>& values, unsigned threads, const Less& less) {
  const auto n = static_cast<Offset>(values.size());
  Offset sorted = 1 << 16;
  const auto at = [&](Offset k) { return values.begin() + std::min(k, n); };
  parallel_chunks(n, sorted, threads, [&](Offset begin, Offset end) { std::sort(at(begin), at(end), less); });
  for (; sorted < n; sorted *= 2)
    parallel_chunks(n, 2 * sorted, threads, [&](Offset begin, Offset end) {
      std::inplace_merge(at(begin), at(begin + sorted), at(end), less);
    });
}

/// Runs two tasks at once on two threads or more (0: one per core), else one after the other; the first one's exception is rethrown when
/// both ended, or else the second's.
template <class First, class Second>
void run_both(unsigned threads, const First& first, const Second& second) {
  parallel_chunks(2, 1, threads, [&](Offset begin, Offset) { begin == 0 ? first() : second(); });
}

}  // namespace ahm::detail
