// A large front is factored in panels of columns. A panel is eliminated, its rows below are copied into slabs that tiles read
// contiguously, and the product of the slabs is subtracted from all later columns.
#include "cholesky/large_fronts.hpp"

#include <algorithm>
#include <memory>

#include "ahm/util/parallel.hpp"
#include "cholesky/flush_subnormals.hpp"
#include "cholesky/front_kernels.hpp"

namespace ahm {
namespace {

/// Columns per panel. The slabs of a panel for `group_doubles` columns fit into the first-level cache.
constexpr Offset panel_columns = 128;
/// Doubles of a row per task of the subtraction: 32 real columns or 16 complex ones.
constexpr Offset group_doubles = 32;
/// Rows below a panel per task, in doubles.
constexpr Offset rows_at_once = 128;

/// The rows below a panel, in slabs of `tile_rows` doubles, one column of the panel after another. The last slab is filled with zeros.
struct Slabs {
  Offset rows, depth;  ///< doubles per column; columns of the panel
  std::unique_ptr<double[]> numbers;

  /// First number of a row, in doubles. Rows of one slab are contiguous.
  double* at(Offset row) const { return numbers.get() + row / tile_rows * tile_rows * depth + row % tile_rows; }
};

/// The columns of a front after a panel. Column 0 is the first one after the panel, and so is row 0.
struct LaterColumns {
  double *own, *update;  ///< own columns of the supernode; its update matrix
  Offset own_stride, update_stride, own_count;
  bool is_first;  ///< the update matrix is not initialized

  /// @param W  doubles per number
  double* column(Offset c, int W) const {
    return c < own_count ? own + c * own_stride : update + (c - own_count) * update_stride - own_count * W;
  }
  bool is_set(Offset c) const { return is_first && c >= own_count; }
};

/// Subtracts the products of a tile: rows from `r`, columns from `c` on.
template <int W>
[[gnu::always_inline]] inline void subtract_tile(const Slabs& slabs, const LaterColumns& later, Offset r, Offset c) {
  constexpr int J = columns_per_tile<W>;
  const Tile<W, 2, J> tile(slabs.at(r), slabs.at(c * W), tile_rows, slabs.depth);
  const Offset rows = std::min(tile_rows, slabs.rows - r), columns = std::min<Offset>(J, slabs.rows / W - c);
#pragma GCC unroll 4
  for (int k = 0; k < J; ++k) {
    if (k >= columns) return;
    double* out = later.column(c + k, W) + r;
    const bool set = later.is_set(c + k);
#pragma GCC unroll 2
    for (int v = 0; v < 2; ++v, out += 4) {
      Four sum;
      tile.get(k, v, &sum);
      if (rows == tile_rows) {
        Four* all = four(out);
        *all = set ? -sum : *all - sum;
      } else {
        for (Offset i = 0; i < std::min<Offset>(4, rows - 4 * v); ++i) out[i] = set ? -sum[i] : out[i] - sum[i];
      }
    }
  }
}

/// Subtracts the products of the panel from the columns begin to end - 1, on and below the diagonal.
/// @param begin  multiple of a slab's rows
template <int W>
[[gnu::always_inline]] inline void subtract_group(const Slabs& slabs, const LaterColumns& later, Offset begin,
                                                  Offset end) {
  for (Offset r = begin * W; r < slabs.rows; r += tile_rows)
    for (Offset c = begin; c < end && c * W < r + tile_rows; c += columns_per_tile<W>)
      subtract_tile<W>(slabs, later, r, c);
}

/// Finishes rows of a panel below its diagonal block, and copies them into slabs.
/// @param panel        first number of the panel, in the row of its first pivot
/// @param first, last  rows below the diagonal block, in doubles
template <int W>
[[gnu::always_inline]] inline void finish_rows(double* panel, Offset stride, const Slabs& slabs, Offset first,
                                               Offset last) {
  const Offset own = slabs.depth * W;
  eliminate<W, false>(panel, stride, slabs.depth, own + first, own + last);
  for (Offset r = first; r < last; r += tile_rows) {
    double* to = slabs.at(r);
    const Offset count = std::min(tile_rows, last - r);
    for (Offset k = 0; k < slabs.depth; ++k, to += tile_rows) {
      const double* from = panel + k * stride + own + r;
      if (count == tile_rows)
        std::copy_n(from, tile_rows, to);
      else
        std::fill(std::copy_n(from, count, to), to + tile_rows, 0.0);
    }
  }
}

template <int W>
struct Kernels {
  Offset (*diagonal)(double* panel, Offset stride, Offset columns);  ///< factors the diagonal block of a panel
  void (*rows)(double* panel, Offset stride, const Slabs& slabs, Offset first, Offset last);
  void (*group)(const Slabs& slabs, const LaterColumns& later, Offset begin, Offset end);
};

#ifdef __x86_64__
template <int W>
[[gnu::target("avx2,fma")]] Offset diagonal_avx2(double* panel, Offset stride, Offset columns) {
  return eliminate<W, true>(panel, stride, columns, 0, columns * W);
}
template <int W>
[[gnu::target("avx2,fma")]] void rows_avx2(double* panel, Offset stride, const Slabs& slabs, Offset first,
                                           Offset last) {
  finish_rows<W>(panel, stride, slabs, first, last);
}
template <int W>
[[gnu::target("avx2,fma")]] void group_avx2(const Slabs& slabs, const LaterColumns& later, Offset begin, Offset end) {
  subtract_group<W>(slabs, later, begin, end);
}
#endif
template <int W>
Offset diagonal_anywhere(double* panel, Offset stride, Offset columns) {
  return eliminate<W, true>(panel, stride, columns, 0, columns * W);
}
template <int W>
void rows_anywhere(double* panel, Offset stride, const Slabs& slabs, Offset first, Offset last) {
  finish_rows<W>(panel, stride, slabs, first, last);
}
template <int W>
void group_anywhere(const Slabs& slabs, const LaterColumns& later, Offset begin, Offset end) {
  subtract_group<W>(slabs, later, begin, end);
}

template <int W>
Kernels<W> kernels() {
#ifdef __x86_64__
  static const bool fast = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (fast) return {diagonal_avx2<W>, rows_avx2<W>, group_avx2<W>};
#endif
  return {diagonal_anywhere<W>, rows_anywhere<W>, group_anywhere<W>};
}

}  // namespace

template <int W>
Offset factor_large_front(double* L, Offset rows, Offset columns, double* update, unsigned threads) {
  const Kernels<W> kernel = kernels<W>();
  const Offset stride = rows * W;
  Slabs slabs{0, 0,
              std::make_unique_for_overwrite<double[]>(
                  static_cast<std::size_t>((stride + tile_rows) * std::min(columns, panel_columns)))};
  // The first panel has the odd number of columns, so that slabs begin at the first row below the supernode.
  Offset begin = 0, end = (columns - 1) % panel_columns + 1;
  for (; begin < columns; begin = end, end += panel_columns) {
    double* const panel = L + begin * (stride + W);
    slabs.rows = (rows - end) * W;
    slabs.depth = end - begin;
    if (const Offset good = kernel.diagonal(panel, stride, slabs.depth); good < slabs.depth) return begin + good;
    const LaterColumns later{L + end * (stride + W), update, stride, (rows - columns) * W, columns - end, begin == 0};
    detail::parallel_chunks(slabs.rows, rows_at_once, threads, [&](Offset first, Offset last) {
      const FlushSubnormals flush;
      kernel.rows(panel, stride, slabs, first, last);
    });
    detail::parallel_chunks(rows - end, group_doubles / W, threads, [&](Offset first, Offset last) {
      const FlushSubnormals flush;
      kernel.group(slabs, later, first, last);
    });
  }
  return columns;
}

template Offset factor_large_front<1>(double*, Offset, Offset, double*, unsigned);
template Offset factor_large_front<2>(double*, Offset, Offset, double*, unsigned);

}  // namespace ahm
