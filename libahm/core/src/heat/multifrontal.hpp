/// \file
/// The numbers of a Cholesky factor whose supernodes are known, by the multifrontal method [DR83]: each supernode is eliminated from
/// a dense front, which is what the matrix has there and what its children in the elimination tree leave.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "heat/cholesky.hpp"
#include "heat/solve_groups.hpp"
#include "heat/supernodal_factor.hpp"
#include "heat/supernode_tree.hpp"

namespace ahm {

/// Where the entries of a matrix lie in its factor. The same of all matrices of a pattern.
class FactorEntries {
 public:
  /// @param L  a factor of the pattern; its values are not asked for
  FactorEntries(const SparseUpper& pattern, const SupernodalFactor& L);

  struct Entry {
    std::int64_t row;     ///< in the order of elimination
    std::int64_t source;  ///< among the values of the matrix; ~source: its conjugate
  };
  std::span<const Entry> of_column(Offset column) const {
    return std::span(entries_).subspan(begin_[column], begin_[column + 1] - begin_[column]);
  }

 private:
  std::vector<std::size_t> begin_;
  std::vector<Entry> entries_;
};

/// What all factors of a pattern have in common.
struct FactorPattern {
  FactorEntries entries;
  SupernodeTree tree;
  std::shared_ptr<const SolveGroups> groups;  ///< null: all supernodes one after the other
};

/// Fills in the values of L.
/// @param values   of L, which need not be initialized
/// @param threads  among which groups are shared; the same bits on any number
/// @return the first column, in the order of elimination, whose pivot is not positive and finite; L.size if all are
Offset factor_by_fronts(const SparseUpper& matrix, const FactorPattern& pattern, const SupernodalFactor& L,
                        double* values, unsigned threads);

}  // namespace ahm
