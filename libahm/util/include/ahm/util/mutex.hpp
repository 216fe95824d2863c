/// \file
/// A mutex, which does nothing in builds without threads (AHM_WITH_THREADS=OFF). Not part of the public interface.
#pragma once

#ifndef AHM_NO_THREADS
#include <mutex>
#endif

namespace ahm::detail {

#ifdef AHM_NO_THREADS
class Mutex {};
class Lock {
 public:
  explicit Lock(Mutex&) {}
  ~Lock() {}  // not trivial, so that compilers do not report unused locks
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
};
#else
using Mutex = std::mutex;
using Lock = std::scoped_lock<std::mutex>;
#endif

}  // namespace ahm::detail
