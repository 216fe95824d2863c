/// \file
/// A Cholesky factor by supernodes: columns of the same rows, stored as dense blocks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

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

}  // namespace ahm
