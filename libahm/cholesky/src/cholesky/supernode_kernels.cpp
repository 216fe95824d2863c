#include "cholesky/supernode_kernels.hpp"

namespace ahm {
namespace {

/// Prefetch distance, in columns.
constexpr Offset ahead_columns = 8;

/// A real (W = 1) or complex (W = 2) number.
template <int W>
struct Number {
  double re, im = 0;

  [[gnu::always_inline]] static Number at(const double* x) {
    if constexpr (W == 1)
      return {x[0]};
    else
      return {x[0], x[1]};
  }
  [[gnu::always_inline]] void store(double* x) const {
    x[0] = re;
    if constexpr (W == 2) x[1] = im;
  }
  [[gnu::always_inline]] void subtract(Number a) {
    re -= a.re;
    if constexpr (W == 2) im -= a.im;
  }
  [[gnu::always_inline]] void subtract(Number a, Number b) {
    re -= W == 1 ? a.re * b.re : a.re * b.re - a.im * b.im;
    if constexpr (W == 2) im -= a.re * b.im + a.im * b.re;
  }
  [[gnu::always_inline]] void subtract_conjugate(Number a, Number b) { subtract({a.re, -a.im}, b); }
  [[gnu::always_inline]] void scale(double factor) {
    re *= factor;
    if constexpr (W == 2) im *= factor;
  }
};

/// y -= x L_r for four consecutive doubles of a column of the factor.
template <int W>
[[gnu::always_inline]] inline void subtract_product(Number<W> x, const Four* column, Four* y) {
  if constexpr (W == 1)
    *y -= x.re * *column;
  else
    *y -= x.re * *column + Four{-x.im, x.im, -x.im, x.im} * __builtin_shufflevector(*column, *column, 1, 0, 3, 2);
}

/// Computes sum_r conj(L_r) y_r over the rows of a column, four doubles at a time.
template <int W>
struct Product {
  Four straight{}, crossed{};

  [[gnu::always_inline]] void add(const Four* column, const Four* y) {
    straight += *column * *y;
    if constexpr (W == 2) crossed += *column * __builtin_shufflevector(*y, *y, 1, 0, 3, 2);
  }
  [[gnu::always_inline]] Number<W> sum() const {
    const double re = (straight[0] + straight[1]) + (straight[2] + straight[3]);
    if constexpr (W == 1)
      return {re};
    else
      return {re, (crossed[0] - crossed[1]) + (crossed[2] - crossed[3])};
  }
};

/// Prefetches entries of the factor that are read `ahead_columns` columns later, once per cache line. Columns are too short for the
/// hardware prefetcher, above all in the backward solve. At the ends of a supernode this prefetches from the adjacent supernodes.
/// @param ahead  distance in doubles; negative in the backward solve
template <int J>
[[gnu::always_inline]] inline void prefetch(const double* const (&column)[J], Offset r, Offset ahead) {
  if (constexpr Offset half_line = 4; r & half_line)
    for (int a = 0; a < J; ++a) __builtin_prefetch(column[a] + r + ahead);
}

/// The columns j to j + J - 1 of a supernode, and the inverses of their pivots.
template <int W, int J>
struct Columns {
  const double* column[J];
  double inverse[J];

  [[gnu::always_inline]] Columns(const Supernode<W>& s, Offset j) {
    for (int a = 0; a < J; ++a) {
      column[a] = s.at(0, j + a);
      inverse[a] = 1 / column[a][(j + a) * W];
    }
  }
  [[gnu::always_inline]] Number<W> at(int a, Offset place) const { return Number<W>::at(column[a] + place); }
};

/// Forward substitution with the columns j to j + J - 1.
template <int W, int K, int J>
[[gnu::always_inline]] inline void forward_columns(const Supernode<W>& s, Offset j, double* y) {
  const Offset rows = s.rows * W;
  const Columns<W, J> L(s, j);
  Number<W> x[K][J];
  for (int c = 0; c < K; ++c)
    for (int a = 0; a < J; ++a) {
      double* own = y + c * rows + (j + a) * W;
      x[c][a] = Number<W>::at(own);
      for (int b = 0; b < a; ++b) x[c][a].subtract(L.at(b, (j + a) * W), x[c][b]);
      x[c][a].scale(L.inverse[a]);
      x[c][a].store(own);
    }
  Offset r = (j + J) * W;
  for (; r + 4 <= rows; r += 4) {
    prefetch(L.column, r, ahead_columns * rows);
#pragma GCC unroll 4
    for (int c = 0; c < K; ++c) {
      Four left = *four(y + c * rows + r);
#pragma GCC unroll 4
      for (int a = 0; a < J; ++a) subtract_product(x[c][a], four(L.column[a] + r), &left);
      *four(y + c * rows + r) = left;
    }
  }
  for (; r < rows; r += W)
    for (int c = 0; c < K; ++c) {
      double* own = y + c * rows + r;
      Number<W> left = Number<W>::at(own);
      for (int a = 0; a < J; ++a) left.subtract(L.at(a, r), x[c][a]);
      left.store(own);
    }
}

/// Backward substitution with the columns j to j + J - 1. Reads the last rows first: values of the columns solved just before may not
/// be available yet.
template <int W, int K, int J>
[[gnu::always_inline]] inline void backward_columns(const Supernode<W>& s, Offset j, double* y) {
  const Offset rows = s.rows * W;
  const Offset below = (j + J) * W;
  const Columns<W, J> L(s, j);
  Product<W> products[K][J];
  Offset r = rows;
  for (; r - 4 >= below; r -= 4) {
    prefetch(L.column, r - 4, -ahead_columns * rows);
#pragma GCC unroll 4
    for (int c = 0; c < K; ++c) {
      const Four known = *four(y + c * rows + r - 4);
#pragma GCC unroll 4
      for (int a = 0; a < J; ++a) products[c][a].add(four(L.column[a] + r - 4), &known);
    }
  }
  for (int c = 0; c < K; ++c) {
    double* own = y + c * rows;
    Number<W> x[J];
    for (int a = J - 1; a >= 0; --a) {
      x[a] = Number<W>::at(own + (j + a) * W);
      x[a].subtract(products[c][a].sum());
      for (Offset rest = below; rest < r; rest += W) x[a].subtract_conjugate(L.at(a, rest), Number<W>::at(own + rest));
      for (int b = a + 1; b < J; ++b) x[a].subtract_conjugate(L.at(a, (j + b) * W), x[b]);
      x[a].scale(L.inverse[a]);
      x[a].store(own + (j + a) * W);
    }
  }
}

/// Columns per step: as many as fit into the registers.
template <int W, int K>
constexpr Offset at_once = W* K <= 2 ? 4 : 2;

template <int W, int K>
[[gnu::always_inline]] inline void forward(const Supernode<W>& s, double* y) {
  constexpr Offset J = at_once<W, K>;
  Offset j = 0;
  for (; j + J <= s.columns; j += J) forward_columns<W, K, J>(s, j, y);
  for (; j < s.columns; ++j) forward_columns<W, K, 1>(s, j, y);
}

template <int W, int K>
[[gnu::always_inline]] inline void backward(const Supernode<W>& s, double* y) {
  constexpr Offset J = at_once<W, K>;
  Offset j = s.columns;
  while (j % J != 0) backward_columns<W, K, 1>(s, --j, y);
  for (; j > 0; j -= J) backward_columns<W, K, J>(s, j - J, y);
}

#ifdef __x86_64__
template <int W, int K>
[[gnu::target("avx2")]] void forward_avx2(const Supernode<W>& s, double* y) {
  forward<W, K>(s, y);
}
template <int W, int K>
[[gnu::target("avx2")]] void backward_avx2(const Supernode<W>& s, double* y) {
  backward<W, K>(s, y);
}
#endif
template <int W, int K>
void forward_anywhere(const Supernode<W>& s, double* y) {
  forward<W, K>(s, y);
}
template <int W, int K>
void backward_anywhere(const Supernode<W>& s, double* y) {
  backward<W, K>(s, y);
}

}  // namespace

template <int W, int K>
SupernodeKernels<W> supernode_kernels() {
#ifdef __x86_64__
  if (widest_registers() != Registers::plain) return {forward_avx2<W, K>, backward_avx2<W, K>};
#endif
  return {forward_anywhere<W, K>, backward_anywhere<W, K>};
}

template SupernodeKernels<1> supernode_kernels<1, 1>();
template SupernodeKernels<1> supernode_kernels<1, 2>();
template SupernodeKernels<1> supernode_kernels<1, 3>();
template SupernodeKernels<1> supernode_kernels<1, 4>();
template SupernodeKernels<2> supernode_kernels<2, 1>();
template SupernodeKernels<2> supernode_kernels<2, 2>();
template SupernodeKernels<2> supernode_kernels<2, 3>();
template SupernodeKernels<2> supernode_kernels<2, 4>();

}  // namespace ahm
