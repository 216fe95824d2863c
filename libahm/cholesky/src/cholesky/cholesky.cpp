#include "ahm/cholesky/cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "cholesky/blas.hpp"
#include "cholesky/multifrontal.hpp"
#include "cholesky/ordering.hpp"
#include "cholesky/supernodal_pattern.hpp"
#include "cholesky/triangular_solve.hpp"

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

std::vector<std::int32_t> expand_order(const std::vector<std::int32_t>& order, int width) {
  std::vector<std::int32_t> result;
  if (order.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max() / width))
    throw ResourceExhausted("symbolic analysis: the matrix is too large for its index type");
  result.reserve(order.size() * static_cast<std::size_t>(width));
  for (const std::int32_t row : order)
    for (int a = 0; a < width; ++a) result.push_back(row * width + a);
  return result;
}

}  // namespace

SymbolicCholesky::SymbolicCholesky(SymbolicAnalysis analysis)
    : pattern_(std::make_shared<const SupernodalPattern>(std::move(analysis.pattern))),
      entries_(std::make_shared<const FactorEntries>(std::move(analysis.entries))) {}

SymbolicCholesky::SymbolicCholesky(const SparseUpper& pattern, Ordering ordering, unsigned threads)
    : SymbolicCholesky(ordered_analysis(pattern, ordering, threads)) {}

SymbolicCholesky::SymbolicCholesky(const SparseUpper& blocks, const SymbolicCholesky& scalar, int width)
    : SymbolicCholesky(analyze(blocks, expand_order(scalar.pattern_->permutation, width))) {}

Offset SymbolicCholesky::nonzeros() const noexcept { return pattern_->numbers(); }
bool SymbolicCholesky::is_shared() const noexcept { return pattern_->groups != nullptr; }
double SymbolicCholesky::operations() const noexcept { return pattern_->operations; }

CholeskyFactor::CholeskyFactor(const SparseUpper& matrix, const SymbolicCholesky& symbolic, const char* name,
                               unsigned threads)
    : pattern_(symbolic.pattern_), is_complex_(matrix.is_complex) {
  const OneBlasThread one_thread;
  auto values = std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(nonzeros()) * (is_complex_ ? 2 : 1));
  const Offset good = factor_by_fronts(matrix, *pattern_, *symbolic.entries_, values.get(), threads);
  values_ = std::move(values);
  check_pivots(good, name);
}

/// @param good  number of columns eliminated before the first bad pivot
void CholeskyFactor::check_pivots(Offset good, const char* name) const {
  const auto rows = static_cast<Offset>(pattern_->permutation.size());
  if (good == rows) return;
  throw NotPositiveDefinite("not_positive_definite",
                            std::string("operator ") + name + " is not positive definite (column " +
                                std::to_string(good) + " of " + std::to_string(rows) + " in elimination order)",
                            "check the graph: negative weights and nearly coincident points can cause this");
}

void CholeskyFactor::check(const SparseUpper& matrix, const char* name, unsigned threads) const {
  std::vector<double> b(pattern_->permutation.size() * (is_complex_ ? 2 : 1));
  std::uint32_t state = 12345;
  for (double& value : b) value = ((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-23 - 1.0;
  checked_solve(matrix, std::move(b), name, threads);
}

std::vector<double> CholeskyFactor::checked_solve(const SparseUpper& matrix, std::vector<double> b, const char* name,
                                                  unsigned threads) const {
  std::vector<double> x = b;
  solve(x, 1, threads);
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

void CholeskyFactor::solve(std::span<double> X, Offset columns, unsigned threads) const {
  if (columns <= max_narrow_columns) return narrow_solve(factor(), X, columns, pattern_->groups.get(), threads);
  block_solve(factor(), X, columns);
}

LinearAlgebraInfo linear_algebra_info() {
  const std::string blas = blas_name();
  return {blas, blas_is_optimized(blas)};
}

SupernodalFactor CholeskyFactor::factor() const { return pattern_->factor(is_complex_, values_.get()); }

Offset CholeskyFactor::nonzeros() const noexcept { return pattern_->numbers(); }

std::size_t CholeskyFactor::bytes() const noexcept {
  const SupernodalPattern& p = *pattern_;
  return static_cast<std::size_t>(nonzeros()) * (is_complex_ ? 16 : 8) +
         (p.permutation.size() + p.indices.size()) * sizeof(std::int32_t) + 5 * p.super.size() * sizeof(Offset) +
         (p.groups ? p.groups->bytes() : 0);
}

}  // namespace ahm
