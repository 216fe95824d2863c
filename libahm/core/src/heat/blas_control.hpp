/// \file
/// The BLAS of the process: its name, and one thread of it while we work.
#pragma once

#include <functional>
#include <string>

namespace ahm {

/// While any object of this class lives, OpenBLAS runs on one thread: our parallelism is coarser, and results must not
/// depend on the number of threads. The process-wide setting is restored when the last one dies. Other BLAS libraries
/// are left alone.
class OneBlasThread {
 public:
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;
};

/// Runs `work` where CHOLMOD's OpenMP regions stay on one thread, since at our sizes they cost more than they give: on a
/// thread of its own, so that the caller's settings are left alone, or at once where that has been done already. Rethrows
/// what it throws.
void without_openmp_regions(const std::function<void()>& work);

/// Configuration string of OpenBLAS, else the file that provides `dgemm`.
std::string blas_name();

/// Whether the name is that of an optimised BLAS.
bool blas_is_optimized(const std::string& name);

}  // namespace ahm
