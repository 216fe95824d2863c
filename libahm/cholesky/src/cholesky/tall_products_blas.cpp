// Products of tall matrices by the BLAS.
#include "cholesky/blas.hpp"
#include "cholesky/tall_products.hpp"

namespace ahm {

void transposed_product(const TallChunk& A, Offset a, const TallChunk& B, Offset b, double* C) {
  const int m = static_cast<int>(a), n = static_cast<int>(b), k = static_cast<int>(A.rows);
  const int stride_A = static_cast<int>(A.stride), stride_B = static_cast<int>(B.stride);
  const double one = 1, zero = 0;
  const BlasBuffer buffer;
  dgemm_("T", "N", &m, &n, &k, &one, A.values, &stride_A, B.values, &stride_B, &zero, C, &m);
}

void add_tall_product(const TallChunk& A, Offset a, const double* C, Offset stride_C, double factor, double* B,
                      Offset stride_B, Offset b) {
  const int m = static_cast<int>(A.rows), n = static_cast<int>(b), k = static_cast<int>(a);
  const int lda = static_cast<int>(A.stride), ldc = static_cast<int>(stride_C), ldb = static_cast<int>(stride_B);
  const double one = 1;
  const BlasBuffer buffer;
  dgemm_("N", "N", &m, &n, &k, &factor, A.values, &lda, C, &ldc, &one, B, &ldb);
}

}  // namespace ahm
