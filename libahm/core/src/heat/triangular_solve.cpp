#include "heat/triangular_solve.hpp"

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "ahm/util/parallel.hpp"
#include "heat/solve_groups.hpp"

namespace ahm {
namespace {

/// The kernels for K columns of real (W = 1) or complex (W = 2) numbers. Vectors are stored row by row: K numbers of
/// row 0, ...
template <int W, int K>
class NarrowSolve {
  static constexpr int width = W * K;

 public:
  NarrowSolve(const SupernodalFactor& L, const SolveGroups* groups, unsigned threads)
      : L_(L),
        groups_(groups),
        threads_(threads),
        x_(std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(L.size) * width)) {
    for (std::size_t s = 0; s + 1 < L.row_begin.size(); ++s)
      longest_ = std::max(longest_, L.row_begin[s + 1] - L.row_begin[s]);
  }

  void solve(std::span<double> X) {
    permute<true>(X);
    if (groups_)
      solve_by_groups();
    else
      solve_in_order();
    permute<false>(X);
  }

 private:
  using Buffer = std::vector<double>;
  Buffer rows(Offset count) const { return Buffer(static_cast<std::size_t>(count) * width); }

  void solve_in_order() {
    Buffer below = rows(longest_);
    const auto in_x = [this](Offset row) { return x_.get() + row * width; };
    const auto supernodes = static_cast<Offset>(L_.super.size()) - 1;
    for (Offset s = 0; s < supernodes; ++s) forward(Supernode<W>(L_, s), below, in_x);
    for (Offset s = supernodes; s-- > 0;) backward(Supernode<W>(L_, s), below);
  }

  void solve_by_groups() {
    const auto in_x = [this](Offset row) { return x_.get() + row * width; };
    const auto each_group = [&](const auto& body) {
      detail::parallel_chunks(groups_->count(), 1, threads_, [&](Offset group, Offset) {
        Buffer below = rows(longest_);
        body(group,
             std::span(groups_->subtrees)
                 .subspan(groups_->begin[group], groups_->begin[group + 1] - groups_->begin[group]),
             below);
      });
    };
    std::vector<Buffer> to_top(static_cast<std::size_t>(groups_->count()));
    each_group([&](Offset group, const auto& subtrees, Buffer& below) {
      Buffer& sums = to_top[group] = rows(static_cast<Offset>(groups_->top_rows));
      for (const auto& [first, last, end] : subtrees)
        for (Offset s = first; s < last; ++s)
          forward(Supernode<W>(L_, s), below, [&, end = end](Offset row) {
            return row < end ? in_x(row) : sums.data() + groups_->place[row] * width;
          });
    });
    Buffer below = rows(longest_);
    std::size_t k = 0;
    for (const Offset s : groups_->top)
      for (Offset row = L_.super[s]; row < L_.super[s + 1]; ++row)
        for (int c = 0; c < width; ++c, ++k)
          for (const Buffer& sums : to_top) *(in_x(row) + c) += sums[k];
    for (const Offset s : groups_->top) forward(Supernode<W>(L_, s), below, in_x);
    for (auto s = groups_->top.rbegin(); s != groups_->top.rend(); ++s) backward(Supernode<W>(L_, *s), below);
    each_group([&](Offset, const auto& subtrees, Buffer& own_below) {
      for (auto tree = subtrees.rbegin(); tree != subtrees.rend(); ++tree)
        for (Offset s = tree->last; s-- > tree->first;) backward(Supernode<W>(L_, s), own_below);
    });
  }

  template <bool In>
  void permute(std::span<double> X) {
    detail::parallel_chunks(L_.size, 1 << 15, groups_ ? threads_ : 1, [&](Offset begin, Offset end) {
      for (Offset k = begin; k < end; ++k)
        for (int c = 0; c < K; ++c)
          for (int w = 0; w < W; ++w) {
            double& outside = X[(c * L_.size + L_.permutation[k]) * W + w];
            double& inside = x_[k * width + c * W + w];
            In ? inside = outside : outside = inside;
          }
    });
  }

  /// y_r += sign L_rj x for `count` rows r.
  static void add_column(const double* L, const double* x, double sign, double* y, Offset count) {
    if constexpr (W == 1) {
      double a[K];
      for (int c = 0; c < K; ++c) a[c] = sign * x[c];
#pragma omp simd
      for (Offset r = 0; r < count; ++r)
        for (int c = 0; c < K; ++c) y[r * K + c] += L[r] * a[c];
    } else {
      for (int c = 0; c < K; ++c) {
        const double re = sign * x[2 * c], im = sign * x[2 * c + 1];
#pragma omp simd
        for (Offset r = 0; r < count; ++r) {
          y[r * width + 2 * c] += L[2 * r] * re - L[2 * r + 1] * im;
          y[r * width + 2 * c + 1] += L[2 * r] * im + L[2 * r + 1] * re;
        }
      }
    }
  }

  /// x -= sum_r conj(L_rj) y_r over `count` rows r.
  static void subtract_products(const double* L, const double* y, Offset count, double* x) {
    for (int c = 0; c < K; ++c) {
      if constexpr (W == 1) {
        double sum = 0;
#pragma omp simd reduction(+ : sum)
        for (Offset r = 0; r < count; ++r) sum += L[r] * y[r * K + c];
        x[c] -= sum;
      } else {
        double re = 0, im = 0;
#pragma omp simd reduction(+ : re, im)
        for (Offset r = 0; r < count; ++r) {
          re += L[2 * r] * y[r * width + 2 * c] + L[2 * r + 1] * y[r * width + 2 * c + 1];
          im += L[2 * r] * y[r * width + 2 * c + 1] - L[2 * r + 1] * y[r * width + 2 * c];
        }
        x[2 * c] -= re;
        x[2 * c + 1] -= im;
      }
    }
  }

  /// Asks for a column before it is needed; past the supernode's ends those of its neighbours in memory. Columns are too
  /// short for the processor to find out by itself how to read on, the more so on the way up. (Unless inlined, GCC takes
  /// the function for one without effect and leaves its calls out.)
  [[gnu::always_inline]] void prefetch(const Supernode<W>& s, Offset column) const {
    constexpr Offset line = 64 / sizeof(double);
    const Offset begin = std::max<Offset>(s.begin + column * s.rows, 0);
    const Offset end = std::min<Offset>(begin + s.rows, L_.value_begin.back());
    for (Offset k = begin * W; k < end * W; k += line) __builtin_prefetch(L_.values + k);
  }

  static void divide(double* x, double pivot) {
    for (int c = 0; c < width; ++c) x[c] /= pivot;
  }

  /// L y = x
  /// @param target  target(row): where what a row below has to lose is taken from
  template <class Target>
  void forward(const Supernode<W>& s, Buffer& sums, const Target& target) {
    double* own = x_.get() + s.first * width;
    const Offset below = s.rows - s.columns;
    // A point source is zero almost everywhere, and stays so outside its path to the root of the elimination tree.
    if (std::all_of(own, own + s.columns * width, [](double value) { return value == 0; })) return;
    std::fill_n(sums.begin(), below * width, 0.0);
    for (Offset j = 0; j < s.columns; ++j) {
      const double* L = s.at(0, j);
      double* x = own + j * width;
      prefetch(s, j + 2);
      divide(x, L[j * W]);
      add_column(L + (j + 1) * W, x, -1.0, x + width, s.columns - j - 1);
      add_column(L + s.columns * W, x, 1.0, sums.data(), below);
    }
    for (Offset r = 0; r < below; ++r) {
      double* to = target(s.index[s.columns + r]);
      for (int c = 0; c < width; ++c) to[c] -= sums[r * width + c];
    }
  }

  /// L^H x = y
  void backward(const Supernode<W>& s, Buffer& above) {
    double* own = x_.get() + s.first * width;
    const Offset below = s.rows - s.columns;
    for (Offset r = 0; r < below; ++r)
      for (int c = 0; c < width; ++c) above[r * width + c] = x_[s.index[s.columns + r] * width + c];
    for (Offset j = s.columns; j-- > 0;) {
      const double* L = s.at(0, j);
      double* x = own + j * width;
      prefetch(s, j - 2);
      subtract_products(L + s.columns * W, above.data(), below, x);
      subtract_products(L + (j + 1) * W, x + width, s.columns - j - 1, x);
      divide(x, L[j * W]);
    }
  }

  const SupernodalFactor& L_;
  const SolveGroups* groups_;
  unsigned threads_;
  std::unique_ptr<double[]> x_;
  Offset longest_ = 0;
};

template <int W>
void dispatch(const SupernodalFactor& L, std::span<double> X, Offset columns, const SolveGroups* groups,
              unsigned threads) {
  switch (columns) {
    case 1:
      return NarrowSolve<W, 1>(L, groups, threads).solve(X);
    case 2:
      return NarrowSolve<W, 2>(L, groups, threads).solve(X);
    case 3:
      return NarrowSolve<W, 3>(L, groups, threads).solve(X);
    case 4:
      return NarrowSolve<W, 4>(L, groups, threads).solve(X);
  }
}

}  // namespace

void narrow_solve(const SupernodalFactor& L, std::span<double> X, Offset columns, const SolveGroups* groups,
                  unsigned threads) {
  (L.is_complex ? dispatch<2> : dispatch<1>)(L, X, columns, groups, threads);
}

}  // namespace ahm
