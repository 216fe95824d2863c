/// \file
/// A Cholesky factor by supernodes: columns of the same rows, stored as dense blocks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ahm/cholesky/cholesky.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// P K P^T = L L^H by supernodes: supernode s has the columns [super[s], super[s + 1]), the rows
/// indices[row_begin[s]...], its own columns first, and the dense column-major values at value_begin[s].
struct SupernodalFactor {
  Offset size;
  bool is_complex;
  std::span<const std::int32_t> permutation;  ///< row k of the factor is row permutation[k] of the matrix
  std::span<const Offset> super, row_begin, value_begin;
  std::span<const std::int32_t> indices;
  const double* values;  ///< complex: interleaved pairs

  Offset supernodes() const { return static_cast<Offset>(super.size()) - 1; }
  /// Rows of the largest supernode.
  Offset most_rows() const {
    Offset most = 0;
    for (Offset s = 0; s < supernodes(); ++s) most = std::max(most, row_begin[s + 1] - row_begin[s]);
    return most;
  }
};

/// One supernode of a factor of real (W = 1) or complex (W = 2) numbers.
template <int W>
struct Supernode {
  Supernode(const SupernodalFactor& L, Offset s)
      : first(L.super[s]),
        columns(L.super[s + 1] - first),
        rows(L.row_begin[s + 1] - L.row_begin[s]),
        index(L.indices.data() + L.row_begin[s]),
        begin(L.value_begin[s]),
        values(L.values + begin * W) {}
  Offset first, columns, rows;
  const std::int32_t* index;  ///< of its rows
  Offset begin;               ///< of its numbers among those of the factor
  const double* values;
  const double* at(Offset row, Offset column) const { return values + (column * rows + row) * W; }
};

/// Subtrees of the elimination tree, in groups of about the same work, and the supernodes above them all. On the way down
/// groups touch rows of their own, and add to those of the top; on the way up they read the top. The groups are the same on any
/// number of threads, and so are the sums.
struct SolveGroups {
  struct Subtree {
    Offset first, last;  ///< its supernodes
    Offset end;          ///< rows before this one are its own
  };
  std::vector<Subtree> subtrees;    ///< group after group
  std::vector<std::size_t> begin;   ///< of each group among them, and their end
  std::vector<Offset> top;          ///< supernodes above, in their order
  std::vector<std::int32_t> place;  ///< of every row among those of the top; -1: in a subtree
  std::size_t top_rows = 0;

  Offset count() const { return static_cast<Offset>(begin.size()) - 1; }
  std::size_t bytes() const { return place.size() * sizeof(std::int32_t); }
};

/// Null where they would not pay, for small factors.
/// @param parent  of each supernode, which are in postorder; -1: of a root
std::unique_ptr<const SolveGroups> solve_groups(const SupernodalFactor& L, std::span<const Offset> parent);

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
