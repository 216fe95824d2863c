#include "ahm/cholesky/cholesky.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "ahm/error.hpp"
#include "cholesky/multifrontal.hpp"
#include "cholesky/ordering.hpp"
#include "cholesky/registers.hpp"
#include "cholesky/supernodal_pattern.hpp"
#include "cholesky/triangular_solve.hpp"

namespace ahm {
namespace {

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
  auto values = std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(nonzeros()) * (is_complex_ ? 2 : 1));
  const Offset good = factor_by_fronts(matrix, *pattern_, *symbolic.entries_, values.get(), threads);
  values_ = std::move(values);
  check_pivots(good, name);
}

/// @param good  number of columns eliminated before the first bad pivot
void CholeskyFactor::check_pivots(Offset good, const char* name) const {
  const auto rows = static_cast<Offset>(pattern_->permutation.size());
  if (good != rows) throw not_positive_definite(name, good, rows);
}

void CholeskyFactor::solve(std::span<double> X, Offset columns, unsigned threads) const {
  if (columns <= max_narrow_columns) return narrow_solve(factor(), X, columns, pattern_->groups.get(), threads);
  block_solve(factor(), X, columns, pattern_->groups.get(), threads);
}

std::string register_set() {
  switch (widest_registers()) {
    case Registers::avx512:
      return "AVX-512";
    case Registers::avx2:
      return "AVX2";
    case Registers::plain:
      break;
  }
  return "plain";
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
