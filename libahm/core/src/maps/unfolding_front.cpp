#include "ahm/maps/unfolding_front.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "ahm/util/scratch.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "maps/front_stars.hpp"
#include "maps/right_hand_side.hpp"

namespace ahm {
namespace {

constexpr Index none = -1;
/// Less than this is rounding.
constexpr double least_gain = 1e-12;
/// An entry is bettered no more often: where triangles contradict each other they could go on for ever.
constexpr Index most_gains = 40;
/// Points whose distances a vertex knows: the samples of a curve are many, and all but equally near.
constexpr Index most_points = 8;
/// Sides that are shorter than this share of the other two, or of a distance, no longer tell where its point lies.
constexpr double shortest_side = 1e-6, shortest_side_far_away = 1e-13;

/// The square of the distance of c from a point at distances `from_a` and `from_b`, beyond the side ab of a triangle with
/// a at 0, b at (ab, 0) and c at (cx, cy) above, the point below; `limit` where it is no less, or where the straight line
/// to the point does not cross that side.
double squared_across(double from_a, double from_b, double ab, double cx, double cy, double limit) {
  if (!(ab > shortest_side * std::max(std::abs(cx), cy)) || !(ab > shortest_side_far_away * from_a)) return limit;
  const double x = 0.5 * (ab + (from_a - from_b) * (from_a + from_b) / ab);
  const double squared_y = (from_a - x) * (from_a + x), along = (cx - x) * (cx - x) + cy * cy + squared_y;
  if (!(squared_y >= -1e-14 * from_a * from_a) || !(along < limit)) return limit;
  const double depth = std::sqrt(std::max(0.0, squared_y)), height = cy + depth;
  const double at_side = x * cy + cx * depth;  // where the line crosses, times height
  if (!(at_side >= -1e-9 * ab * height) || !(at_side <= (1 + 1e-9) * ab * height)) return limit;
  return std::min(limit, (cx - x) * (cx - x) + height * height);
}

}  // namespace

UnfoldingFront::UnfoldingFront(const TangentGraph& graph, std::shared_ptr<const Stars> stars)
    : graph_(graph),
      d_(static_cast<std::size_t>(graph.dimension())),
      stars_(stars || !graph.is_delaunay() ? std::move(stars)
                                           : std::make_shared<const Stars>(graph, halved_vertices(graph), false)) {
  head_.assign(static_cast<std::size_t>(stars_ ? stars_->size() : graph.size()), none);
  entries_.reserve(head_.size());
}

Index UnfoldingFront::add(const Source& source) {
  check_source(source, graph_);
  const double unit = graph_.length_unit();
  const Index first = points_;
  std::vector<Waiting> given;
  const auto give = [&](Index vertex, Index point, double distance, std::span<const double> displacement) {
    offer(vertex, point, distance, 0, displacement);
    if (stars_) given.push_back({distance, vertex, point});
  };
  Scratch back(d_);
  for (std::size_t k = 0; k < source.vertices().size(); ++k) {
    if (!(source.weights()[k] > 0)) continue;
    const auto [point, away] = source.place(k);
    points_ = std::max(points_, first + point + 1);
    for (std::size_t c = 0; c < d_; ++c) {
      back.data()[c] = 0;
      for (std::size_t a = 0; a < d_ && !source.offsets().empty(); ++a)
        back.data()[c] -= source.axes()[(k * d_ + c) * d_ + a] * source.offsets()[k * d_ + a] / unit;
    }
    const Index vertex = source.vertices()[k].index;
    give(vertex, first + point, away / unit, back.span());
    if (d_ != 2 || away == 0 || source.is_curve() || source.vertices().size() > 1) continue;
    // A point beside its only vertex, in whose tangent plane the neighbours lie too.
    const Star star = graph_.star(vertex);
    for (std::size_t e = 0; e < star.degree(); ++e)
      give(star.neighbors[e], first + point,
           std::hypot(star.log(e)[0] - back.data()[0], star.log(e)[1] - back.data()[1]), {});
  }
  offer_midpoints(given);
  return first;
}

/// A point of a triangle is at the distance of its median from the midpoint of a side whose ends' distances are given.
void UnfoldingFront::offer_midpoints(std::vector<Waiting>& given) {
  std::sort(given.begin(), given.end(), [](const Waiting& a, const Waiting& b) {
    return std::tie(a.point, a.vertex) < std::tie(b.point, b.vertex);
  });
  for (std::size_t i = 0; i < given.size(); ++i)
    for (std::size_t j = i + 1; j < given.size() && given[j].point == given[i].point; ++j) {
      const auto side = stars_->midpoint(given[i].vertex, given[j].vertex);
      if (!side) continue;
      const double a = given[i].distance, b = given[j].distance;
      const double squared = 0.5 * (a * a + b * b) - side->half * side->half;
      offer(side->midpoint, given[i].point, std::sqrt(std::max(0.0, squared)), 0, {});
    }
}

void UnfoldingFront::run(double radius) {
  const double limit = radius / graph_.length_unit();
  while (!queue_.empty() && queue_.top().distance <= limit) {
    const auto [distance, vertex, point] = queue_.top();
    queue_.pop();
    if (const Entry* entry = find(vertex, point); entry && entry->distance == distance) spread(vertex, point, distance);
  }
}

double UnfoldingFront::distance(Vertex vertex) const {
  const Index head = head_[vertex.index];
  return head == none ? std::numeric_limits<double>::infinity() : entries_[head].distance * graph_.length_unit();
}

Index UnfoldingFront::nearest(Vertex vertex) const {
  const Index head = head_[vertex.index];
  return head == none ? none : entries_[head].point;
}

const UnfoldingFront::Entry* UnfoldingFront::find(Index vertex, Index point) const {
  for (Index e = head_[vertex]; e != none; e = entries_[e].next)
    if (entries_[e].point == point) return &entries_[e];
  return nullptr;
}

/// Gives the entry of the farthest point to a nearer one; none where there is no farther.
Index UnfoldingFront::replace_farthest(Index vertex, Index point, double distance) {
  Index farthest = head_[vertex];
  for (Index e = head_[vertex]; e != none; e = entries_[e].next)
    if (entries_[e].distance > entries_[farthest].distance) farthest = e;
  if (!(distance < entries_[farthest].distance * (1 - least_gain))) return none;
  entries_[farthest].point = point;
  entries_[farthest].gains = 0;
  return farthest;
}

/// Keeps a distance if it is the least from its point, and that point the nearest or nearly so.
void UnfoldingFront::offer(Index vertex, Index point, double distance, double slack,
                           std::span<const double> displacement) {
  Index own = head_[vertex], before = none;
  const double nearest = own == none ? std::numeric_limits<double>::infinity() : entries_[own].distance;
  if (!(distance <= nearest + slack)) return;
  Index points = 0;
  while (own != none && entries_[own].point != point) before = own, own = entries_[own].next, ++points;
  if (own == none && points >= most_points) {
    own = replace_farthest(vertex, point, distance);
    if (own == none) return;
    before = none;
    for (Index e = head_[vertex]; e != own; e = entries_[e].next) before = e;
  } else if (own == none) {
    own = static_cast<Index>(entries_.size());
    entries_.push_back({distance, point, head_[vertex], 0});
    if (d_ != 2) displacements_.resize(displacements_.size() + d_);
    head_[vertex] = own;
  } else if (!(distance < entries_[own].distance * (1 - least_gain)) || entries_[own].gains == most_gains) {
    return;
  }
  ++entries_[own].gains;
  entries_[own].distance = distance;
  if (d_ != 2)
    std::copy(displacement.begin(), displacement.end(), displacements_.begin() + static_cast<std::ptrdiff_t>(own * d_));
  // The nearest comes first.
  if (own == head_[vertex]) {
    if (const Index second = entries_[own].next; second != none && entries_[second].distance < distance) {
      entries_[own].next = entries_[second].next;
      entries_[second].next = own;
      head_[vertex] = second;
    }
  } else if (distance < nearest) {
    entries_[before].next = entries_[own].next;
    entries_[own].next = head_[vertex];
    head_[vertex] = own;
  }
  queue_.push({distance, vertex, point});
}

std::span<const UnfoldingFront::Corner> UnfoldingFront::around(Index vertex) {
  if (stars_ && !stars_->of(vertex).empty()) return stars_->of(vertex);
  around_.clear();
  Stars::append_corners(graph_, vertex, neighbors_, around_);
  return around_;
}

/// Along the edges of a vertex, and across the triangles of its star: from its own distance and that of one neighbour to
/// the other.
void UnfoldingFront::spread(Index from, Index point, double distance) {
  if (d_ != 2) return carry(from, point);
  const std::span<const Corner> corners = around(from);
  const std::size_t degree = corners.size();
  known_.resize(degree);
  double longest = 0;
  for (std::size_t k = 0; k < degree; ++k) {
    const Entry* entry = find(corners[k].neighbor, point);
    const double before = entry ? entry->distance : std::numeric_limits<double>::infinity();
    const double along = distance + corners[k].length;
    known_[k] = {before, std::min(before, along), along};
    longest = std::max(longest, corners[k].length);
  }
  for (std::size_t k = 0; k < degree; ++k) {
    const std::size_t next = k + 1 < degree ? k + 1 : 0;
    const Corner &right = corners[k], &left = corners[next];
    if (std::isnan(right.cosine)) continue;
    const auto unfold = [&](std::size_t base, double base_length, std::size_t target, double target_length) {
      if (!(known_[base].now < known_[base].along)) return;
      const double limit = known_[target].now * known_[target].now;
      const double found = squared_across(distance, known_[base].now, base_length, target_length * right.cosine,
                                          target_length * right.sine, limit);
      if (found < limit) known_[target].now = std::sqrt(found);
    };
    unfold(k, right.length, next, left.length);
    unfold(next, left.length, k, right.length);
  }
  // What unfolds to a border comes from a few edges beyond.
  for (std::size_t k = 0; k < degree; ++k)
    if (known_[k].now < known_[k].before) offer(corners[k].neighbor, point, known_[k].now, 4 * longest, {});
}

/// The displacement to the point, from vertex to vertex.
void UnfoldingFront::carry(Index from, Index point) {
  const auto own = static_cast<std::size_t>(find(from, point) - entries_.data());
  const Star star = graph_.star(from);
  Scratch here(d_), there(d_);
  std::copy_n(displacements_.begin() + static_cast<std::ptrdiff_t>(own * d_), d_, here.data());
  for (std::size_t e = 0; e < star.degree(); ++e) {
    Scratch left(d_);
    for (std::size_t a = 0; a < d_; ++a) left.data()[a] = here.data()[a] - star.log(e)[a];
    star.transport(e).apply_inverse(left.data(), there.data());
    offer(star.neighbors[e], point, length(there.span()), 2 * length(star.log(e)), there.span());
  }
}

}  // namespace ahm
