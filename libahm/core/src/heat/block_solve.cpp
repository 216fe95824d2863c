#include "heat/block_solve.hpp"

#include <algorithm>
#include <vector>

namespace ahm {
namespace {

/// Numbers of a row of X that are at work at once: 16 real columns, or the real and then the imaginary parts of 8 complex ones.
constexpr int width = 16;

/// Numbers that are at work at once by one instruction.
template <int N>
struct Lanes {
  using Type [[gnu::vector_size(N * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] = double;
};

/// A sum of rows, each times a number of the factor, real (W = 1) or complex (W = 2); it stays in registers of N numbers.
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

template <int W, int N>
class BlockSolve {
 public:
  static constexpr Offset columns_at_once = width / W;

  explicit BlockSolve(const SupernodalFactor& L) : L_(L), x_(static_cast<std::size_t>(L.size) * width) {}

  /// For up to `columns_at_once` columns.
  void solve(std::span<double> X, Offset columns) {
    if (columns < columns_at_once) std::fill(x_.begin(), x_.end(), 0.0);
    permute<true>(X, columns);
    const auto supernodes = static_cast<Offset>(L_.super.size()) - 1;
    for (Offset s = 0; s < supernodes; ++s) forward(Supernode<W>(L_, s));
    for (Offset s = supernodes; s-- > 0;) backward(Supernode<W>(L_, s));
    permute<false>(X, columns);
  }

 private:
  double* row(Offset k) { return x_.data() + k * width; }

  template <bool In>
  void permute(std::span<double> X, Offset columns) {
    for (Offset k = 0; k < L_.size; ++k)
      for (Offset c = 0; c < columns; ++c)
        for (int w = 0; w < W; ++w) {
          double& outside = X[(c * L_.size + L_.permutation[k]) * W + w];
          double& inside = row(k)[w * columns_at_once + c];
          In ? inside = outside : outside = inside;
        }
  }

  static void divide(double* x, double pivot) {
#pragma omp simd
    for (int c = 0; c < width; ++c) x[c] /= pivot;
  }

  /// L y = x
  void forward(const Supernode<W>& s) {
    double* own = row(s.first);
    // A point source is zero almost everywhere, and stays so outside its path to the root of the elimination tree.
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
      sum.subtract_from(row(s.index[r]));
    }
  }

  /// L^H x = y
  void backward(const Supernode<W>& s) {
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
  std::vector<double> x_;
};

template <int W, int N>
void solve_by_blocks(const SupernodalFactor& L, std::span<double> X, Offset columns) {
  BlockSolve<W, N> block(L);
  const Offset column_size = L.size * W;
  for (Offset c = 0; c < columns; c += block.columns_at_once) {
    const Offset count = std::min(block.columns_at_once, columns - c);
    block.solve(X.subspan(c * column_size, count * column_size), count);
  }
}

template <int N>
void solve_by_lanes(const SupernodalFactor& L, std::span<double> X, Offset columns) {
  L.is_complex ? solve_by_blocks<2, N>(L, X, columns) : solve_by_blocks<1, N>(L, X, columns);
}

#ifdef __x86_64__
/// With four numbers at once, where the processor can: sum by sum the same numbers, bit for bit.
[[gnu::target("avx2"), gnu::flatten]] void solve_by_fours(const SupernodalFactor& L, std::span<double> X,
                                                          Offset columns) {
  solve_by_lanes<4>(L, X, columns);
}
#endif

}  // namespace

void block_solve(const SupernodalFactor& L, std::span<double> X, Offset columns) {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return solve_by_fours(L, X, columns);
#endif
  solve_by_lanes<2>(L, X, columns);
}

}  // namespace ahm
