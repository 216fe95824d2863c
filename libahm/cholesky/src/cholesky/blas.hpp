/// \file
/// The BLAS of the process: its functions, name and threads. BLAS functions may be called only while a `OneBlasThread` and a
/// `BlasBuffer` exist. Without a BLAS, `OneBlasThread` does nothing and there are no buffers.
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

/// While any object of this class exists, OpenBLAS runs on one thread: libahm runs BLAS calls in parallel itself, and results must
/// not depend on the number of threads. The last destructor restores the process-wide setting. Has no effect on other BLAS libraries.
class OneBlasThread {
 public:
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;
};

/// While an object of this class exists, its thread may call the BLAS. Objects must not be nested.
/// Each running OpenBLAS call needs a working buffer of 128 MB of address space. OpenBLAS keeps the buffers for later calls. If it
/// cannot allocate one, it retries forever. So if address space is limited, the constructor reserves a buffer before the call, and
/// waits for other callers if there are too few. Without a limit, or with other BLAS libraries, it does nothing.
class BlasBuffer {
 public:
  /// @throws ResourceExhausted (no address space for a single buffer)
  BlasBuffer();
  ~BlasBuffer();
  BlasBuffer(const BlasBuffer&) = delete;
  BlasBuffer& operator=(const BlasBuffer&) = delete;

 private:
  bool counted_;
};

/// Configuration string of OpenBLAS, or the path of the library that provides `dgemm`; without a BLAS "none (loops of libahm)".
std::string blas_name();

/// Whether `name` (see `blas_name`) names an optimized BLAS; without a BLAS true.
bool blas_is_optimized(const std::string& name);

}  // namespace ahm
