#include "cholesky/triangular_solve.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "ahm/util/parallel.hpp"
#include "cholesky/registers.hpp"
#include "cholesky/supernode_kernels.hpp"

namespace ahm {
namespace {

/// Calls body(group, its subtrees) for every group, on several threads.
template <class Body>
void for_each_group(const SolveGroups& groups, unsigned threads, const Body& body) {
  detail::parallel_chunks(groups.count(), 1, threads, [&](Offset group, Offset) {
    body(group, std::span(groups.subtrees).subspan(groups.begin[group], groups.begin[group + 1] - groups.begin[group]));
  });
}

/// Right-hand sides in elimination order, column major; real (W = 1) or complex (W = 2).
template <int W>
class PermutedColumns {
 public:
  PermutedColumns(const SupernodalFactor& L, Offset columns)
      : L_(L), x_(std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(L.size * columns * W))) {}

  double* at(Offset column, Offset row) const { return x_.get() + (column * L_.size + row) * W; }

  /// Copies columns from X, which is in the order of the matrix (In), or back to X.
  template <bool In>
  void permute(std::span<double> X, Offset columns, unsigned threads = 1) {
    detail::parallel_chunks(L_.size, 1 << 15, threads, [&](Offset begin, Offset end) {
      for (Offset c = 0; c < columns; ++c)
        for (Offset k = begin; k < end; ++k)
          for (int w = 0; w < W; ++w) {
            double& outside = X[(c * L_.size + L_.permutation[k]) * W + w];
            double& inside = at(c, k)[w];
            In ? inside = outside : outside = inside;
          }
    });
  }

  /// Whether the supernode's own rows are zero in all columns. A point source is zero almost everywhere. In the forward solve it stays
  /// zero outside its path to the root of the elimination tree.
  bool is_zero(const Supernode<W>& s, Offset columns) const {
    for (Offset c = 0; c < columns; ++c)
      if (!std::all_of(at(c, s.first), at(c, s.first + s.columns), [](double value) { return value == 0; }))
        return false;
    return true;
  }

 private:
  const SupernodalFactor& L_;
  std::unique_ptr<double[]> x_;
};

/// Solves for K columns, real (W = 1) or complex (W = 2).
template <int W, int K>
class NarrowSolve {
 public:
  NarrowSolve(const SupernodalFactor& L, const SolveGroups* groups, unsigned threads)
      : L_(L), groups_(groups), threads_(threads), x_(L, K), longest_(L.max_rows()) {}

  void solve(std::span<double> X) {
    const unsigned threads = groups_ ? threads_ : 1;
    x_.template permute<true>(X, K, threads);
    if (groups_)
      solve_by_groups();
    else
      solve_in_order();
    x_.template permute<false>(X, K, threads);
  }

 private:
  using Buffer = std::vector<double>;
  Buffer rows(Offset count) const { return Buffer(static_cast<std::size_t>(count) * W * K); }
  double* at(int column, Offset row) const { return x_.at(column, row); }

  void solve_in_order() {
    Buffer y = rows(longest_);
    for (Offset s = 0; s < L_.supernodes(); ++s) forward(Supernode<W>(L_, s), y, target_in_x());
    for (Offset s = L_.supernodes(); s-- > 0;) backward(Supernode<W>(L_, s), y);
  }

  void solve_by_groups() {
    const auto top_rows = static_cast<Offset>(groups_->top_rows);
    std::vector<Buffer> top_sums(static_cast<std::size_t>(groups_->count()));
    for_each_group(*groups_, threads_, [&](Offset group, const auto& subtrees) {
      Buffer y = rows(longest_);
      Buffer& sums = top_sums[group] = rows(top_rows);
      for (const auto& [first, last, end] : subtrees)
        for (Offset s = first; s < last; ++s)
          forward(Supernode<W>(L_, s), y, [&, end = end](int column, Offset row) {
            return row < end ? at(column, row) : sums.data() + (column * top_rows + groups_->place[row]) * W;
          });
    });
    Buffer y = rows(longest_);
    for (int column = 0; column < K; ++column) {
      Offset k = column * top_rows * W;
      for (const Offset s : groups_->top)
        for (double* x = at(column, L_.super[s]); x != at(column, L_.super[s + 1]); ++x, ++k)
          for (const Buffer& sums : top_sums) *x += sums[k];
    }
    for (const Offset s : groups_->top) forward(Supernode<W>(L_, s), y, target_in_x());
    for (auto s = groups_->top.rbegin(); s != groups_->top.rend(); ++s) backward(Supernode<W>(L_, *s), y);
    for_each_group(*groups_, threads_, [&](Offset, const auto& subtrees) {
      Buffer own_y = rows(longest_);
      for (auto tree = subtrees.rbegin(); tree != subtrees.rend(); ++tree)
        for (Offset s = tree->last; s-- > tree->first;) backward(Supernode<W>(L_, s), own_y);
    });
  }

  auto target_in_x() const {
    return [this](int column, Offset row) { return at(column, row); };
  }

  /// Solves L y = x for the rows of a supernode.
  /// @param target  target(column, row): where to add the contribution to a row below
  template <class Target>
  void forward(const Supernode<W>& s, Buffer& y, const Target& target) {
    if (x_.is_zero(s, K)) return;
    for (int c = 0; c < K; ++c) {
      double* column = y.data() + c * s.rows * W;
      std::copy(at(c, s.first), at(c, s.first + s.columns), column);
      std::fill(column + s.columns * W, column + s.rows * W, 0.0);
    }
    kernels_.forward(s, y.data());
    for (int c = 0; c < K; ++c) {
      const double* column = y.data() + c * s.rows * W;
      std::copy(column, column + s.columns * W, at(c, s.first));
      for (Offset r = s.columns; r < s.rows; ++r)
        for (int w = 0; w < W; ++w) target(c, s.index[r])[w] += column[r * W + w];
    }
  }

  /// Solves L^H x = y for the rows of a supernode.
  void backward(const Supernode<W>& s, Buffer& y) {
    for (int c = 0; c < K; ++c) {
      double* column = y.data() + c * s.rows * W;
      std::copy(at(c, s.first), at(c, s.first + s.columns), column);
      for (Offset r = s.columns; r < s.rows; ++r)
        for (int w = 0; w < W; ++w) column[r * W + w] = at(c, s.index[r])[w];
    }
    kernels_.backward(s, y.data());
    for (int c = 0; c < K; ++c) {
      const double* column = y.data() + c * s.rows * W;
      std::copy(column, column + s.columns * W, at(c, s.first));
    }
  }

  const SupernodalFactor& L_;
  const SolveGroups* groups_;
  unsigned threads_;
  SupernodeKernels<W> kernels_ = supernode_kernels<W, K>();
  PermutedColumns<W> x_;
  Offset longest_;
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

namespace {

/// Doubles per row of a block: 16 real columns, or the real parts and then the imaginary parts of 8 complex columns.
constexpr int width = 16;

/// A sum of rows times entries of the factor, real (W = 1) or complex (W = 2), in registers of N doubles.
template <int W, int N>
struct RowSum {
  using Lane = typename Lanes<N>::Type;
  static constexpr int lanes = width / N;
  Lane sum[lanes] = {};

  [[gnu::always_inline]] void add(const double* L, const double* row) { add(L[0], W == 1 ? 0 : L[1], row); }
  [[gnu::always_inline]] void add_conjugate(const double* L, const double* row) { add(L[0], W == 1 ? 0 : -L[1], row); }
  [[gnu::always_inline]] void subtract_from(double* row) const {
    Lane* x = reinterpret_cast<Lane*>(row);
#pragma GCC unroll 8
    for (int c = 0; c < lanes; ++c) x[c] -= sum[c];
  }

 private:
  [[gnu::always_inline]] void add(double real, [[maybe_unused]] double imaginary, const double* row) {
    const Lane* x = reinterpret_cast<const Lane*>(row);
    if constexpr (W == 1) {
#pragma GCC unroll 8
      for (int c = 0; c < lanes; ++c) sum[c] += real * x[c];
    } else {
      constexpr int half = lanes / 2;
#pragma GCC unroll 4
      for (int c = 0; c < half; ++c) {
        sum[c] += real * x[c] - imaginary * x[half + c];
        sum[half + c] += real * x[half + c] + imaginary * x[c];
      }
    }
  }
};

/// Solves for up to 16 / W columns, real (W = 1) or complex (W = 2).
template <int W>
class BlockSolve {
 public:
  static constexpr Offset columns_at_once = width / W;

  BlockSolve(const SupernodalFactor& L, const SolveGroups* groups, unsigned threads)
      : L_(L), groups_(groups), threads_(groups ? threads : 1), x_(static_cast<std::size_t>(L.size) * width) {}

  void solve(std::span<double> X, Offset columns) {
    if (columns < columns_at_once) std::fill(x_.begin(), x_.end(), 0.0);
    permute<true>(X, columns);
    if (groups_) {
      solve_by_groups();
    } else {
      forward(0, L_.supernodes(), [this](Offset k) { return row(k); });
      backward(0, L_.supernodes());
    }
    permute<false>(X, columns);
  }

 private:
  double* row(Offset k) { return x_.data() + k * width; }

  template <bool In>
  void permute(std::span<double> X, Offset columns) {
    detail::parallel_chunks(L_.size, 1 << 13, threads_, [&](Offset begin, Offset end) {
      for (Offset k = begin; k < end; ++k)
        for (Offset c = 0; c < columns; ++c)
          for (int w = 0; w < W; ++w) {
            double& outside = X[(c * L_.size + L_.permutation[k]) * W + w];
            double& inside = row(k)[w * columns_at_once + c];
            In ? inside = outside : outside = inside;
          }
    });
  }

  void solve_by_groups() {
    std::vector<std::vector<double>> top_sums(static_cast<std::size_t>(groups_->count()));
    for_each_group(*groups_, threads_, [&](Offset group, const auto& subtrees) {
      std::vector<double>& sums = top_sums[group];
      sums.resize(groups_->top_rows * width);
      for (const auto& [first, last, end] : subtrees)
        forward(first, last, [&, own_end = end](Offset k) {
          return k < own_end ? row(k) : sums.data() + Offset{groups_->place[k]} * width;
        });
    });
    Offset place = 0;
    for (const Offset s : groups_->top) {
      for (Offset k = L_.super[s]; k < L_.super[s + 1]; ++k, ++place)
        for (const std::vector<double>& sums : top_sums)
          for (Offset c = 0; c < width; ++c) row(k)[c] += sums[place * width + c];
      forward(s, s + 1, [this](Offset k) { return row(k); });
    }
    for (auto s = groups_->top.rbegin(); s != groups_->top.rend(); ++s) backward(*s, *s + 1);
    for_each_group(*groups_, threads_, [&](Offset, const auto& subtrees) {
      for (auto tree = subtrees.rbegin(); tree != subtrees.rend(); ++tree) backward(tree->first, tree->last);
    });
  }

  /// Solves L y = x for the rows of the supernodes first to last - 1.
  /// @param target  target(row): where to add the contribution to a row below a supernode
  template <class Target>
  void forward(Offset first, Offset last, const Target& target) {
    in_widest_registers([&](auto N) {
      for (Offset s = first; s < last; ++s) forward_one<N()>(Supernode<W>(L_, s), target);
    });
  }

  /// Solves L^H x = y for the rows of the supernodes first to last - 1.
  void backward(Offset first, Offset last) {
    in_widest_registers([&](auto N) {
      for (Offset s = last; s-- > first;) backward_one<N()>(Supernode<W>(L_, s));
    });
  }

  [[gnu::always_inline]] static void divide(double* x, double pivot) {
#pragma omp simd
    for (int c = 0; c < width; ++c) x[c] /= pivot;
  }

  template <int N, class Target>
  [[gnu::always_inline]] void forward_one(const Supernode<W>& s, const Target& target) {
    double* own = row(s.first);
    // See `PermutedColumns::is_zero`.
    if (std::all_of(own, own + s.columns * width, [](double value) { return value == 0; })) return;
    for (Offset r = 0; r < s.columns; ++r) {
      RowSum<W, N> sum;
      for (Offset j = 0; j < r; ++j) sum.add(s.at(r, j), own + j * width);
      sum.subtract_from(own + r * width);
      divide(own + r * width, *s.at(r, r));
    }
    for (Offset r = s.columns; r < s.rows; ++r) {
      RowSum<W, N> sum;
      for (Offset j = 0; j < s.columns; ++j) sum.add(s.at(r, j), own + j * width);
      sum.subtract_from(target(s.index[r]));
    }
  }

  template <int N>
  [[gnu::always_inline]] void backward_one(const Supernode<W>& s) {
    double* own = row(s.first);
    for (Offset j = s.columns; j-- > 0;) {
      RowSum<W, N> sum;
      for (Offset r = s.columns; r < s.rows; ++r) sum.add_conjugate(s.at(r, j), row(s.index[r]));
      for (Offset r = j + 1; r < s.columns; ++r) sum.add_conjugate(s.at(r, j), own + r * width);
      sum.subtract_from(own + j * width);
      divide(own + j * width, *s.at(j, j));
    }
  }

  const SupernodalFactor& L_;
  const SolveGroups* groups_;
  unsigned threads_;
  std::vector<double> x_;
};

template <int W>
void solve_by_blocks(const SupernodalFactor& L, std::span<double> X, Offset columns, const SolveGroups* groups,
                     unsigned threads) {
  BlockSolve<W> block(L, groups, threads);
  const Offset column_size = L.size * W;
  for (Offset c = 0; c < columns; c += block.columns_at_once) {
    const Offset count = std::min(block.columns_at_once, columns - c);
    block.solve(X.subspan(c * column_size, count * column_size), count);
  }
}

}  // namespace

void block_solve(const SupernodalFactor& L, std::span<double> X, Offset columns, const SolveGroups* groups,
                 unsigned threads) {
  (L.is_complex ? solve_by_blocks<2> : solve_by_blocks<1>)(L, X, columns, groups, threads);
}

}  // namespace ahm
