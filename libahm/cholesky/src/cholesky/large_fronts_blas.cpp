// Large fronts by LAPACK and the BLAS.
#include <cmath>

#include "ahm/util/parallel.hpp"
#include "cholesky/blas.hpp"
#include "cholesky/flush_subnormals.hpp"
#include "cholesky/large_fronts.hpp"

namespace ahm {
namespace {

/// Rows below the supernode per task of the triangular solve, and columns per task of the update.
constexpr Offset below_at_once = 128;

}  // namespace

template <int W>
Offset factor_large_front(double* L, Offset all_rows, Offset all_columns, double* update, unsigned threads) {
  const int rows = static_cast<int>(all_rows), columns = static_cast<int>(all_columns), below = rows - columns;
  const double one[2] = {1, 0}, minus[2] = {-1, 0}, zero[2] = {0, 0};
  int failed = 0;
  {
    const BlasBuffer buffer;
    (W == 1 ? dpotrf_ : zpotrf_)("L", &columns, L, &rows, &failed);
  }
  if (failed > 0) return failed - 1;
  for (Offset j = 0; j < all_columns; ++j)  // OpenBLAS does not report NaN pivots
    if (!std::isfinite(L[j * (all_rows + 1) * W])) return j;
  double* L_below = L + all_columns * W;
  detail::parallel_chunks(below, below_at_once, threads, [&](Offset begin, Offset end) {
    const int some = static_cast<int>(end - begin);
    const FlushSubnormals flush;
    const BlasBuffer buffer;
    (W == 1 ? dtrsm_ : ztrsm_)("R", "L", "C", "N", &some, &columns, one, L, &rows, L_below + begin * W, &rows);
  });
  detail::parallel_chunks(below, below_at_once, threads, [&](Offset begin, Offset end) {
    const int some = static_cast<int>(end - begin), rest = below - static_cast<int>(end);
    const double *own = L_below + begin * W, *under = L_below + end * W;
    double* out = update + begin * below * W;
    const FlushSubnormals flush;
    const BlasBuffer buffer;
    (W == 1 ? dsyrk_ : zherk_)("L", "N", &some, &columns, minus, own, &rows, zero, out + begin * W, &below);
    if (rest > 0)
      (W == 1 ? dgemm_ : zgemm_)("N", "C", &rest, &some, &columns, minus, under, &rows, own, &rows, zero, out + end * W,
                                 &below);
  });
  return all_columns;
}

template Offset factor_large_front<1>(double*, Offset, Offset, double*, unsigned);
template Offset factor_large_front<2>(double*, Offset, Offset, double*, unsigned);

}  // namespace ahm
