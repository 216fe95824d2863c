#include "ahm/cholesky/linear_solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "ahm/util/text.hpp"

namespace ahm {
namespace {

/// y += K x. K is the full matrix, of which only the upper triangle is stored; real (W = 1) or complex (W = 2).
template <int W>
void add_product(const SparseUpper& K, const double* x, double* y) {
  const auto add = [](const double* a, double sign, const double* from, double* to) {
    to[0] += a[0] * from[0];
    if constexpr (W == 2) {
      const double imaginary = sign * a[1];
      to[0] -= imaginary * from[1];
      to[1] += a[0] * from[1] + imaginary * from[0];
    }
  };
  for (Offset j = 0; j < K.size(); ++j)
    for (Offset p = K.column_begin[j]; p < K.column_begin[j + 1]; ++p) {
      const Offset i = K.rows[p];
      const double* a = K.values.data() + p * W;
      add(a, 1, x + j * W, y + i * W);
      if (i != j) add(a, -1, x + i * W, y + j * W);
    }
}

/// Computes K x.
std::vector<double> multiply(const SparseUpper& K, const std::vector<double>& x) {
  std::vector<double> y(x.size(), 0.0);
  (K.is_complex ? add_product<2> : add_product<1>)(K, x.data(), y.data());
  return y;
}

double largest(const std::vector<double>& v) {
  double m = 0;
  for (double x : v) m = std::isnan(x) ? INFINITY : std::max(m, std::abs(x));
  return m;
}

}  // namespace

NotPositiveDefinite not_positive_definite(const char* name, Offset column, Offset size) {
  return {"not_positive_definite",
          std::string("operator ") + name + " is not positive definite (column " + std::to_string(column) + " of " +
              std::to_string(size) + " in elimination order)",
          "check the graph: negative weights and nearly coincident points can cause this"};
}

std::vector<double> checked_solve(const LinearSolver& solver, const SparseUpper& matrix, std::vector<double> b,
                                  const char* name, unsigned threads) {
  std::vector<double> x = b;
  solver.solve(x, 1, threads);
  const double scale = largest(matrix.values) * largest(x) + largest(b);
  std::vector<double> residual = multiply(matrix, x);
  for (std::size_t i = 0; i < b.size(); ++i) residual[i] -= b[i];
  if (!std::isfinite(scale) || !(largest(residual) <= 1e-10 * scale))
    throw NotPositiveDefinite(
        "ill_conditioned",
        std::string("operator ") + name + ": the factorization fails its residual check (" +
            detail::number(largest(residual) / scale) + " relative)",
        "remove nearly dependent rows, or scale entries that differ by more than a factor of 1e10");
  return x;
}

void check_residual(const LinearSolver& solver, const SparseUpper& matrix, const char* name, unsigned threads) {
  std::vector<double> b(static_cast<std::size_t>(matrix.size()) * (matrix.is_complex ? 2 : 1));
  std::uint32_t state = 12345;
  for (double& value : b) value = ((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-23 - 1.0;
  checked_solve(solver, matrix, std::move(b), name, threads);
}

}  // namespace ahm
