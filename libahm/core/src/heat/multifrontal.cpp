#include "heat/multifrontal.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ahm/util/parallel.hpp"
#include "heat/front_factor.hpp"

namespace ahm {
namespace {

/// What supernodes leave to one above them: rows of its front, and the lower triangle of a square of numbers.
struct Update {
  std::span<const std::int32_t> index;
  std::unique_ptr<double[]> numbers;

  Offset size() const { return static_cast<Offset>(index.size()); }
};

/// Updates that wait for a supernode.
struct Waiting {
  std::vector<Update> updates;
  Offset numbers = 0;
};

/// Of real (W = 1) or complex (W = 2) numbers.
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
        waiting_(pattern.super.size() - 1) {}

  Offset run() {
    if (!pattern_.groups) return Branch(*this).in_order(0, static_cast<Offset>(waiting_.size()));
    const SolveGroups& groups = *pattern_.groups;
    std::vector<Offset> failed(static_cast<std::size_t>(groups.count()), L_.size);
    std::vector<std::vector<Waiting>> for_top(failed.size());
    detail::parallel_chunks(groups.count(), 1, threads_, [&](Offset group, Offset) {
      for_top[group].resize(groups.top.size());
      Branch branch(*this, &for_top[group]);
      for (std::size_t k = groups.begin[group]; k < groups.begin[group + 1] && failed[group] == L_.size; ++k)
        failed[group] = branch.in_order(groups.subtrees[k].first, groups.subtrees[k].last);
    });
    if (const Offset first = *std::min_element(failed.begin(), failed.end()); first < L_.size) return first;
    Branch top(*this, nullptr, threads_);
    for (std::size_t k = 0; k < groups.top.size(); ++k) {
      Waiting& all = waiting_[groups.top[k]];
      for (auto& of_group : for_top)
        std::move(of_group[k].updates.begin(), of_group[k].updates.end(), std::back_inserter(all.updates));
      if (const Offset column = top.eliminate(groups.top[k]); column < L_.size) return column;
    }
    return L_.size;
  }

 private:
  /// Supernodes that are eliminated one after the other.
  class Branch {
   public:
    /// @param for_top  takes what leaves a group, for each supernode of the top
    /// @param threads  that share what is large
    explicit Branch(Multifrontal& all, std::vector<Waiting>* for_top = nullptr, unsigned threads = 1)
        : all_(all), for_top_(for_top), threads_(threads), places_(static_cast<std::size_t>(all.L_.size)) {}

    /// @return as `factor_by_fronts`
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
      place(s);
      std::fill_n(L, s.rows * s.columns * W, 0.0);
      add_entries(s, L);
      const Waiting waiting = std::move(all_.waiting_[number]);
      for (const Update& update : waiting.updates) add<true>(update, s, s.rows, L);
      Update left{{s.index + s.columns, s.index + s.rows}, nullptr};
      if (below > 0)
        left.numbers = std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(below * below * W));
      if (const Offset good = factor_front<W>(L, s.rows, s.columns, left.numbers.get(), threads_); good < s.columns)
        return s.first + good;
      if (below == 0) return all_.L_.size;
      for (const Update& update : waiting.updates) add<false>(update, s, below, left.numbers.get());
      leave(all_.pattern_.parent[number], std::move(left));
      return all_.L_.size;
    }

   private:
    void place(const Supernode<W>& s) {
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

    /// Adds an update to the columns of the supernode (Own), or to the square of the rows below it.
    /// @param rows  of a column of `to`
    template <bool Own>
    void add(const Update& update, const Supernode<W>& s, Offset rows, double* to) const {
      const std::span<const std::int32_t> index = update.index;
      const auto own = std::lower_bound(index.begin(), index.end(), s.first + s.columns) - index.begin();
      add_columns(update, Own ? 0 : own, Own ? own : update.size(), Own ? 0 : s.columns, rows, to);
    }

    /// @param skipped  rows of the front before those of `to`
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
      if (threads_ != 1 && update.size() * update.size() > least_shared)
        detail::parallel_chunks(end - begin, columns_at_once, threads_, add);
      else
        add(0, end - begin);
    }

    Waiting& waiting_for(Offset number) {
      if (!for_top_ || number < last_) return all_.waiting_[number];
      const std::vector<Offset>& top = all_.pattern_.groups->top;
      return (*for_top_)[std::lower_bound(top.begin(), top.end(), number) - top.begin()];
    }

    /// Hands an update over. Many that wait for the same supernode are added up, or they would take any number of times the memory
    /// of its front.
    void leave(Offset parent, Update update) {
      Waiting& waiting = waiting_for(parent);
      waiting.numbers += update.size() * update.size();
      waiting.updates.push_back(std::move(update));
      const Supernode<W> s(all_.L_, parent);
      if (waiting.numbers <= most_waiting * s.rows * s.rows) return;
      Update sum{{s.index, s.index + s.rows},
                 std::make_unique<double[]>(static_cast<std::size_t>(s.rows * s.rows * W))};
      place(s);
      for (const Update& one : waiting.updates) add_columns(one, 0, one.size(), 0, s.rows, sum.numbers.get());
      waiting.updates.clear();
      waiting.updates.push_back(std::move(sum));
      waiting.numbers = s.rows * s.rows;
    }

    Multifrontal& all_;
    std::vector<Waiting>* for_top_;
    unsigned threads_;
    std::vector<std::int32_t> places_;  ///< of rows in the front at hand
    Offset last_ = 0;                   ///< of the subtree at hand
  };

  static constexpr Offset most_waiting = 4;        ///< fronts
  static constexpr Offset least_shared = 1 << 16;  ///< numbers of an update that threads share
  static constexpr Offset columns_at_once = 64;    ///< of such an update

  const SparseUpper& matrix_;
  const SupernodalPattern& pattern_;
  const FactorEntries& entries_;
  SupernodalFactor L_;
  double* values_;
  unsigned threads_;
  std::vector<Waiting> waiting_;  ///< for each supernode, but for what groups leave to the top
};

}  // namespace

Offset factor_by_fronts(const SparseUpper& matrix, const SupernodalPattern& pattern, const FactorEntries& entries,
                        double* values, unsigned threads) {
  return matrix.is_complex ? Multifrontal<2>(matrix, pattern, entries, values, threads).run()
                           : Multifrontal<1>(matrix, pattern, entries, values, threads).run();
}

}  // namespace ahm
