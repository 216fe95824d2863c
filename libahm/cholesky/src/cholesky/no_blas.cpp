// Without a BLAS (AHM_WITH_BLAS=OFF): large_fronts.cpp has loops of our own.
#include "cholesky/blas.hpp"

namespace ahm {

OneBlasThread::OneBlasThread() = default;
OneBlasThread::~OneBlasThread() = default;

std::string blas_name() { return "none (loops of libahm)"; }
bool blas_is_optimized(const std::string&) { return true; }

}  // namespace ahm
