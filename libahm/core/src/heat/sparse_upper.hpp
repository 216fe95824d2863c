/// \file
/// A sparse symmetric matrix.
#pragma once

#include <vector>

#include "ahm/types.hpp"

namespace ahm {

/// The upper triangle of a symmetric (real) or Hermitian (complex) matrix in compressed columns, rows ascending,
/// without duplicates, each diagonal entry among them. Complex entries are interleaved pairs.
struct SparseUpper {
  bool is_complex = false;
  std::vector<Offset> column_begin;  ///< columns + 1
  std::vector<Offset> rows;
  std::vector<double> values;  ///< 1 or 2 per entry

  Offset size() const { return static_cast<Offset>(column_begin.size()) - 1; }
};

}  // namespace ahm
