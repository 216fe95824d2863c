/// \file
/// Right-hand sides in the order of elimination.
#pragma once

#include <algorithm>
#include <memory>
#include <span>

#include "ahm/util/parallel.hpp"
#include "heat/supernodal_factor.hpp"

namespace ahm {

/// Columns of real (W = 1) or complex (W = 2) numbers, one after the other.
template <int W>
class PermutedColumns {
 public:
  PermutedColumns(const SupernodalFactor& L, Offset columns)
      : L_(L), x_(std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(L.size * columns * W))) {}

  double* at(Offset column, Offset row) const { return x_.get() + (column * L_.size + row) * W; }

  /// Copies columns from X, in the order of the matrix, or to it.
  template <bool In>
  void permute(std::span<double> X, Offset columns, unsigned threads = 1) {
    detail::parallel_chunks(L_.size, 1 << 15, threads, [&](Offset begin, Offset end) {
      for (Offset c = 0; c < columns; ++c)
        for (Offset k = begin; k < end; ++k)
          for (int w = 0; w < W; ++w) {
            double& outside = X[(c * L_.size + L_.permutation[k]) * W + w];
            double& inside = at(c, k)[w];
            In ? inside = outside : outside = inside;
          }
    });
  }

  /// Whether the own rows of a supernode are. A point source is zero almost everywhere, and stays so outside its path to the root
  /// of the elimination tree.
  bool is_zero(const Supernode<W>& s, Offset columns) const {
    for (Offset c = 0; c < columns; ++c)
      if (!std::all_of(at(c, s.first), at(c, s.first + s.columns), [](double value) { return value == 0; }))
        return false;
    return true;
  }

 private:
  const SupernodalFactor& L_;
  std::unique_ptr<double[]> x_;
};

}  // namespace ahm
