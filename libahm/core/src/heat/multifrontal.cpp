#include "heat/multifrontal.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "ahm/util/parallel.hpp"
#include "heat/blas_control.hpp"
#include "heat/front_factor.hpp"

namespace ahm {

namespace {

/// Of real (W = 1) or complex (W = 2) numbers.
template <int W>
class Multifrontal {
 public:
  Multifrontal(const SparseUpper& matrix, const SupernodalPattern& pattern, double* values, unsigned threads)
      : matrix_(matrix),
        pattern_(pattern),
        L_(pattern.factor(W == 2, values)),
        values_(values),
        threads_(threads),
        updates_(pattern.super.size() - 1) {}

  Offset run() {
    if (!pattern_.groups) {
      Places places = no_places();
      return in_order(0, static_cast<Offset>(updates_.size()), places);
    }
    const SolveGroups& groups = *pattern_.groups;
    std::vector<Offset> failed(static_cast<std::size_t>(groups.count()), L_.size);
    detail::parallel_chunks(groups.count(), 1, threads_, [&](Offset group, Offset) {
      Places places = no_places();
      for (std::size_t k = groups.begin[group]; k < groups.begin[group + 1] && failed[group] == L_.size; ++k)
        failed[group] = in_order(groups.subtrees[k].first, groups.subtrees[k].last, places);
    });
    const Offset first = *std::min_element(failed.begin(), failed.end());
    if (first < L_.size) return first;
    Places places = no_places();
    for (const Offset s : groups.top)
      if (const Offset column = eliminate(s, places); column < L_.size) return column;
    return L_.size;
  }

 private:
  using Places = std::vector<std::int32_t>;  ///< of rows in the front at hand
  Places no_places() const { return Places(static_cast<std::size_t>(L_.size)); }

  /// @return as `factor_by_fronts`
  Offset in_order(Offset first, Offset last, Places& places) {
    for (Offset s = first; s < last; ++s)
      if (const Offset column = eliminate(s, places); column < L_.size) return column;
    return L_.size;
  }

  Offset eliminate(Offset number, Places& places) {
    const Supernode<W> s(L_, number);
    const Offset below = s.rows - s.columns;
    double* L = values_ + s.begin * W;
    for (Offset r = 0; r < s.rows; ++r) places[s.index[r]] = static_cast<std::int32_t>(r);
    std::fill_n(L, s.rows * s.columns * W, 0.0);
    add_entries(s, L, places);
    const std::span<const Offset> children = pattern_.tree.children_of(number);
    for (const Offset child : children) add_update<true>(child, s, L, places);
    std::unique_ptr<double[]>& update = updates_[number];
    if (below > 0) update = std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(below * below * W));
    if (const Offset good = factor(s, L, update.get()); good < s.columns) return s.first + good;
    for (const Offset child : children) {
      if (update) add_update<false>(child, s, update.get(), places);
      updates_[child].reset();
    }
    return L_.size;
  }

  static Offset factor(const Supernode<W>& s, double* L, double* update) {
    if (!is_large_front(s.rows, s.columns)) return factor_front<W>(L, s.rows, s.columns, update);
    const BlasBuffer buffer;
    return factor_front<W>(L, s.rows, s.columns, update);
  }

  void add_entries(const Supernode<W>& s, double* L, const Places& places) const {
    for (Offset j = 0; j < s.columns; ++j, L += s.rows * W)
      for (const auto& [row, source] : pattern_.entries.of_column(s.first + j)) {
        const double* value = matrix_.values.data() + (source < 0 ? ~source : source) * W;
        double* entry = L + places[row] * W;
        entry[0] += value[0];
        if constexpr (W == 2) entry[1] += source < 0 ? -value[1] : value[1];
      }
  }

  /// Adds what a child leaves to the columns of its parent's supernode (Own), or to the rest of its parent's front.
  template <bool Own>
  void add_update(Offset number, const Supernode<W>& parent, double* to, const Places& places) const {
    const Supernode<W> child(L_, number);
    const Offset size = child.rows - child.columns, rows = Own ? parent.rows : parent.rows - parent.columns,
                 skipped = Own ? 0 : parent.columns;
    const std::int32_t* index = child.index + child.columns;
    const Offset end = parent.first + parent.columns;
    const Offset split = std::lower_bound(index, index + size, end) - index;
    for (Offset j = Own ? 0 : split; j < (Own ? split : size); ++j) {
      const double* from = updates_[number].get() + j * size * W;
      double* column = to + (places[index[j]] - skipped) * rows * W;
      for (Offset i = j; i < size; ++i)
        for (int w = 0; w < W; ++w) column[(places[index[i]] - skipped) * W + w] += from[i * W + w];
    }
  }

  const SparseUpper& matrix_;
  const SupernodalPattern& pattern_;
  SupernodalFactor L_;
  double* values_;
  unsigned threads_;
  std::vector<std::unique_ptr<double[]>> updates_;  ///< that supernodes leave to their parents
};

}  // namespace

Offset factor_by_fronts(const SparseUpper& matrix, const SupernodalPattern& pattern, double* values, unsigned threads) {
  return matrix.is_complex ? Multifrontal<2>(matrix, pattern, values, threads).run()
                           : Multifrontal<1>(matrix, pattern, values, threads).run();
}

}  // namespace ahm
