#include "ahm/fields/unfolding_front.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ahm/util/scratch.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "maps/inflow.hpp"

namespace ahm {
namespace {

constexpr Index none = -1;
/// Less than this is rounding.
constexpr double least_gain = 1e-12;
/// An entry is bettered no more often: where triangles contradict each other they could go on for ever.
constexpr Index most_gains = 40;
/// Sides that are shorter than this share of the other two, or of a distance, no longer tell where its point lies.
constexpr double shortest_side = 1e-6, shortest_side_far_away = 1e-13;

/// A number that grows with the angle of v, from -2 to 2.
double turn(const Vec2& v) {
  const double along = v[0] / (std::abs(v[0]) + std::abs(v[1]));
  return v[1] >= 0 ? 1 - along : along - 1;
}

/// The distance of c from a point at distances `from_a` and `from_b`, beyond the side ab of a triangle of the given sides;
/// none where the straight line to it does not cross that side.
std::optional<double> across(double from_a, double from_b, double ab, double ac, double bc) {
  if (!(ab > shortest_side * ac) || !(ab > shortest_side_far_away * from_a)) return std::nullopt;
  // a is at 0, b at (ab, 0), c above, the point below.
  const double x = 0.5 * (ab + (from_a - from_b) * ((from_a + from_b) / ab)), squared_y = (from_a - x) * (from_a + x);
  const double cx = 0.5 * (ab + (ac - bc) * ((ac + bc) / ab)), squared_cy = (ac - cx) * (ac + cx);
  if (!(squared_cy > 0) || !(squared_y >= -1e-14 * from_a * from_a)) return std::nullopt;
  const double y = -std::sqrt(std::max(0.0, squared_y)), cy = std::sqrt(squared_cy);
  const double at_side = x - (cx - x) * y / (cy - y);
  if (!(at_side >= -1e-9 * ab) || !(at_side <= ab * (1 + 1e-9))) return std::nullopt;
  return std::sqrt((cx - x) * (cx - x) + (cy - y) * (cy - y));
}

struct Neighbor {
  Index vertex;
  Vec2 log;
  double length, turn;
  std::size_t edge;
};

/// The neighbours of a vertex, counterclockwise.
void neighbors_of(const TangentGraph& graph, Index vertex, std::vector<Neighbor>& neighbors) {
  neighbors.clear();
  const Star star = graph.star(vertex);
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const Vec2 log{star.logs[2 * e], star.logs[2 * e + 1]};
    neighbors.push_back({star.neighbors[e], log, std::sqrt(log[0] * log[0] + log[1] * log[1]), turn(log), e});
  }
  std::sort(neighbors.begin(), neighbors.end(),
            [](const Neighbor& a, const Neighbor& b) { return a.turn != b.turn ? a.turn < b.turn : a.edge < b.edge; });
}

/// The third side of the corner between two neighbours; NaN where the star is open between them.
double third_side(const TangentGraph& graph, const Neighbor& right, const Neighbor& left) {
  const double open = std::numeric_limits<double>::quiet_NaN();
  const Vec2 &u = right.log, &v = left.log;
  if (right.vertex == left.vertex || cross(u, v) <= 0) return open;
  const Star star = graph.star(right.vertex);
  for (std::size_t e = 0; e < star.degree(); ++e)
    if (star.neighbors[e] == left.vertex) return length(star.log(e));
  // Not joined: a corner of a grid or a square if it is narrow, else a gap.
  if (u[0] * v[0] + u[1] * v[1] < -0.5 * right.length * left.length) return open;
  return std::hypot(u[0] - v[0], u[1] - v[1]);
}

template <class Sector>
void append_sectors(const TangentGraph& graph, Index vertex, std::vector<Neighbor>& neighbors,
                    std::vector<Sector>& sectors) {
  neighbors_of(graph, vertex, neighbors);
  for (std::size_t k = 0; k < neighbors.size(); ++k) {
    const Neighbor &right = neighbors[k], &left = neighbors[k + 1 < neighbors.size() ? k + 1 : 0];
    sectors.push_back({right.vertex, left.vertex, right.length, left.length, third_side(graph, right, left)});
  }
}

}  // namespace

class UnfoldingFront::Stars {
 public:
  explicit Stars(const TangentGraph& graph) : begin_{0} {
    sectors_.reserve(static_cast<std::size_t>(graph.edge_count()));
    std::vector<Neighbor> neighbors;
    for (Index i = 0; i < graph.size(); ++i) {
      append_sectors(graph, i, neighbors, sectors_);
      begin_.push_back(static_cast<Offset>(sectors_.size()));
    }
  }
  std::span<const Sector> of(Index vertex) const {
    return std::span(sectors_).subspan(static_cast<std::size_t>(begin_[vertex]),
                                       static_cast<std::size_t>(begin_[vertex + 1] - begin_[vertex]));
  }

 private:
  std::vector<Offset> begin_;
  std::vector<Sector> sectors_;
};

std::shared_ptr<const UnfoldingFront::Stars> UnfoldingFront::stars(const TangentGraph& graph) {
  return graph.dimension() == 2 ? std::make_shared<const Stars>(graph) : nullptr;
}

UnfoldingFront::UnfoldingFront(const TangentGraph& graph, std::shared_ptr<const Stars> stars)
    : graph_(graph),
      d_(static_cast<std::size_t>(graph.dimension())),
      head_(static_cast<std::size_t>(graph.size()), none),
      stars_(std::move(stars)) {
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
    std::vector<Neighbor> neighbors;
    neighbors_of(graph_, vertex, neighbors);
    for (const Neighbor& n : neighbors)
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
void UnfoldingFront::offer(Index vertex, Index point, double distance, double slack,
                           std::span<const double> displacement) {
  Index own = head_[vertex], before = none;
  const double nearest = own == none ? std::numeric_limits<double>::infinity() : entries_[own].distance;
  if (!(distance <= nearest + slack)) return;
  while (own != none && entries_[own].point != point) before = own, own = entries_[own].next;
  if (own == none) {
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

std::span<const UnfoldingFront::Sector> UnfoldingFront::around(Index vertex) {
  if (stars_) return stars_->of(vertex);
  static thread_local std::vector<Neighbor> neighbors;
  around_.clear();
  append_sectors(graph_, vertex, neighbors, around_);
  return around_;
}

/// Along the edges of a vertex, and across the triangles of its star: from its own distance and that of one neighbour to
/// the other.
void UnfoldingFront::spread(Index from, Index point, double distance) {
  if (d_ != 2) return carry(from, point);
  const std::span<const Sector> sectors = around(from);
  double longest = 0;
  for (const Sector& s : sectors) longest = std::max(longest, s.right_length);
  const double slack = 4 * longest;  // what unfolds to a border comes from a few edges beyond
  for (const Sector& s : sectors) offer(s.right, point, distance + s.right_length, slack, {});
  for (const Sector& s : sectors) {
    if (std::isnan(s.side)) continue;
    const Entry *right = find(s.right, point), *left = find(s.left, point);
    if (!right || !left) continue;
    const double to_right = right->distance, to_left = left->distance;  // `offer` may move the entries
    if (to_right < distance + s.right_length)
      if (const auto found = across(distance, to_right, s.right_length, s.left_length, s.side))
        offer(s.left, point, *found, slack, {});
    if (to_left < distance + s.left_length)
      if (const auto found = across(distance, to_left, s.left_length, s.right_length, s.side))
        offer(s.right, point, *found, slack, {});
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
