#include "heat/triangular_solve.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "ahm/util/parallel.hpp"
#include "heat/permuted_columns.hpp"
#include "heat/solve_groups.hpp"
#include "heat/supernode_kernels.hpp"

namespace ahm {
namespace {

/// For K columns of real (W = 1) or complex (W = 2) numbers.
template <int W, int K>
class NarrowSolve {
 public:
  NarrowSolve(const SupernodalFactor& L, const SolveGroups* groups, unsigned threads)
      : L_(L), groups_(groups), threads_(threads), x_(L, K), longest_(L.most_rows()) {}

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
    for (Offset s = 0; s < L_.supernodes(); ++s) forward(Supernode<W>(L_, s), y, in_x());
    for (Offset s = L_.supernodes(); s-- > 0;) backward(Supernode<W>(L_, s), y);
  }

  void solve_by_groups() {
    const auto each_group = [&](const auto& body) {
      detail::parallel_chunks(groups_->count(), 1, threads_, [&](Offset group, Offset) {
        Buffer y = rows(longest_);
        body(group,
             std::span(groups_->subtrees)
                 .subspan(groups_->begin[group], groups_->begin[group + 1] - groups_->begin[group]),
             y);
      });
    };
    const auto top_rows = static_cast<Offset>(groups_->top_rows);
    std::vector<Buffer> to_top(static_cast<std::size_t>(groups_->count()));
    each_group([&](Offset group, const auto& subtrees, Buffer& y) {
      Buffer& sums = to_top[group] = rows(top_rows);
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
          for (const Buffer& sums : to_top) *x += sums[k];
    }
    for (const Offset s : groups_->top) forward(Supernode<W>(L_, s), y, in_x());
    for (auto s = groups_->top.rbegin(); s != groups_->top.rend(); ++s) backward(Supernode<W>(L_, *s), y);
    each_group([&](Offset, const auto& subtrees, Buffer& own_y) {
      for (auto tree = subtrees.rbegin(); tree != subtrees.rend(); ++tree)
        for (Offset s = tree->last; s-- > tree->first;) backward(Supernode<W>(L_, s), own_y);
    });
  }

  auto in_x() const {
    return [this](int column, Offset row) { return at(column, row); };
  }

  /// L y = x
  /// @param target  target(column, row): what a row below is taken from
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

  /// L^H x = y
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

}  // namespace ahm
