#include "cholesky/blas.hpp"

#include <dlfcn.h>
#include <sys/mman.h>

#include <climits>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <vector>

#include "ahm/error.hpp"
#include "cholesky/memory_limits.hpp"

namespace ahm {
namespace {

// The BLAS is selected when the process starts, so functions that only some BLAS libraries have are found by name.
template <class Function>
Function* find_function(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

std::mutex mutex;
int users = 0;
int threads_before = 0;

}  // namespace

OneBlasThread::OneBlasThread() {
  static auto* const get = find_function<int()>("openblas_get_num_threads");
  static auto* const set = find_function<void(int)>("openblas_set_num_threads");
  std::scoped_lock lock(mutex);
  if (users++ > 0 || !get || !set) return;
  threads_before = get();
  if (threads_before != 1) set(1);
}

OneBlasThread::~OneBlasThread() {
  static auto* const set = find_function<void(int)>("openblas_set_num_threads");
  std::scoped_lock lock(mutex);
  if (--users == 0 && set && threads_before > 1) set(threads_before);
}

namespace {

/// OpenBLAS has slots for at least 50 buffers, and prints to standard error when they are exceeded. Up to twice this number can be
/// in use.
constexpr int max_buffers = 16;
constexpr std::size_t buffer_bytes = std::size_t{128} << 20;
constexpr std::size_t room_for_others = std::size_t{32} << 20;  ///< allocations between our test and OpenBLAS's own

std::condition_variable buffer_is_free;
int buffers = 0;        // buffers that OpenBLAS keeps
int buffers_taken = 0;  // buffers reserved by callers

bool has_room_for(std::size_t bytes) {
  void* const trial = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return trial != MAP_FAILED && ::munmap(trial, bytes) == 0;
}

/// Makes OpenBLAS keep one more buffer, if there is address space for it. Callers may or may not hold their buffers at this moment.
/// So this function takes all existing buffers plus one, and requires address space for the buffers of all callers plus one.
bool add_buffer(void* (*take)(int), void (*give_back)(void*)) {
  std::vector<void*> held;  // allocated before the test below
  held.reserve(static_cast<std::size_t>(buffers) + 1);
  if (!has_room_for((static_cast<std::size_t>(buffers_taken) + 1) * buffer_bytes + room_for_others)) return false;
  while (held.size() <= static_cast<std::size_t>(buffers)) held.push_back(take(0));
  for (void* buffer : held) give_back(buffer);
  ++buffers;
  return true;
}

}  // namespace

BlasBuffer::BlasBuffer() : counted_(false) {
  static auto* const take = find_function<void*(int)>("blas_memory_alloc");
  static auto* const give_back = find_function<void(void*)>("blas_memory_free");
  if (!take || !give_back || !address_space_is_limited()) return;
  std::unique_lock lock(mutex);
  if (buffers_taken == buffers && buffers < max_buffers) add_buffer(take, give_back);
  if (buffers == 0)
    throw ResourceExhausted(
        "out of memory: the BLAS has no room for its working buffer of 128 MB of address space; raise the limit "
        "(ulimit -v), or set OPENBLAS_NUM_THREADS=1 in the environment");
  buffer_is_free.wait(lock, [] { return buffers_taken < buffers; });
  ++buffers_taken;
  counted_ = true;
}

BlasBuffer::~BlasBuffer() {
  if (!counted_) return;
  {
    std::scoped_lock lock(mutex);
    --buffers_taken;
  }
  buffer_is_free.notify_one();
}

std::string blas_name() {
  if (auto* config = find_function<char*()>("openblas_get_config")) return config();
  Dl_info info;
  char path[PATH_MAX];
  void* dgemm = dlsym(RTLD_DEFAULT, "dgemm_");
  if (dgemm && dladdr(dgemm, &info) && realpath(info.dli_fname, path)) return path;
  return "unknown";
}

bool blas_is_optimized(const std::string& name) {
  for (const char* known : {"OpenBLAS", "openblas", "mkl", "blis", "atlas", "Accelerate"})
    if (name.find(known) != std::string::npos) return true;
  return false;
}

}  // namespace ahm
