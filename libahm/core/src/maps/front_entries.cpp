// What a front knows of each vertex.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/maps/unfolding_front.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

/// The two estimates of a direction lie on both sides of it, so that it is off by half their difference (docs/concepts/accuracy.md).
constexpr double share_of_difference = 0.5;

}  // namespace

double UnfoldingFront::distance(Vertex vertex) const {
  const Index first = first_[vertex.index];
  return first < 0 ? std::numeric_limits<double>::infinity() : entries_[first].distance * graph_.length_unit();
}

Vec2 UnfoldingFront::direction(Vertex vertex) const {
  const Index first = first_[vertex.index];
  return first < 0 || !directions_ ? Vec2{NAN, NAN} : ways_[first].direction;
}

double UnfoldingFront::direction_error(Vertex vertex) const {
  const Index first = first_[vertex.index];
  return first < 0 || !directions_ ? NAN : share_of_difference * std::sqrt(ways_[first].variance);
}

Vec2 UnfoldingFront::arrival(Vertex vertex) const {
  const Index first = first_[vertex.index];
  if (first < 0 || !directions_) return {NAN, NAN};
  const Way& way = ways_[first];
  if (way.arrival != Vec2{}) return way.arrival;  // also where it is NaN
  const Star star = graph_.star(vertex.index);
  std::array<Vec2, 2> ends{};
  for (std::size_t k = 0; k < 2; ++k)
    if (const auto end = std::ranges::find(star.neighbors, way.last[k]); end != star.neighbors.end()) {
      const std::span<const double> log = star.log(static_cast<std::size_t>(end - star.neighbors.begin()));
      ends[k] = {log[0], log[1]};
    }
  const Vec2 crossing = (1.0 - way.share) * ends[0] + static_cast<double>(way.share) * ends[1];
  const double away = length(crossing);
  return (-1 / away) * crossing;
}

bool UnfoldingFront::is_mirrored(Vertex vertex) const {
  const Index first = first_[vertex.index];
  return first >= 0 && directions_ && ways_[first].mirrored;
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
