// Fronts in other dimensions than 2.
#include <algorithm>

#include "ahm/maps/unfolding_front.hpp"
#include "ahm/util/scratch.hpp"
#include "ahm/util/small_math.hpp"
#include "maps/eikonal.hpp"

namespace ahm {

/// The displacement to the point, from vertex to vertex.
void UnfoldingFront::carry(Index from, Index point, double distance) {
  Scratch here(d_), left(d_), there(d_);
  std::ranges::copy(displacement(*find(from, point)), here.data());
  const std::size_t degree = graph_.star(from).degree();
  for (std::size_t e = 0; e < degree; ++e) {
    const Star star = graph_.star(from);  // again: that of the neighbour took its place
    const Index to = star.neighbors[e];
    for (std::size_t a = 0; a < d_; ++a) left.data()[a] = here.data()[a] - star.log(e)[a];
    star.transport(e).apply_inverse(left.data(), there.data());
    const double slack = 2 * length(star.log(e)), straight = length(there.span());
    if (const Entry* known = find(to, point); known && known->distance <= straight) continue;
    offer(to, point, straight * factor_at(to, point, there.span(), distance), slack, there.span(), {});
  }
}

/// By how much the way to a vertex is longer than the straight line: from its neighbours that are no farther than `distance`.
double UnfoldingFront::factor_at(Index vertex, Index point, std::span<const double> displacement, double distance) {
  const double straight = length(displacement);
  const Star star = graph_.star(vertex);
  if (!(straight > 0) || !find_axes(star, axis_)) return 1;
  nearest_.assign(star.degree(), nullptr);
  upwind_.clear();
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const Entry* const there = find(star.neighbors[e], point);
    if (there && there->distance <= distance && (!nearest_[axis_[e]] || there->distance < nearest_[axis_[e]]->distance))
      nearest_[axis_[e]] = there;
  }
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const Entry* const there = find(star.neighbors[e], point);
    if (!there || there != nearest_[axis_[e]]) continue;
    const double edge = length(star.log(e)), line = length(this->displacement(*there));
    double product = 0;
    for (std::size_t a = 0; a < d_; ++a) product += star.log(e)[a] * displacement[a];
    upwind_.push_back({edge, product / (edge * straight), line > 0 ? there->distance / line : 1});
  }
  return upwind_.empty() ? 1 : eikonal_factor(straight, std::span(upwind_));
}

}  // namespace ahm
