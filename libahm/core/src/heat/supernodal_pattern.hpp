/// \file
/// The symbolic analysis of a sparse Cholesky factorization: what is the same of all matrices of a pattern.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "heat/solve_groups.hpp"
#include "heat/sparse_upper.hpp"
#include "heat/supernodal_factor.hpp"

namespace ahm {

/// The entries of a matrix by places in the order of elimination.
template <class Member>
struct EntriesBy {
  std::vector<Offset> begin;  ///< places + 1
  std::vector<Member> members;

  std::span<const Member> of(Offset place) const {
    return std::span(members).subspan(begin[place], begin[place + 1] - begin[place]);
  }
};

struct FactorEntry {
  std::int32_t row;     ///< in the order of elimination
  std::int64_t source;  ///< among the values of the matrix; ~source: its conjugate
};
/// Where the entries of a matrix lie in its factor, by its columns.
using FactorEntries = EntriesBy<FactorEntry>;

struct SupernodalPattern {
  std::vector<std::int32_t> permutation, indices;  ///< as in `SupernodalFactor`, and so are the next three
  std::vector<Offset> super, row_begin, value_begin;
  std::vector<Offset> parent;  ///< in the elimination tree of supernodes: that of the first row below; -1: of a root
  std::shared_ptr<const SolveGroups> groups;  ///< null: supernodes go one after the other
  double operations = 0;  ///< of real numbers, that a factorization without the zeros in supernodes takes

  SupernodalFactor factor(bool is_complex, const double* values) const {
    return {static_cast<Offset>(permutation.size()),
            is_complex,
            permutation,
            super,
            row_begin,
            value_begin,
            indices,
            values};
  }
  Offset numbers() const { return value_begin.back(); }
};

struct SymbolicAnalysis {
  SupernodalPattern pattern;
  FactorEntries entries;  ///< asked for while a matrix is factored
};

/// Column counts by skeletons [GNP94], supernodes as in CHOLMOD [CDHR08]: columns of the same rows, and small ones joined at the
/// price of some zeros.
/// @param order  of elimination, a row each; that of the pattern goes along its elimination tree in postorder, and leaves the same fill
/// @throws ResourceExhausted
SymbolicAnalysis analyze(const SparseUpper& matrix, const std::vector<std::int32_t>& order);

}  // namespace ahm
