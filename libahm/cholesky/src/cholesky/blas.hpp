/// \file
/// The BLAS of the process: the functions called, its name, and its threads. Functions may be called only while a `OneBlasThread`
/// and a `BlasBuffer` exist.
#pragma once

#include <string>

// NOLINTBEGIN(readability-identifier-naming)
extern "C" {
void dpotrf_(const char*, const int*, double*, const int*, int*);
void zpotrf_(const char*, const int*, double*, const int*, int*);
void dtrsm_(const char*, const char*, const char*, const char*, const int*, const int*, const double*, const double*,
            const int*, double*, const int*);
void ztrsm_(const char*, const char*, const char*, const char*, const int*, const int*, const double*, const double*,
            const int*, double*, const int*);
void dsyrk_(const char*, const char*, const int*, const int*, const double*, const double*, const int*, const double*,
            double*, const int*);
void zherk_(const char*, const char*, const int*, const int*, const double*, const double*, const int*, const double*,
            double*, const int*);
void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*, const double*, const int*,
            const double*, const int*, const double*, double*, const int*);
void zgemm_(const char*, const char*, const int*, const int*, const int*, const double*, const double*, const int*,
            const double*, const int*, const double*, double*, const int*);
}
// NOLINTEND(readability-identifier-naming)

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

/// While an object of this class lives, its thread may call the BLAS; not to be nested. OpenBLAS takes a working buffer of
/// 128 MB of address space for each call at a time, keeps it for later calls, and where it cannot have one tries for ever.
/// So where address space is limited, buffers are had before calls are made, and callers wait for each other where there
/// are fewer than callers. Without a limit, and with other BLAS libraries, this does nothing.
class BlasBuffer {
 public:
  /// @throws ResourceExhausted where there is no room for a single buffer
  BlasBuffer();
  ~BlasBuffer();
  BlasBuffer(const BlasBuffer&) = delete;
  BlasBuffer& operator=(const BlasBuffer&) = delete;

 private:
  bool counted_;
};

/// Configuration string of OpenBLAS, else the file that provides `dgemm`.
std::string blas_name();

/// Whether the name is that of an optimized BLAS.
bool blas_is_optimized(const std::string& name);

}  // namespace ahm
