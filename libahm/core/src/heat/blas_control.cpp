#include "heat/blas_control.hpp"

#include <dlfcn.h>

#include <climits>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <thread>

namespace ahm {
namespace {

// The BLAS is chosen when the process starts, so its extra functions are looked up by name rather than linked.
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

void without_openmp_regions(const std::function<void()>& work) {
  static auto* const set_levels = find_function<void(int)>("omp_set_max_active_levels");
  thread_local bool done = false;
  if (done) return work();
  std::exception_ptr error;
  std::jthread([&] {
    done = true;
    if (set_levels) set_levels(0);
    try {
      work();
    } catch (...) {
      error = std::current_exception();
    }
  }).join();
  if (error) std::rethrow_exception(error);
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
