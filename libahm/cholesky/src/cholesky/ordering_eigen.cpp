// Orderings without SuiteSparse: Eigen's approximate minimum degree for both kinds.
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <limits>

#include "ahm/error.hpp"
#include "cholesky/ordering.hpp"

namespace ahm {

std::vector<std::int32_t> elimination_order(const SparseUpper& pattern, Ordering) {
  if (pattern.rows.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw ResourceExhausted("symbolic analysis: the matrix is too large for the 32-bit ordering");
  const std::vector<std::int32_t> begin(pattern.column_begin.begin(), pattern.column_begin.end()),
      rows(pattern.rows.begin(), pattern.rows.end());
  const std::vector<signed char> ones(rows.size(), 1);  // Eigen's patterns have values
  using Pattern = Eigen::SparseMatrix<signed char, Eigen::ColMajor, std::int32_t>;
  const Eigen::Map<const Pattern> upper(pattern.size(), pattern.size(), static_cast<Eigen::Index>(rows.size()),
                                        begin.data(), rows.data(), ones.data());
  Eigen::AMDOrdering<std::int32_t>::PermutationType order;
  Eigen::AMDOrdering<std::int32_t>()(Pattern(upper).selfadjointView<Eigen::Upper>(), order);
  return {order.indices().begin(), order.indices().end()};
}

std::string cholmod_version() { return "none (AMD of Eigen)"; }

}  // namespace ahm
