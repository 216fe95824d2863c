#include "cholesky/multifrontal.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ahm/util/parallel.hpp"
#include "cholesky/flush_subnormals.hpp"
#include "cholesky/front_kernels.hpp"
#include "cholesky/large_fronts.hpp"

namespace ahm {
namespace {

template <int W, int J>
[[gnu::always_inline]] inline void columns_below(const double* L, Offset rows, Offset columns, Offset c,
                                                 double* update) {
  const Offset below = rows - columns * W;
  ColumnBlock<W, J, false> block{L, rows, columns, {}};
  for (int a = 0; a < J; ++a) block.target[a] = update + (c + a) * below - columns * W;
  block.rows((columns + c) * W, (columns + c) * W, rows, 0);
}

/// @param rows  doubles per column
template <int W>
[[gnu::always_inline]] inline Offset factor_small(double* L, Offset rows, Offset columns, double* update) {
  if (const Offset good = eliminate<W, true>(L, rows, columns, 0, rows); good < columns) return good;
  constexpr int J = columns_per_tile<W>;
  const Offset below = rows / W - columns;
  Offset c = 0;
  for (; c + J <= below; c += J) columns_below<W, J>(L, rows, columns, c, update);
  for (; c < below; ++c) columns_below<W, 1>(L, rows, columns, c, update);
  return columns;
}

}  // namespace

template <int W>
Offset factor_front(double* L, Offset rows, Offset columns, double* update, unsigned threads) {
  const FlushSubnormals flush;
  if (is_large_front(rows, columns)) return factor_large_front<W>(L, rows, columns, update, threads);
  return in_widest_registers([&](auto) { return factor_small<W>(L, rows * W, columns, update); });
}

template Offset factor_front<1>(double*, Offset, Offset, double*, unsigned);
template Offset factor_front<2>(double*, Offset, Offset, double*, unsigned);

namespace {

/// An update matrix: the Schur complement that eliminated supernodes pass to an ancestor.
struct Update {
  std::span<const std::int32_t> index;  ///< rows, in elimination order
  std::unique_ptr<double[]> numbers;    ///< size() x size(), column major; only the lower triangle is set

  Offset size() const { return static_cast<Offset>(index.size()); }
};

/// Update matrices that have not yet been added to the front of a supernode.
struct PendingUpdates {
  std::vector<Update> updates;
  Offset numbers = 0;  ///< entries of all updates
};

/// The multifrontal factorization of a real (W = 1) or complex (W = 2) matrix.
template <int W>
class Multifrontal {
 public:
  Multifrontal(const SparseUpper& matrix, const SupernodalPattern& pattern, const FactorEntries& entries,
               double* values, unsigned threads)
      : matrix_(matrix),
        pattern_(pattern),
        entries_(entries),
        L_(pattern.factor(W == 2, values)),
        values_(values),
        threads_(threads),
        pending_(pattern.super.size() - 1) {}

  Offset run() {
    if (!pattern_.groups) return Branch(*this).in_order(0, static_cast<Offset>(pending_.size()));
    const SolveGroups& groups = *pattern_.groups;
    std::vector<Offset> failed(static_cast<std::size_t>(groups.count()), L_.size);
    std::vector<std::vector<PendingUpdates>> for_top(failed.size());
    detail::parallel_chunks(groups.count(), 1, threads_, [&](Offset group, Offset) {
      for_top[group].resize(groups.top.size());
      Branch branch(*this, &for_top[group]);
      for (std::size_t k = groups.begin[group]; k < groups.begin[group + 1] && failed[group] == L_.size; ++k)
        failed[group] = branch.in_order(groups.subtrees[k].first, groups.subtrees[k].last);
    });
    if (const Offset first = *std::min_element(failed.begin(), failed.end()); first < L_.size) return first;
    Branch top(*this, nullptr, threads_);
    for (std::size_t k = 0; k < groups.top.size(); ++k) {
      PendingUpdates& all = pending_[groups.top[k]];
      for (auto& of_group : for_top)
        std::move(of_group[k].updates.begin(), of_group[k].updates.end(), std::back_inserter(all.updates));
      if (const Offset column = top.eliminate(groups.top[k]); column < L_.size) return column;
    }
    return L_.size;
  }

 private:
  /// Eliminates supernodes one after another.
  class Branch {
   public:
    /// @param for_top  receives the updates from this group to the top, one entry per supernode of the top
    /// @param threads  threads that share large fronts and updates
    explicit Branch(Multifrontal& all, std::vector<PendingUpdates>* for_top = nullptr, unsigned threads = 1)
        : all_(all), for_top_(for_top), threads_(threads), places_(static_cast<std::size_t>(all.L_.size)) {}

    /// Eliminates the supernodes first to last - 1. @return as `factor_by_fronts`
    Offset in_order(Offset first, Offset last) {
      last_ = last;
      for (Offset s = first; s < last; ++s)
        if (const Offset column = eliminate(s); column < all_.L_.size) return column;
      return all_.L_.size;
    }

    Offset eliminate(Offset number) {
      const Supernode<W> s(all_.L_, number);
      const Offset below = s.rows - s.columns;
      double* L = all_.values_ + s.begin * W;
      set_places(s);
      std::fill_n(L, s.rows * s.columns * W, 0.0);
      add_entries(s, L);
      const PendingUpdates queue = std::move(all_.pending_[number]);
      for (const Update& update : queue.updates) add<true>(update, s, s.rows, L);
      Update left{{s.index + s.columns, s.index + s.rows}, nullptr};
      if (below > 0)
        left.numbers = std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(below * below * W));
      if (const Offset good = factor_front<W>(L, s.rows, s.columns, left.numbers.get(), threads_); good < s.columns)
        return s.first + good;
      if (below == 0) return all_.L_.size;
      for (const Update& update : queue.updates) add<false>(update, s, below, left.numbers.get());
      pass_to(all_.pattern_.parent[number], std::move(left));
      return all_.L_.size;
    }

   private:
    void set_places(const Supernode<W>& s) {
      for (Offset r = 0; r < s.rows; ++r) places_[s.index[r]] = static_cast<std::int32_t>(r);
    }

    void add_entries(const Supernode<W>& s, double* L) const {
      for (Offset j = 0; j < s.columns; ++j, L += s.rows * W)
        for (const auto& [row, source] : all_.entries_.of(s.first + j)) {
          const double* value = all_.matrix_.values.data() + (source < 0 ? ~source : source) * W;
          double* entry = L + places_[row] * W;
          entry[0] += value[0];
          if constexpr (W == 2) entry[1] += source < 0 ? -value[1] : value[1];
        }
    }

    /// Adds an update to the supernode's own columns (Own), or to the update matrix of the rows below it.
    /// @param rows  number of rows of `to`
    template <bool Own>
    void add(const Update& update, const Supernode<W>& s, Offset rows, double* to) const {
      const std::span<const std::int32_t> index = update.index;
      const auto own = std::lower_bound(index.begin(), index.end(), s.first + s.columns) - index.begin();
      add_columns(update, Own ? 0 : own, Own ? own : update.size(), Own ? 0 : s.columns, rows, to);
    }

    /// Adds the columns begin to end - 1 of an update.
    /// @param skipped  rows of the front above the first row of `to`
    void add_columns(const Update& update, Offset begin, Offset end, Offset skipped, Offset rows, double* to) const {
      const std::span<const std::int32_t> index = update.index;
      const auto add = [&](Offset first, Offset last) {
        for (Offset j = begin + first; j < begin + last; ++j) {
          const double* from = update.numbers.get() + j * update.size() * W;
          double* column = to + (places_[index[j]] - skipped) * rows * W;
          for (Offset i = j; i < update.size(); ++i)
            for (int w = 0; w < W; ++w) column[(places_[index[i]] - skipped) * W + w] += from[i * W + w];
        }
      };
      if (threads_ != 1 && update.size() * update.size() > min_shared)
        detail::parallel_chunks(end - begin, columns_at_once, threads_, add);
      else
        add(0, end - begin);
    }

    PendingUpdates& pending_updates_of(Offset number) {
      if (!for_top_ || number < last_) return all_.pending_[number];
      const std::vector<Offset>& top = all_.pattern_.groups->top;
      return (*for_top_)[std::lower_bound(top.begin(), top.end(), number) - top.begin()];
    }

    /// Passes an update to the supernode `parent`. Pending updates are added up when they become much larger than its front, to bound
    /// their memory.
    void pass_to(Offset parent, Update update) {
      PendingUpdates& queue = pending_updates_of(parent);
      queue.numbers += update.size() * update.size();
      queue.updates.push_back(std::move(update));
      const Supernode<W> s(all_.L_, parent);
      if (queue.numbers <= max_pending * s.rows * s.rows) return;
      Update sum{{s.index, s.index + s.rows},
                 std::make_unique<double[]>(static_cast<std::size_t>(s.rows * s.rows * W))};
      set_places(s);
      for (const Update& one : queue.updates) add_columns(one, 0, one.size(), 0, s.rows, sum.numbers.get());
      queue.updates.clear();
      queue.updates.push_back(std::move(sum));
      queue.numbers = s.rows * s.rows;
    }

    Multifrontal& all_;
    std::vector<PendingUpdates>* for_top_;
    unsigned threads_;
    std::vector<std::int32_t> places_;  ///< position of each row in the current front
    Offset last_ = 0;                   ///< end of the current subtree's supernodes
  };

  static constexpr Offset max_pending = 4;       ///< most entries of pending updates, in multiples of the front
  static constexpr Offset min_shared = 1 << 16;  ///< updates with more entries are added on several threads
  static constexpr Offset columns_at_once = 64;  ///< columns of such an update per task

  const SparseUpper& matrix_;
  const SupernodalPattern& pattern_;
  const FactorEntries& entries_;
  SupernodalFactor L_;
  double* values_;
  unsigned threads_;
  std::vector<PendingUpdates> pending_;  ///< pending updates of each supernode, without those from groups to the top
};

}  // namespace

Offset factor_by_fronts(const SparseUpper& matrix, const SupernodalPattern& pattern, const FactorEntries& entries,
                        double* values, unsigned threads) {
  return matrix.is_complex ? Multifrontal<2>(matrix, pattern, entries, values, threads).run()
                           : Multifrontal<1>(matrix, pattern, entries, values, threads).run();
}

}  // namespace ahm
