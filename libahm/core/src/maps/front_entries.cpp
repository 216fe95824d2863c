// What a front knows of each vertex.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/maps/unfolding_front.hpp"

namespace ahm {
namespace {

/// A way that bends at the boundary by no more than this angle, all in all, goes straight on: boundaries of surfaces are not
/// straight to the last bit.
constexpr float straight_on = 0.5F;

}  // namespace

double UnfoldingFront::distance(Vertex vertex) const {
  const Index first = first_[vertex.index];
  return first < 0 ? std::numeric_limits<double>::infinity() : entries_[first].distance * graph_.length_unit();
}

Vec2 UnfoldingFront::direction(Vertex vertex) const {
  const Index first = first_[vertex.index];
  return first < 0 || !directions_ ? Vec2{NAN, NAN} : ways_[first].direction;
}

double UnfoldingFront::doubt(Vertex vertex) const {
  const Index first = first_[vertex.index];
  return first < 0 || !directions_ ? NAN : std::sqrt(ways_[first].doubt);
}

bool UnfoldingFront::is_bent(Vertex vertex) const {
  const Index first = first_[vertex.index];
  return first >= 0 && directions_ && ways_[first].turned > straight_on;
}

Index UnfoldingFront::nearest(Vertex vertex) const {
  const Index first = first_[vertex.index];
  return first < 0 ? -1 : entries_[first].point;
}

/// A place for one more entry of a vertex, the last one. Its others may move.
Index UnfoldingFront::append(Index vertex) {
  Index& first = first_[vertex];
  const std::size_t count = entries_of(vertex).size();
  if (count == 0) {
    first = new_row(1);
  } else if (std::has_single_bit(count)) {
    const Index row = new_row(2 * count);
    free_[std::bit_width(count) - 1].push_back(first);
    for (std::size_t k = 0; k < count; ++k) swap_entries(first + static_cast<Index>(k), row + static_cast<Index>(k));
    first = row;
  }
  entries_[first].count = static_cast<std::uint8_t>(count + 1);
  return first + static_cast<Index>(count);
}

/// @return its first entry
Index UnfoldingFront::new_row(std::size_t size) {
  const std::size_t kind = std::bit_width(size) - 1;
  if (kind < free_.size() && !free_[kind].empty()) {
    const Index row = free_[kind].back();
    free_[kind].pop_back();
    return row;
  }
  const std::size_t row = entries_.size();
  if (row + size > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw ResourceExhausted("front: distances from several points at too many vertices for its numbers");
  entries_.resize(row + size);
  if (d_ != 2) displacements_.resize(entries_.size() * d_);
  if (directions_) ways_.resize(entries_.size());
  return static_cast<Index>(row);
}

/// All of them but the number of entries, which is the row's.
void UnfoldingFront::swap_entries(Index a, Index b) {
  std::swap(entries_[a], entries_[b]);
  std::swap(entries_[a].count, entries_[b].count);
  if (directions_) std::swap(ways_[a], ways_[b]);
  if (d_ == 2) return;
  const auto of = [&](Index entry) { return displacements_.begin() + static_cast<std::ptrdiff_t>(entry * d_); };
  std::swap_ranges(of(a), of(a) + static_cast<std::ptrdiff_t>(d_), of(b));
}

}  // namespace ahm
