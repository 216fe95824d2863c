/// \file
/// Vectorized elimination of columns in a front, by register tiles. Everything is inlined into its callers, which are compiled for several
/// processors.
#pragma once

#include <cmath>

#include "ahm/types.hpp"
#include "cholesky/registers.hpp"

namespace ahm {

/// Doubles per tile column: two vectors of four.
inline constexpr Offset tile_rows = 8;

/// Computes sum_k L_rk conj(L_ck) for a tile of R * N / W rows r and J columns c, in registers of N doubles.
template <int W, int N, int R, int J>
struct Tile {
  using Vector = typename Lanes<N>::Type;
  Vector straight[J][R] = {}, crossed[(J - 1) * (W - 1) + 1][(R - 1) * (W - 1) + 1] = {};  // crossed: unused if W is 1

  /// @param row, column  entries of the first column of L in the tile's first row r and first column c
  /// @param row_stride, column_stride  doubles from one column of L to the next, for each of both
  [[gnu::always_inline]] Tile(const double* row, Offset row_stride, const double* column, Offset column_stride,
                              Offset count) {
    for (Offset k = 0; k < count; ++k, row += row_stride, column += column_stride) {
      const Vector* left = reinterpret_cast<const Vector*>(row);
#pragma GCC unroll 8
      for (int c = 0; c < J; ++c)
#pragma GCC unroll 2
        for (int r = 0; r < R; ++r) {
          straight[c][r] += left[r] * column[c * W];
          if constexpr (W == 2) crossed[c][r] += left[r] * column[c * W + 1];
        }
    }
  }
  [[gnu::always_inline]] void get(int column, int r, Vector* sum) const {
    *sum = straight[column][r];
    if constexpr (W == 2) {
      const Vector other = crossed[column][r];
      if constexpr (N == 4)
        *sum += Vector{1, -1, 1, -1} * __builtin_shufflevector(other, other, 1, 0, 3, 2);
      else
        *sum += Vector{1, -1, 1, -1, 1, -1, 1, -1} * __builtin_shufflevector(other, other, 1, 0, 3, 2, 5, 4, 7, 6);
    }
  }
};

/// Applies the eliminated columns of a front to J of its columns.
template <int W, int J, bool Own>
struct ColumnBlock {
  const double* L;
  Offset stride, eliminated;  ///< doubles per column; number of eliminated columns
  double* target[J];          ///< output columns, shifted so that index 0 is row 0 of the front

  /// Computes the rows `first` to `last` - 1, in doubles.
  /// @param diagonal  row of the first diagonal entry
  /// @param lowest    first row that no other thread writes
  [[gnu::always_inline]] void rows(Offset diagonal, Offset first, Offset last, Offset lowest) const {
    Offset r = first;
    for (; r + tile_rows <= last; r += tile_rows) tile<2>(diagonal, r);
    for (; r + 4 <= last; r += 4) tile<1>(diagonal, r);
    if (r == last) return;
    if (last - lowest >= 4) return tile<1>(diagonal, last - 4, r - (last - 4));
    for (; r < last; r += W)
      for (int c = 0; c < J; ++c) one(diagonal, r, c);
  }

 private:
  /// Own: subtracts the product from the supernode's own columns. Otherwise: stores the negative product in the update matrix.
  /// @param skipped  leading doubles of the tile that are not written
  template <int R>
  [[gnu::always_inline]] void tile(Offset diagonal, Offset r, Offset skipped = 0) const {
    const Tile<W, 4, R, J> tile(L + r, stride, L + diagonal, stride, eliminated);
#pragma GCC unroll 4
    for (int c = 0; c < J; ++c)
#pragma GCC unroll 2
      for (int v = 0; v < R; ++v) {
        Four sum;
        tile.get(c, v, &sum);
        double* out = target[c] + r + 4 * v;
        if (skipped == 0) {
          Four* all = four(out);
          *all = Own ? *all - sum : -sum;
        } else {
          for (Offset k = skipped; k < 4; ++k) out[k] = Own ? out[k] - sum[k] : -sum[k];
        }
      }
  }

  /// Computes one entry, where there are fewer than four doubles per column.
  [[gnu::always_inline]] void one(Offset diagonal, Offset r, int c) const {
    double re = 0, im = 0;
    for (Offset k = 0; k < eliminated; ++k) {
      const double *a = L + k * stride + r, *b = L + k * stride + diagonal + c * W;
      re += a[0] * b[0];
      if constexpr (W == 2) {
        re += a[1] * b[1];
        im += a[1] * b[0] - a[0] * b[1];
      }
    }
    double* out = target[c] + r;
    out[0] = Own ? out[0] - re : -re;
    if constexpr (W == 2) out[1] = Own ? out[1] - im : -im;
  }
};

/// Divides the columns j to j + J - 1 by their pivots and eliminates them from each other, in rows from which all earlier columns have
/// been eliminated.
/// @tparam Pivots  the rows include those of the pivots, which become their square roots. Otherwise the pivots are finished
/// @param first, last  the rows first to last - 1, in doubles; first is ignored if Pivots
/// @return number of columns before the first pivot that is not positive and finite
template <int W, int J, bool Pivots>
[[gnu::always_inline]] inline int finish_columns(double* L, Offset stride, Offset j, Offset first, Offset last) {
  double* column[J];
  for (int c = 0; c < J; ++c) column[c] = L + (j + c) * stride;
  for (int c = 0; c < J; ++c) {
    double* const pivot = column[c] + (j + c) * W;
    if constexpr (Pivots) {
      if (!(*pivot > 0) || !std::isfinite(*pivot)) return c;
      *pivot = std::sqrt(*pivot);
      if constexpr (W == 2) pivot[1] = 0;
    }
    const double inverse = 1 / *pivot;
    for (Offset r = Pivots ? (j + c + 1) * W : first; r < last; ++r) column[c][r] *= inverse;
    for (int next = c + 1; next < J; ++next) {
      const double re = column[c][(j + next) * W];
      const Offset begin = Pivots ? (j + next) * W : first;
      if constexpr (W == 1) {
        for (Offset r = begin; r < last; ++r) column[next][r] -= column[c][r] * re;
      } else {
        const double im = column[c][(j + next) * W + 1];
        for (Offset r = begin; r < last; r += 2) {
          const double x = column[c][r], y = column[c][r + 1];
          column[next][r] -= x * re + y * im;
          column[next][r + 1] -= y * re - x * im;
        }
      }
    }
  }
  return J;
}

/// Columns per tile: as many as fit into the registers.
template <int W>
inline constexpr int columns_per_tile = W == 1 ? 4 : 2;

/// Finishes J columns: eliminates all earlier columns from them, then `finish_columns`.
template <int W, int J, bool Pivots>
[[gnu::always_inline]] inline int eliminate_columns(double* L, Offset stride, Offset j, Offset first, Offset last) {
  ColumnBlock<W, J, true> block{L, stride, j, {}};
  for (int c = 0; c < J; ++c) block.target[c] = L + (j + c) * stride;
  block.rows(j * W, Pivots ? j * W : first, last, Pivots ? 0 : first);
  return finish_columns<W, J, Pivots>(L, stride, j, first, last);
}

/// Factors the first `columns` columns of a matrix in place (Pivots), or computes more rows of columns that are already factored.
/// Parameters and result as in `finish_columns`.
template <int W, bool Pivots>
[[gnu::always_inline]] inline Offset eliminate(double* L, Offset stride, Offset columns, Offset first, Offset last) {
  constexpr int J = columns_per_tile<W>;
  for (Offset j = 0; j < columns;) {
    const bool many = j + J <= columns;
    const int wanted = many ? J : 1;
    const int good = many ? eliminate_columns<W, J, Pivots>(L, stride, j, first, last)
                          : eliminate_columns<W, 1, Pivots>(L, stride, j, first, last);
    j += good;
    if (good < wanted) return j;
  }
  return columns;
}

}  // namespace ahm
