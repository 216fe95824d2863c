#include "cholesky/multifrontal.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ahm/util/parallel.hpp"
#include "cholesky/blas.hpp"
#include "cholesky/flush_subnormals.hpp"
#include "cholesky/supernode_kernels.hpp"

namespace ahm {
namespace {

/// Numbers of a tile's columns: two vectors.
constexpr Offset tall = 8;

/// sum_k L_rk conj(L_ck) of R * 4 / W rows and J columns.
template <int W, int R, int J>
struct Tile {
  Four straight[J][R] = {}, crossed[(J - 1) * (W - 1) + 1][(R - 1) * (W - 1) + 1] = {};  // none where W is 1

  /// @param row, column  first rows of L in its first column
  [[gnu::always_inline]] Tile(const double* row, const double* column, Offset stride, Offset count) {
    for (Offset k = 0; k < count; ++k, row += stride, column += stride) {
      const Four* left = four(row);
#pragma GCC unroll 4
      for (int c = 0; c < J; ++c)
#pragma GCC unroll 2
        for (int r = 0; r < R; ++r) {
          straight[c][r] += left[r] * column[c * W];
          if constexpr (W == 2) crossed[c][r] += left[r] * column[c * W + 1];
        }
    }
  }
  [[gnu::always_inline]] void get(int column, int r, Four* sum) const {
    *sum = straight[column][r];
    if constexpr (W == 2)
      *sum += Four{1, -1, 1, -1} * __builtin_shufflevector(crossed[column][r], crossed[column][r], 1, 0, 3, 2);
  }
};

/// A column block of the front on its way: rows from `begin` on, of the columns that begin there.
template <int W, int J, bool Own>
struct ColumnBlock {
  const double* L;
  Offset rows, eliminated;  ///< numbers of a column, columns
  double* target[J];        ///< as if they began at row 0

  /// Of own columns: what is eliminated is subtracted. Of those below: stored with a minus.
  template <int R>
  [[gnu::always_inline]] void tile(Offset begin, Offset r, Offset skipped = 0) const {
    const Tile<W, R, J> tile(L + r, L + begin, rows, eliminated);
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
  [[gnu::always_inline]] void all(Offset begin) const {
    Offset r = begin;
    for (; r + tall <= rows; r += tall) tile<2>(begin, r);
    for (; r + 4 <= rows; r += 4) tile<1>(begin, r);
    if (r == rows) return;
    if (rows >= 4) return tile<1>(begin, rows - 4, r - (rows - 4));
    for (; r < rows; r += W)
      for (int c = 0; c < J; ++c) one(begin, r, c);
  }

 private:
  /// Where a column has less than four numbers.
  [[gnu::always_inline]] void one(Offset begin, Offset r, int c) const {
    double re = 0, im = 0;
    for (Offset k = 0; k < eliminated; ++k) {
      const double *a = L + k * rows + r, *b = L + k * rows + begin + c * W;
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

/// J columns from j on, which all before have been eliminated from, among themselves. @return how many pivots are good
template <int W, int J>
[[gnu::always_inline]] inline int finish_columns(double* L, Offset rows, Offset j) {
  double* column[J];
  for (int c = 0; c < J; ++c) column[c] = L + (j + c) * rows;
  for (int c = 0; c < J; ++c) {
    const double pivot = column[c][(j + c) * W];
    if (!(pivot > 0) || !std::isfinite(pivot)) return c;
    const double root = std::sqrt(pivot), inverse = 1 / root;
    column[c][(j + c) * W] = root;
    if constexpr (W == 2) column[c][(j + c) * W + 1] = 0;
    for (Offset r = (j + c + 1) * W; r < rows; ++r) column[c][r] *= inverse;
    for (int next = c + 1; next < J; ++next) {
      const double re = column[c][(j + next) * W];
      if constexpr (W == 1) {
        for (Offset r = (j + next) * W; r < rows; ++r) column[next][r] -= column[c][r] * re;
      } else {
        const double im = column[c][(j + next) * W + 1];
        for (Offset r = (j + next) * W; r < rows; r += 2) {
          const double x = column[c][r], y = column[c][r + 1];
          column[next][r] -= x * re + y * im;
          column[next][r + 1] -= y * re - x * im;
        }
      }
    }
  }
  return J;
}

template <int W, int J>
[[gnu::always_inline]] inline int own_columns(double* L, Offset rows, Offset j) {
  ColumnBlock<W, J, true> block{L, rows, j, {}};
  for (int c = 0; c < J; ++c) block.target[c] = L + (j + c) * rows;
  block.all(j * W);
  return finish_columns<W, J>(L, rows, j);
}

template <int W, int J>
[[gnu::always_inline]] inline void columns_below(const double* L, Offset rows, Offset columns, Offset c,
                                                 double* update) {
  const Offset below = rows - columns * W;
  ColumnBlock<W, J, false> block{L, rows, columns, {}};
  for (int a = 0; a < J; ++a) block.target[a] = update + (c + a) * below - columns * W;
  block.all((columns + c) * W);
}

/// Columns at a time: as many as registers hold sums of.
template <int W>
constexpr int at_once = W == 1 ? 4 : 2;

/// @param rows  numbers of a column
template <int W>
[[gnu::always_inline]] inline Offset factor_small(double* L, Offset rows, Offset columns, double* update) {
  constexpr int J = at_once<W>;
  for (Offset j = 0; j < columns;) {
    const bool many = j + J <= columns;
    const int wanted = many ? J : 1;
    const int good = many ? own_columns<W, J>(L, rows, j) : own_columns<W, 1>(L, rows, j);
    j += good;
    if (good < wanted) return j;
  }
  const Offset below = rows / W - columns;
  Offset c = 0;
  for (; c + J <= below; c += J) columns_below<W, J>(L, rows, columns, c, update);
  for (; c < below; ++c) columns_below<W, 1>(L, rows, columns, c, update);
  return columns;
}

#ifdef __x86_64__
template <int W>
[[gnu::target("avx2,fma")]] Offset factor_small_avx2(double* L, Offset rows, Offset columns, double* update) {
  return factor_small<W>(L, rows, columns, update);
}
#endif
template <int W>
Offset factor_small_anywhere(double* L, Offset rows, Offset columns, double* update) {
  return factor_small<W>(L, rows, columns, update);
}

/// Rows below that are finished, and columns of their update that are made, at a time.
constexpr Offset below_at_once = 128;

template <int W>
Offset factor_large(double* L, Offset all_rows, Offset all_columns, double* update, unsigned threads) {
  const int rows = static_cast<int>(all_rows), columns = static_cast<int>(all_columns), below = rows - columns;
  const double one[2] = {1, 0}, minus[2] = {-1, 0}, zero[2] = {0, 0};
  int failed = 0;
  {
    const BlasBuffer buffer;
    (W == 1 ? dpotrf_ : zpotrf_)("L", &columns, L, &rows, &failed);
  }
  if (failed > 0) return failed - 1;
  for (Offset j = 0; j < all_columns; ++j)  // OpenBLAS does not stop at NaN
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

}  // namespace

template <int W>
Offset factor_front(double* L, Offset rows, Offset columns, double* update, unsigned threads) {
  const FlushSubnormals flush;
  if (is_large_front(rows, columns)) return factor_large<W>(L, rows, columns, update, threads);
#ifdef __x86_64__
  static const bool fast = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (fast) return factor_small_avx2<W>(L, rows * W, columns, update);
#endif
  return factor_small_anywhere<W>(L, rows * W, columns, update);
}

template Offset factor_front<1>(double*, Offset, Offset, double*, unsigned);
template Offset factor_front<2>(double*, Offset, Offset, double*, unsigned);

namespace {

/// What supernodes leave to one above them: rows of its front, and the lower triangle of a square of numbers.
struct Update {
  std::span<const std::int32_t> index;
  std::unique_ptr<double[]> numbers;

  Offset size() const { return static_cast<Offset>(index.size()); }
};

/// Updates that wait for a supernode.
struct Waiting {
  std::vector<Update> updates;
  Offset numbers = 0;
};

/// Of real (W = 1) or complex (W = 2) numbers.
template <int W>
class Multifrontal {
 public:
  Multifrontal(const SparseUpper& matrix, const SupernodalPattern& pattern, const FactorEntries& entries,
               double* values, unsigned threads)
      : matrix_(matrix),
        pattern_(pattern),
        entries_(entries),
        L_(pattern.factor(W == 2, values)),
        values_(values),
        threads_(threads),
        waiting_(pattern.super.size() - 1) {}

  Offset run() {
    if (!pattern_.groups) return Branch(*this).in_order(0, static_cast<Offset>(waiting_.size()));
    const SolveGroups& groups = *pattern_.groups;
    std::vector<Offset> failed(static_cast<std::size_t>(groups.count()), L_.size);
    std::vector<std::vector<Waiting>> for_top(failed.size());
    detail::parallel_chunks(groups.count(), 1, threads_, [&](Offset group, Offset) {
      for_top[group].resize(groups.top.size());
      Branch branch(*this, &for_top[group]);
      for (std::size_t k = groups.begin[group]; k < groups.begin[group + 1] && failed[group] == L_.size; ++k)
        failed[group] = branch.in_order(groups.subtrees[k].first, groups.subtrees[k].last);
    });
    if (const Offset first = *std::min_element(failed.begin(), failed.end()); first < L_.size) return first;
    Branch top(*this, nullptr, threads_);
    for (std::size_t k = 0; k < groups.top.size(); ++k) {
      Waiting& all = waiting_[groups.top[k]];
      for (auto& of_group : for_top)
        std::move(of_group[k].updates.begin(), of_group[k].updates.end(), std::back_inserter(all.updates));
      if (const Offset column = top.eliminate(groups.top[k]); column < L_.size) return column;
    }
    return L_.size;
  }

 private:
  /// Supernodes that are eliminated one after the other.
  class Branch {
   public:
    /// @param for_top  takes what leaves a group, for each supernode of the top
    /// @param threads  that share what is large
    explicit Branch(Multifrontal& all, std::vector<Waiting>* for_top = nullptr, unsigned threads = 1)
        : all_(all), for_top_(for_top), threads_(threads), places_(static_cast<std::size_t>(all.L_.size)) {}

    /// @return as `factor_by_fronts`
    Offset in_order(Offset first, Offset last) {
      last_ = last;
      for (Offset s = first; s < last; ++s)
        if (const Offset column = eliminate(s); column < all_.L_.size) return column;
      return all_.L_.size;
    }

    Offset eliminate(Offset number) {
      const Supernode<W> s(all_.L_, number);
      const Offset below = s.rows - s.columns;
      double* L = all_.values_ + s.begin * W;
      place(s);
      std::fill_n(L, s.rows * s.columns * W, 0.0);
      add_entries(s, L);
      const Waiting waiting = std::move(all_.waiting_[number]);
      for (const Update& update : waiting.updates) add<true>(update, s, s.rows, L);
      Update left{{s.index + s.columns, s.index + s.rows}, nullptr};
      if (below > 0)
        left.numbers = std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(below * below * W));
      if (const Offset good = factor_front<W>(L, s.rows, s.columns, left.numbers.get(), threads_); good < s.columns)
        return s.first + good;
      if (below == 0) return all_.L_.size;
      for (const Update& update : waiting.updates) add<false>(update, s, below, left.numbers.get());
      leave(all_.pattern_.parent[number], std::move(left));
      return all_.L_.size;
    }

   private:
    void place(const Supernode<W>& s) {
      for (Offset r = 0; r < s.rows; ++r) places_[s.index[r]] = static_cast<std::int32_t>(r);
    }

    void add_entries(const Supernode<W>& s, double* L) const {
      for (Offset j = 0; j < s.columns; ++j, L += s.rows * W)
        for (const auto& [row, source] : all_.entries_.of(s.first + j)) {
          const double* value = all_.matrix_.values.data() + (source < 0 ? ~source : source) * W;
          double* entry = L + places_[row] * W;
          entry[0] += value[0];
          if constexpr (W == 2) entry[1] += source < 0 ? -value[1] : value[1];
        }
    }

    /// Adds an update to the columns of the supernode (Own), or to the square of the rows below it.
    /// @param rows  of a column of `to`
    template <bool Own>
    void add(const Update& update, const Supernode<W>& s, Offset rows, double* to) const {
      const std::span<const std::int32_t> index = update.index;
      const auto own = std::lower_bound(index.begin(), index.end(), s.first + s.columns) - index.begin();
      add_columns(update, Own ? 0 : own, Own ? own : update.size(), Own ? 0 : s.columns, rows, to);
    }

    /// @param skipped  rows of the front before those of `to`
    void add_columns(const Update& update, Offset begin, Offset end, Offset skipped, Offset rows, double* to) const {
      const std::span<const std::int32_t> index = update.index;
      const auto add = [&](Offset first, Offset last) {
        for (Offset j = begin + first; j < begin + last; ++j) {
          const double* from = update.numbers.get() + j * update.size() * W;
          double* column = to + (places_[index[j]] - skipped) * rows * W;
          for (Offset i = j; i < update.size(); ++i)
            for (int w = 0; w < W; ++w) column[(places_[index[i]] - skipped) * W + w] += from[i * W + w];
        }
      };
      if (threads_ != 1 && update.size() * update.size() > least_shared)
        detail::parallel_chunks(end - begin, columns_at_once, threads_, add);
      else
        add(0, end - begin);
    }

    Waiting& waiting_for(Offset number) {
      if (!for_top_ || number < last_) return all_.waiting_[number];
      const std::vector<Offset>& top = all_.pattern_.groups->top;
      return (*for_top_)[std::lower_bound(top.begin(), top.end(), number) - top.begin()];
    }

    /// Hands an update over. Many that wait for the same supernode are added up, or they would take any number of times the memory
    /// of its front.
    void leave(Offset parent, Update update) {
      Waiting& waiting = waiting_for(parent);
      waiting.numbers += update.size() * update.size();
      waiting.updates.push_back(std::move(update));
      const Supernode<W> s(all_.L_, parent);
      if (waiting.numbers <= most_waiting * s.rows * s.rows) return;
      Update sum{{s.index, s.index + s.rows},
                 std::make_unique<double[]>(static_cast<std::size_t>(s.rows * s.rows * W))};
      place(s);
      for (const Update& one : waiting.updates) add_columns(one, 0, one.size(), 0, s.rows, sum.numbers.get());
      waiting.updates.clear();
      waiting.updates.push_back(std::move(sum));
      waiting.numbers = s.rows * s.rows;
    }

    Multifrontal& all_;
    std::vector<Waiting>* for_top_;
    unsigned threads_;
    std::vector<std::int32_t> places_;  ///< of rows in the front at hand
    Offset last_ = 0;                   ///< of the subtree at hand
  };

  static constexpr Offset most_waiting = 4;        ///< fronts
  static constexpr Offset least_shared = 1 << 16;  ///< numbers of an update that threads share
  static constexpr Offset columns_at_once = 64;    ///< of such an update

  const SparseUpper& matrix_;
  const SupernodalPattern& pattern_;
  const FactorEntries& entries_;
  SupernodalFactor L_;
  double* values_;
  unsigned threads_;
  std::vector<Waiting> waiting_;  ///< for each supernode, but for what groups leave to the top
};

}  // namespace

Offset factor_by_fronts(const SparseUpper& matrix, const SupernodalPattern& pattern, const FactorEntries& entries,
                        double* values, unsigned threads) {
  return matrix.is_complex ? Multifrontal<2>(matrix, pattern, entries, values, threads).run()
                           : Multifrontal<1>(matrix, pattern, entries, values, threads).run();
}

}  // namespace ahm
