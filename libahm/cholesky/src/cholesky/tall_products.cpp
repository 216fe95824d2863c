#include "cholesky/tall_products.hpp"

#include "cholesky/front_kernels.hpp"

namespace ahm {
namespace {

/// C += A^T B for N columns of A and 2 N of B, in registers of N doubles.
template <int N>
[[gnu::always_inline]] inline void add_transposed_tile(const double* A, const double* B, double* C) {
  using Vector = typename Lanes<N>::Type;
  Vector sum[N][2] = {};
  for (Offset r = 0; r < block_rows; ++r, B += block_columns) {
    const Vector* b = reinterpret_cast<const Vector*>(B);
#pragma GCC unroll 8
    for (int i = 0; i < N; ++i)
#pragma GCC unroll 2
      for (int v = 0; v < 2; ++v) sum[i][v] += A[i * block_stride + r] * b[v];
  }
  for (int i = 0; i < N; ++i) {
    Vector* c = reinterpret_cast<Vector*>(C + i * block_columns);
    for (int v = 0; v < 2; ++v) c[v] += sum[i][v];
  }
}

}  // namespace

void add_transposed_product(const double* A, Offset columns, const double* B, double* C) {
  in_widest_registers([&](auto N) {
    for (Offset i = 0; i < columns; i += N())
      for (Offset j = 0; j < block_columns; j += 2 * N())
        add_transposed_tile<N()>(A + i * block_stride, B + j, C + i * block_columns + j);
  });
}

void add_product(const double* A, Offset columns, const double* C, double* X) {
  in_widest_registers([&](auto N) {
    using Vector = typename Lanes<N()>::Type;
    for (Offset r = 0; r < block_rows; r += 2 * N())
      for (Offset c = 0; c < block_columns; c += N()) {
        const Tile<1, N(), 2, N()> tile(A + r, block_stride, C + c, block_columns, columns);
        for (int k = 0; k < N(); ++k)
          for (int v = 0; v < 2; ++v) {
            Vector sum;
            tile.get(k, v, &sum);
            *reinterpret_cast<Vector*>(X + (c + k) * block_stride + r + v * N()) += sum;
          }
      }
  });
}

}  // namespace ahm
