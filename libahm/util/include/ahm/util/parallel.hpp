/// \file
/// Parallel loops for the library and its backends. Not part of the public interface.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <vector>

#include "ahm/types.hpp"
#include "ahm/util/mutex.hpp"

#ifndef AHM_NO_THREADS
#include <system_error>
#include <thread>
#endif

namespace ahm::detail {

#ifdef AHM_NO_THREADS
inline unsigned thread_count(unsigned) { return 1; }

/// Calls work().
template <class Work>
void on_threads(Offset, const Work& work) {
  work();
}
#else
/// The number of threads to use. Builds without threads have one.
/// @param requested  0: one per core
inline unsigned thread_count(unsigned requested) {
  return requested > 0 ? requested : std::max(1u, std::thread::hardware_concurrency());
}

/// Threads that are joined at the end. Older standard libraries have no std::jthread.
struct ThreadPool {
  ThreadPool() = default;
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  ~ThreadPool() {
    for (std::thread& thread : threads) thread.join();
  }
  std::vector<std::thread> threads;
};

/// Calls work() on `count` threads, the calling one included; on fewer if the system cannot start more.
template <class Work>
void on_threads(Offset count, const Work& work) {
  ThreadPool pool;
  try {
    for (Offset t = 1; t < count; ++t) pool.threads.emplace_back(work);
  } catch (const std::system_error&) {
  }
  work();
}
#endif

/// Calls body(begin, end) on consecutive chunks of [0, n), each at most `chunk` long. Chunks do not depend on the number of threads.
/// An exception stops the loop. If several chunks throw, the exception of the first chunk is rethrown, for any number of threads.
template <class Body>
void parallel_chunks(Offset n, Offset chunk, unsigned threads, const Body& body) {
  const Offset chunks = (n + chunk - 1) / chunk;
  std::atomic<Offset> next{0};
  Offset failed = chunks;
  std::exception_ptr error;
  Mutex error_mutex;
  const auto work = [&] {
    for (Offset c; (c = next.fetch_add(1)) < chunks;) try {
        body(c * chunk, std::min(n, (c + 1) * chunk));
      } catch (...) {
        const Lock lock(error_mutex);
        if (c < failed) {
          failed = c;
          error = std::current_exception();
        }
        next = chunks;
      }
  };
  on_threads(std::min<Offset>(thread_count(threads), chunks), work);
  if (error) std::rethrow_exception(error);
}

/// Calls body(i) for every i in [0, n), in chunks on several threads.
template <class Body>
void for_each_index(std::size_t n, unsigned threads, const Body& body) {
  parallel_chunks(static_cast<Offset>(n), 1 << 14, threads, [&](Offset begin, Offset end) {
    for (Offset i = begin; i < end; ++i) body(static_cast<std::size_t>(i));
  });
}

/// Sorts values on several threads.
/// @param less  strict total order; no two values may be equivalent
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

/// Runs two tasks, in parallel if there are two threads or more (0: one per core). Rethrows the exception of `first`, or else that of
/// `second`, after both have ended.
template <class First, class Second>
void run_both(unsigned threads, const First& first, const Second& second) {
  parallel_chunks(2, 1, threads, [&](Offset begin, Offset) { begin == 0 ? first() : second(); });
}

}  // namespace ahm::detail
