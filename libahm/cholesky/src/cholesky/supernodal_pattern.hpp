/// \file
/// Supernodal storage of a Cholesky factor. A supernode is a set of columns with the same rows, stored as a dense block.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ahm/cholesky/cholesky.hpp"
#include "ahm/types.hpp"
#include "cholesky/adjacency.hpp"

namespace ahm {

/// The factor of P K P^T = L L^H. Supernode s has the columns super[s] to super[s + 1] - 1, the rows indices[row_begin[s]...] (those
/// of its own columns first), and dense column-major values at value_begin[s].
struct SupernodalFactor {
  Offset size;
  bool is_complex;
  std::span<const std::int32_t> permutation;  ///< row k of the factor is row permutation[k] of the matrix
  std::span<const Offset> super, row_begin, value_begin;
  std::span<const std::int32_t> indices;
  const double* values;  ///< complex: interleaved pairs

  Offset supernodes() const { return static_cast<Offset>(super.size()) - 1; }
  /// Largest number of rows of a supernode.
  Offset max_rows() const {
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
  const std::int32_t* index;  ///< row numbers
  Offset begin;               ///< first entry of the supernode among the entries of the factor
  const double* values;
  const double* at(Offset row, Offset column) const { return values + (column * rows + row) * W; }
};

/// Subtrees of the elimination tree in groups of similar work, and the supernodes above all subtrees (the top). In the forward solve a
/// group writes its own rows and adds to rows of the top. In the backward solve it reads rows of the top. Groups, and so rounding
/// errors, do not depend on the number of threads.
struct SolveGroups {
  struct Subtree {
    Offset first, last;  ///< supernodes first to last - 1
    Offset end;          ///< rows from `end` on belong to ancestors
  };
  std::vector<Subtree> subtrees;    ///< subtrees sorted by group
  std::vector<std::size_t> begin;   ///< first subtree of each group, and the number of subtrees
  std::vector<Offset> top;          ///< supernodes of the top, ascending
  std::vector<std::int32_t> place;  ///< position of each row among the rows of the top; -1: in a subtree
  std::size_t top_rows = 0;

  Offset count() const { return static_cast<Offset>(begin.size()) - 1; }
  std::size_t bytes() const { return place.size() * sizeof(std::int32_t); }
};

/// Makes the groups; null for small factors, where they would not save time.
/// @param parent  parent of each supernode, in postorder; -1: root
std::unique_ptr<const SolveGroups> solve_groups(const SupernodalFactor& L, std::span<const Offset> parent);

/// The entries of a matrix, grouped by row or column in elimination order.
template <class Member>
struct EntriesBy {
  std::vector<Offset> begin;  ///< rows + 1 positions in `members`
  std::vector<Member> members;

  std::span<const Member> of(Offset place) const {
    return std::span(members).subspan(begin[place], begin[place + 1] - begin[place]);
  }
};

struct FactorEntry {
  std::int32_t row;     ///< row in elimination order
  std::int64_t source;  ///< entry number in the matrix; if negative, the conjugate of entry ~source
};
/// The entries of a matrix for each column of its factor.
using FactorEntries = EntriesBy<FactorEntry>;

struct SupernodalPattern {
  std::vector<std::int32_t> permutation, indices;     ///< as in `SupernodalFactor`
  std::vector<Offset> super, row_begin, value_begin;  ///< as in `SupernodalFactor`
  std::vector<Offset> parent;  ///< parent of each supernode: the supernode of its first row below; -1: root
  std::shared_ptr<const SolveGroups> groups;  ///< null: supernodes are processed one after another
  double operations = 0;  ///< floating-point operations for a real matrix, without those on explicit zeros

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
  FactorEntries entries;  ///< used by the numeric factorization
};

/// Symbolic analysis. Column counts use skeletons [GNP94]. Supernodes are columns with the same rows; small ones are merged at the
/// cost of some explicit zeros, as in CHOLMOD [CDHR08].
/// @param order  row numbers in elimination order. The pattern uses a postorder of its elimination tree, which has the same fill
/// @throws ResourceExhausted
SymbolicAnalysis analyze(const SparseUpper& matrix, const Numbers& order);

}  // namespace ahm
