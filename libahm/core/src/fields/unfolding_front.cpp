#include "ahm/fields/unfolding_front.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ahm/util/scratch.hpp"
#include "ahm/util/small_math.hpp"
#include "maps/inflow.hpp"

namespace ahm {
namespace {

constexpr Index none = -1;
/// Less than this is rounding.
constexpr double least_gain = 1e-12;
/// An entry is bettered no more often: where triangles contradict each other they could go on for ever.
constexpr Index most_gains = 40;
/// Sides that are shorter than this share of a distance no longer tell where its point lies.
constexpr double shortest_side = 1e-6;

/// A number that grows with the angle of v, from -2 to 2.
double turn(const Vec2& v) {
  const double along = v[0] / (std::abs(v[0]) + std::abs(v[1]));
  return v[1] >= 0 ? 1 - along : along - 1;
}

double cross(const Vec2& u, const Vec2& v) { return u[0] * v[1] - u[1] * v[0]; }

/// The third side of the corner between two neighbours in the plane; none where the star is open between them.
std::optional<double> third_side(const TangentGraph& graph, Index p, const Vec2& u, Index q, const Vec2& v) {
  if (p == q || cross(u, v) <= 0) return std::nullopt;
  const Star star = graph.star(p);
  for (std::size_t e = 0; e < star.degree(); ++e)
    if (star.neighbors[e] == q) return length(star.log(e));
  // Not joined: a corner of a grid or a square if it is narrow, else a gap.
  if (u[0] * v[0] + u[1] * v[1] < -0.5 * std::hypot(u[0], u[1]) * std::hypot(v[0], v[1])) return std::nullopt;
  return std::hypot(u[0] - v[0], u[1] - v[1]);
}

/// The distance of c from a point at distances `from_a` and `from_b`, beyond the side ab of a triangle of the given sides;
/// none where the straight line to it does not cross that side.
std::optional<double> across(double from_a, double from_b, double ab, double ac, double bc) {
  if (!(ab > shortest_side * from_a)) return std::nullopt;
  // a is at 0, b at (ab, 0), c above, the point below.
  const double x = (from_a * from_a - from_b * from_b + ab * ab) / (2 * ab), squared_y = from_a * from_a - x * x;
  const double cx = (ac * ac - bc * bc + ab * ab) / (2 * ab), squared_cy = ac * ac - cx * cx;
  if (!(squared_cy > 0) || !(squared_y >= -1e-14 * from_a * from_a)) return std::nullopt;
  const double y = -std::sqrt(std::max(0.0, squared_y)), cy = std::sqrt(squared_cy);
  const double at_side = x - (cx - x) * y / (cy - y);
  if (!(at_side >= -1e-9 * ab) || !(at_side <= ab * (1 + 1e-9))) return std::nullopt;
  return std::hypot(cx - x, cy - y);
}

}  // namespace

UnfoldingFront::UnfoldingFront(const TangentGraph& graph)
    : graph_(graph),
      d_(static_cast<std::size_t>(graph.dimension())),
      head_(static_cast<std::size_t>(graph.size()), none) {
  entries_.reserve(head_.size());
}

Index UnfoldingFront::add(const Source& source) {
  check_source(source, graph_);
  const double unit = graph_.length_unit();
  const Index first = points_;
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
    offer(vertex, first + point, away / unit, 0, back.span());
    if (d_ != 2 || away == 0 || source.is_curve() || source.vertices().size() > 1) continue;
    // A point beside its only vertex, in whose tangent plane the neighbours lie too.
    look_around(vertex);
    for (const Neighbor& n : around_)
      offer(n.vertex, first + point, std::hypot(n.log[0] - back.data()[0], n.log[1] - back.data()[1]), 0, {});
  }
  return first;
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

/// Keeps a distance if it is the least from its point, and that point the nearest or nearly so.
bool UnfoldingFront::offer(Index vertex, Index point, double distance, double slack,
                           std::span<const double> displacement) {
  Index own = head_[vertex], before = none;
  const double nearest = own == none ? std::numeric_limits<double>::infinity() : entries_[own].distance;
  if (!(distance <= nearest + slack)) return false;
  while (own != none && entries_[own].point != point) before = own, own = entries_[own].next;
  if (own == none) {
    own = static_cast<Index>(entries_.size());
    entries_.push_back({distance, point, head_[vertex], 0});
    if (d_ != 2) displacements_.resize(displacements_.size() + d_);
    before = none;
    head_[vertex] = own;
  } else if (!(distance < entries_[own].distance * (1 - least_gain)) || entries_[own].gains == most_gains) {
    return false;
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
  return true;
}

void UnfoldingFront::spread(Index from, Index point, double distance) {
  if (d_ != 2) return carry(from, point);
  look_around(from);
  double longest = 0;
  for (const Neighbor& c : around_) longest = std::max(longest, c.length);
  const double slack = 4 * longest;  // what unfolds to a border comes from a few edges beyond
  for (const Neighbor& c : around_) offer(c.vertex, point, distance + c.length, slack, {});
  unfold(point, distance, slack);
}

/// The neighbours of a vertex, counterclockwise.
void UnfoldingFront::look_around(Index vertex) {
  around_.clear();
  const Star star = graph_.star(vertex);
  for (std::size_t e = 0; e < star.degree(); ++e)
    around_.push_back({star.neighbors[e], {star.logs[2 * e], star.logs[2 * e + 1]}, length(star.log(e)), e});
  std::sort(around_.begin(), around_.end(), [](const Neighbor& a, const Neighbor& b) {
    const double s = turn(a.log), t = turn(b.log);
    return s != t ? s < t : a.edge < b.edge;
  });
}

/// Across the triangles of the star of a, from its own distance and that of one neighbour to the other.
void UnfoldingFront::unfold(Index point, double distance, double slack) {
  for (std::size_t k = 0; k < around_.size(); ++k) {
    const Neighbor &right = around_[k], &left = around_[k + 1 < around_.size() ? k + 1 : 0];
    const Entry *of_right = find(right.vertex, point), *of_left = find(left.vertex, point);
    if (!of_right && !of_left) continue;
    const std::optional<double> side = third_side(graph_, right.vertex, right.log, left.vertex, left.log);
    if (!side) continue;
    // `offer` may move the entries.
    const double to_right = of_right ? of_right->distance : 0, to_left = of_left ? of_left->distance : 0;
    if (of_right)
      if (const auto found = across(distance, to_right, right.length, left.length, *side))
        offer(left.vertex, point, *found, slack, {});
    if (of_left)
      if (const auto found = across(distance, to_left, left.length, right.length, *side))
        offer(right.vertex, point, *found, slack, {});
  }
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
