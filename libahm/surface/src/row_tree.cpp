#include "row_tree.hpp"

#include <algorithm>
#include <limits>

#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

constexpr std::size_t leaf = 8;  ///< maximum number of rows in a leaf

}  // namespace

RowTree::RowTree(const RowMap& rows, std::span<const Vec3> positions, Index vertices) {
  for (Index v = 0; v < vertices; ++v)
    if (const auto row = rows.row(Vertex(v)); row && is_finite(positions[row->index]))
      entries_.push_back({positions[row->index], v, *row});
  axis_.resize(entries_.size());
  build(0, entries_.size());
}

void RowTree::build(std::size_t begin, std::size_t end) {
  if (end - begin <= leaf) return;
  Vec3 low = entries_[begin].position, high = low;
  for (std::size_t k = begin; k < end; ++k)
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], entries_[k].position[a]);
      high[a] = std::max(high[a], entries_[k].position[a]);
    }
  const Vec3 sides = high - low;
  const auto axis = static_cast<std::size_t>(std::max_element(sides.begin(), sides.end()) - sides.begin());
  const std::size_t half = begin + (end - begin) / 2;
  const auto at = [&](std::size_t k) { return entries_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(begin), at(half), at(end),
                   [&](const Entry& a, const Entry& b) { return a.position[axis] < b.position[axis]; });
  axis_[half] = static_cast<std::uint8_t>(axis);
  build(begin, half);
  build(half + 1, end);
}

Row RowTree::nearest(const Vec3& position) const {
  Best best{std::numeric_limits<double>::infinity(), nullptr};
  search(0, entries_.size(), position, best);
  return best.entry != nullptr ? best.entry->row : Row{};
}

void RowTree::consider(const Entry& entry, const Vec3& position, Best& best) {
  const double away = distance(entry.position, position);
  const bool first = away == best.distance && best.entry != nullptr && entry.vertex < best.entry->vertex;
  if (away < best.distance || first) best = {away, &entry};
}

void RowTree::search(std::size_t begin, std::size_t end, const Vec3& position, Best& best) const {
  if (end - begin <= leaf) {
    for (std::size_t k = begin; k < end; ++k) consider(entries_[k], position, best);
    return;
  }
  const std::size_t half = begin + (end - begin) / 2, axis = axis_[half];
  const double beyond = position[axis] - entries_[half].position[axis];
  consider(entries_[half], position, best);
  beyond < 0 ? search(begin, half, position, best) : search(half + 1, end, position, best);
  if (std::abs(beyond) > best.distance) return;
  beyond < 0 ? search(half + 1, end, position, best) : search(begin, half, position, best);
}

}  // namespace ahm
