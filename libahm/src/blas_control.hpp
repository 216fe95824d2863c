/// \file
/// The BLAS of the process: its name, and one thread of it while we work.
#pragma once

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

/// Keeps CHOLMOD's OpenMP regions, started from the calling thread, on that thread: at our sizes they cost more than
/// they give. Meant for threads that end after the factorization.
void disable_openmp_regions_on_this_thread();

/// Configuration string of OpenBLAS, else the file that provides `dgemm`.
std::string blas_name();

/// Whether the name is that of an optimised BLAS.
bool blas_is_optimized(const std::string& name);

}  // namespace ahm
