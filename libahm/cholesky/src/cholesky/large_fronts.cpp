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

/// Columns per panel. The slabs of a panel for `group_doubles` columns, and one more slab, fit into the first-level cache.
constexpr Offset panel_columns = 64;
/// Doubles of a row per task of the subtraction: 32 real columns or 16 complex ones.
constexpr Offset group_doubles = 32;
/// Rows below a panel per task, in doubles.
constexpr Offset rows_at_once = 128;

/// The rows below a panel, in slabs of `height` doubles, one column of the panel after another. The last slab is filled with zeros.
struct Slabs {
  Offset height;  ///< doubles per column of a slab
  Offset rows;    ///< doubles per column below the panel
  Offset depth;   ///< columns of the panel
  std::unique_ptr<double[]> numbers;

  /// First number of a row, in doubles. Rows of one slab are contiguous.
  double* at(Offset row) const { return numbers.get() + row / height * height * depth + row % height; }
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

/// The loops in registers of N doubles.
template <int W, int N>
struct Loops {
  using Vector = typename Lanes<N>::Type;
  static constexpr int tile_columns = N / W;
  static constexpr Offset height = 2 * N;

  /// Subtracts the products of a tile: rows from `r`, columns from `c` on.
  [[gnu::always_inline]] static void subtract_tile(const Slabs& slabs, const LaterColumns& later, Offset r, Offset c) {
    const Tile<W, N, 2, tile_columns> tile(slabs.at(r), height, slabs.at(c * W), height, slabs.depth);
    const Offset rows = std::min(height, slabs.rows - r), columns = std::min<Offset>(tile_columns, slabs.rows / W - c);
#pragma GCC unroll 8
    for (int k = 0; k < tile_columns; ++k) {
      if (k >= columns) return;
      double* out = later.column(c + k, W) + r;
      const bool set = later.is_set(c + k);
#pragma GCC unroll 2
      for (int v = 0; v < 2; ++v, out += N) {
        Vector sum;
        tile.get(k, v, &sum);
        if (rows == height) {
          Vector* all = reinterpret_cast<Vector*>(out);
          *all = set ? -sum : *all - sum;
        } else {
          for (Offset i = 0; i < std::min<Offset>(N, rows - N * v); ++i) out[i] = set ? -sum[i] : out[i] - sum[i];
        }
      }
    }
  }

  /// Subtracts the products of the panel from the columns begin to end - 1, on and below the diagonal.
  /// @param begin  begin * W is a multiple of `height`
  [[gnu::always_inline]] static void subtract_group(const Slabs& slabs, const LaterColumns& later, Offset begin,
                                                    Offset end) {
    for (Offset r = begin * W; r < slabs.rows; r += height)
      for (Offset c = begin; c < end && c * W < r + height; c += tile_columns) subtract_tile(slabs, later, r, c);
  }

  /// Finishes rows of a panel below its diagonal block, and copies them into slabs.
  /// @param panel        first number of the panel, in the row of its first pivot
  /// @param first, last  rows below the diagonal block, in doubles
  [[gnu::always_inline]] static void finish_rows(double* panel, Offset stride, const Slabs& slabs, Offset first,
                                                 Offset last) {
    const Offset own = slabs.depth * W;
    eliminate<W, false>(panel, stride, slabs.depth, own + first, own + last);
    for (Offset r = first; r < last; r += height) {
      double* to = slabs.at(r);
      const Offset count = std::min(height, last - r);
      for (Offset k = 0; k < slabs.depth; ++k, to += height) {
        const double* from = panel + k * stride + own + r;
        if (count == height)
          std::copy_n(from, height, to);
        else
          std::fill(std::copy_n(from, count, to), to + height, 0.0);
      }
    }
  }
};

}  // namespace

template <int W>
Offset factor_large_front(double* L, Offset rows, Offset columns, double* update, unsigned threads) {
  const Offset height = in_widest_registers([](auto N) { return Loops<W, N()>::height; });
  const Offset stride = rows * W;
  Slabs slabs{height, 0, 0,
              std::make_unique_for_overwrite<double[]>(
                  static_cast<std::size_t>((stride + height) * std::min(columns, panel_columns)))};
  // The first panel takes the remainder. Then the number of own columns after a panel is a multiple of the others' size, and a slab begins
  // at the first row below the supernode: no tile crosses from own columns to the update matrix.
  Offset begin = 0, end = (columns - 1) % panel_columns + 1;
  for (; begin < columns; begin = end, end += panel_columns) {
    double* const panel = L + begin * (stride + W);
    slabs.rows = (rows - end) * W;
    slabs.depth = end - begin;
    const Offset good =
        in_widest_registers([&](auto) { return eliminate<W, true>(panel, stride, slabs.depth, 0, slabs.depth * W); });
    if (good < slabs.depth) return begin + good;
    const LaterColumns later{L + end * (stride + W), update, stride, (rows - columns) * W, columns - end, begin == 0};
    detail::parallel_chunks(slabs.rows, rows_at_once, threads, [&](Offset first, Offset last) {
      const FlushSubnormals flush;
      in_widest_registers([&](auto N) { Loops<W, N()>::finish_rows(panel, stride, slabs, first, last); });
    });
    detail::parallel_chunks(rows - end, group_doubles / W, threads, [&](Offset first, Offset last) {
      const FlushSubnormals flush;
      in_widest_registers([&](auto N) { Loops<W, N()>::subtract_group(slabs, later, first, last); });
    });
  }
  return columns;
}

template Offset factor_large_front<1>(double*, Offset, Offset, double*, unsigned);
template Offset factor_large_front<2>(double*, Offset, Offset, double*, unsigned);

}  // namespace ahm
