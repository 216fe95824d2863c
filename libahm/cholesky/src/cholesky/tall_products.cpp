#include "cholesky/tall_products.hpp"

#include "cholesky/front_kernels.hpp"

namespace ahm {
namespace {

/// C += A^T B for 4 columns of A and J of B, in registers of N doubles.
template <int N, int J>
[[gnu::always_inline]] inline void add_dot_products(const double* A, const double* B, double* C, Offset C_stride) {
  using Vector = typename Lanes<N>::Type;
  Vector sum[J][4] = {};
  for (Offset r = 0; r < block_rows; r += N)
#pragma GCC unroll 4
    for (int j = 0; j < J; ++j) {
      const Vector* b = reinterpret_cast<const Vector*>(B + j * block_stride + r);
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i) {
        const Vector* a = reinterpret_cast<const Vector*>(A + i * block_stride + r);
        sum[j][i] += *a * *b;
      }
    }
  for (int j = 0; j < J; ++j)
    for (int i = 0; i < 4; ++i)
      for (int lane = 0; lane < N; ++lane) C[j * C_stride + i] += sum[j][i][lane];
}

}  // namespace

void add_transposed_product(const double* A, Offset columns, const double* B, double* C, Offset C_stride) {
  in_widest_registers([&](auto N) {
    constexpr int J = N() / 2;  // 4 J sums fill half of the registers
    for (Offset i = 0; i < columns; i += 4)
      for (Offset j = 0; j < block_columns; j += J)
        add_dot_products<N(), J>(A + i * block_stride, B + j * block_stride, C + j * C_stride + i, C_stride);
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
