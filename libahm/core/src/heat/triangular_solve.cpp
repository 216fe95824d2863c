#include "heat/triangular_solve.hpp"

#include <algorithm>
#include <vector>

namespace ahm {
namespace {

/// The kernels for K columns of real (W = 1) or complex (W = 2) numbers. Vectors are stored row by row: K numbers of
/// row 0, ...
template <int W, int K>
class NarrowSolve {
  static constexpr int width = W * K;

 public:
  explicit NarrowSolve(const SupernodalFactor& L) : L_(L), x_(static_cast<std::size_t>(L.size) * width) {
    Offset longest = 0;
    for (std::size_t s = 0; s + 1 < L.row_begin.size(); ++s)
      longest = std::max(longest, L.row_begin[s + 1] - L.row_begin[s]);
    below_.resize(static_cast<std::size_t>(longest) * width);
  }

  void solve(std::span<double> X) {
    permute<true>(X);
    const auto supernodes = static_cast<Offset>(L_.super.size()) - 1;
    for (Offset s = 0; s < supernodes; ++s) forward(Supernode<W>(L_, s));
    for (Offset s = supernodes; s-- > 0;) backward(Supernode<W>(L_, s));
    permute<false>(X);
  }

 private:
  template <bool In>
  void permute(std::span<double> X) {
    for (Offset k = 0; k < L_.size; ++k)
      for (int c = 0; c < K; ++c)
        for (int w = 0; w < W; ++w) {
          double& outside = X[(c * L_.size + L_.permutation[k]) * W + w];
          double& inside = x_[k * width + c * W + w];
          In ? inside = outside : outside = inside;
        }
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
  void forward(const Supernode<W>& s) {
    double* own = x_.data() + s.first * width;
    const Offset below = s.rows - s.columns;
    // A point source is zero almost everywhere, and stays so outside its path to the root of the elimination tree.
    if (std::all_of(own, own + s.columns * width, [](double value) { return value == 0; })) return;
    std::fill_n(below_.begin(), below * width, 0.0);
    for (Offset j = 0; j < s.columns; ++j) {
      const double* L = s.at(0, j);
      double* x = own + j * width;
      prefetch(s, j + 2);
      divide(x, L[j * W]);
      add_column(L + (j + 1) * W, x, -1.0, x + width, s.columns - j - 1);
      add_column(L + s.columns * W, x, 1.0, below_.data(), below);
    }
    for (Offset r = 0; r < below; ++r)
      for (int c = 0; c < width; ++c) x_[s.index[s.columns + r] * width + c] -= below_[r * width + c];
  }

  /// L^H x = y
  void backward(const Supernode<W>& s) {
    double* own = x_.data() + s.first * width;
    const Offset below = s.rows - s.columns;
    for (Offset r = 0; r < below; ++r)
      for (int c = 0; c < width; ++c) below_[r * width + c] = x_[s.index[s.columns + r] * width + c];
    for (Offset j = s.columns; j-- > 0;) {
      const double* L = s.at(0, j);
      double* x = own + j * width;
      prefetch(s, j - 2);
      subtract_products(L + s.columns * W, below_.data(), below, x);
      subtract_products(L + (j + 1) * W, x + width, s.columns - j - 1, x);
      divide(x, L[j * W]);
    }
  }

  const SupernodalFactor& L_;
  std::vector<double> x_, below_;
};

template <int W>
void dispatch(const SupernodalFactor& L, std::span<double> X, Offset columns) {
  switch (columns) {
    case 1:
      return NarrowSolve<W, 1>(L).solve(X);
    case 2:
      return NarrowSolve<W, 2>(L).solve(X);
    case 3:
      return NarrowSolve<W, 3>(L).solve(X);
    case 4:
      return NarrowSolve<W, 4>(L).solve(X);
  }
}

}  // namespace

void narrow_solve(const SupernodalFactor& L, std::span<double> X, Offset columns) {
  L.is_complex ? dispatch<2>(L, X, columns) : dispatch<1>(L, X, columns);
}

}  // namespace ahm
