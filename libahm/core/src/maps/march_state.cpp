#include "maps/march_state.hpp"

#include <algorithm>
#include <span>

#include "ahm/error.hpp"
#include "maps/march.hpp"

namespace ahm {

MarchState March::state() const {
  MarchState state;
  state.statistics = statistics_;
  state.depth = depth_;
  state.accepted = accepted_count_;
  state.front = front_;
  numbers_.visit(
      [&](Index vertex, Index number) {
        if (!ways_[number]->accepted) return;
        const std::span known = known_.row(number), found(found_[number], d_ + 2);
        state.vertices.push_back(vertex);
        state.values.insert(state.values.end(), known.begin(), known.end());
        state.values.insert(state.values.end(), found.begin(), found.end());
        state.exponents.push_back(known_.exponents(number));
      },
      [&](Index begin, Index end) {
        if (!state.passed.empty() && state.passed.back() == begin)
          state.passed.back() = end;
        else
          state.passed.insert(state.passed.end(), {begin, end});
      });
  return state;
}

void March::restore(const MarchState& state) {
  const std::size_t known = known_.row_width(), width = known + d_ + 2;
  if (state.values.size() != state.vertices.size() * width || state.exponents.size() != state.vertices.size())
    throw InvalidArgument("the state of a march is that of another one");
  for (std::size_t run = 0; run + 1 < state.passed.size(); run += 2)
    for (Index vertex = state.passed[run]; vertex < state.passed[run + 1]; ++vertex) {
      way(vertex);
      forget(vertex);
    }
  for (std::size_t k = 0; k < state.vertices.size(); ++k) {
    way(state.vertices[k]).accepted = true;
    const Index number = numbers_.find(state.vertices[k]);
    const auto row = std::span(state.values).subspan(k * width, width);
    known_.put(number, row.first(known), state.exponents[k]);
    found_.grow_to(number + 1);
    std::copy_n(row.begin() + static_cast<std::ptrdiff_t>(known), d_ + 2, found_[number]);
  }
  front_ = state.front;
  statistics_ = state.statistics;
  depth_ = state.depth;
  accepted_count_ = state.accepted;
}

}  // namespace ahm
