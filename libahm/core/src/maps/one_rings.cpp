#include "maps/one_rings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "ahm/graph/components.hpp"
#include "ahm/graph/graph_cache.hpp"
#include "ahm/util/buckets.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

/// Largest relative difference between the lengths of an edge at its two ends.
constexpr double same_length = 1e-9;
/// Angle defects up to this size, radians, are those of a flat or finely sampled surface.
constexpr double least_bend = 0.01;
/// A triangle is degenerate if its longest side exceeds the sum of the others, or falls short of it by up to this share of the
/// longest side.
constexpr double degenerate = 1e-9;
/// Rounding of the coordinates rotates short edges. Angle defects below this value times the ratio of the longest to the shortest
/// edge may be rounding.
constexpr double least_turn = 1e-12;

/// A number from -2 to 2 that increases with the angle of v.
double turn(const Vec2& v) {
  const double along = v[0] / (std::abs(v[0]) + std::abs(v[1]));
  return v[1] >= 0 ? 1 - along : along - 1;
}

/// A sum of angles in [0, pi], computed from their cosines and sines.
class AngleSum {
 public:
  void add(double cosine, double sine) {
    const double x = x_ * cosine - y_ * sine, y = x_ * sine + y_ * cosine;
    turns_ += y_ < 0 && y >= 0;
    x_ = x, y_ = y;
  }
  double sum() const {
    const double angle = std::atan2(y_, x_);
    return 2 * std::numbers::pi * (turns_ + (y_ < 0)) + angle;
  }

 private:
  double x_ = 1, y_ = 0;
  int turns_ = 0;
};

/// Whether two vertices have a common neighbor other than `except`. In a square without its diagonal this is the fourth corner; across a
/// notch of the boundary there is none.
bool have_common_neighbor(const TangentGraph& graph, Index a, Index b, Index except) {
  if (graph.star(a).degree() > graph.star(b).degree()) std::swap(a, b);
  static thread_local std::vector<Index> beside_a;  // a copy: the star is valid until the next call of graph.star
  const auto of_a = graph.star(a).neighbors;
  beside_a.assign(of_a.begin(), of_a.end());
  return std::ranges::any_of(beside_a, [&](Index j) {
    if (j == except) return false;
    const auto of_j = graph.star(j).neighbors;
    return std::ranges::find(of_j, b) != of_j.end();
  });
}

/// Length of the edge between two successive neighbors of a vertex; NaN if there is none.
template <class Neighbor>
double edge_between(const TangentGraph& graph, const Neighbor& right, const Neighbor& left, double apart) {
  const bool by_right = graph.star(right.vertex).degree() <= graph.star(left.vertex).degree();
  const Star star = graph.star(by_right ? right.vertex : left.vertex);
  double third = NAN;  // of several edges the one whose length fits best in the tangent plane
  for (std::size_t e = 0; e < star.degree(); ++e) {
    if (star.neighbors[e] != (by_right ? left.vertex : right.vertex)) continue;
    const double side = length(star.log(e));
    if (!(std::abs(side - apart) >= std::abs(third - apart))) third = side;
  }
  return third;
}

/// Whether two successive neighbors without an edge between them are corners of a square or another polygon with the vertex. A
/// wide angle is a gap.
template <class Neighbor>
bool are_in_polygon(const TangentGraph& graph, Index vertex, const Neighbor& right, const Neighbor& left) {
  const Vec2 &u = right.log, &v = left.log;
  return u[0] * v[0] + u[1] * v[1] >= -0.5 * right.length * left.length &&
         have_common_neighbor(graph, right.vertex, left.vertex, vertex);
}

/// The fourth corner of a parallelogram.
struct FarCorner {
  Index vertex;
  bool reflects;  ///< whether the transport to it along two sides is a reflection
};

/// The corner opposite to a vertex in its parallelogram with two successive neighbors; nullopt if there is none, or if it is a
/// neighbor, too.
template <class Neighbor>
std::optional<FarCorner> far_corner(const TangentGraph& graph, std::span<const Neighbor> neighbors, Index vertex,
                                    const Neighbor& right, const Neighbor& left) {
  const auto has_length = [](const Star& star, std::size_t e, double expected) {
    return std::abs(length(star.log(e)) - expected) <= same_length * expected;
  };
  const bool may_reflect = graph.transport_layout().may_reflect();
  for (std::size_t e = 0; e < graph.star(right.vertex).degree(); ++e) {
    const Star beside = graph.star(right.vertex);  // again, because the loop requests another star
    const Index far = beside.neighbors[e];
    if (far == vertex || !has_length(beside, e, left.length)) continue;
    if (std::ranges::find(neighbors, far, &Neighbor::vertex) != neighbors.end()) continue;
    const bool reflects = right.reflects != (may_reflect && beside.transport(e).reflects());
    const Star other = graph.star(left.vertex);
    for (std::size_t k = 0; k < other.degree(); ++k)
      if (other.neighbors[k] == far && has_length(other, k, right.length)) return FarCorner{far, reflects};
  }
  return std::nullopt;
}

/// Cosine and sine of the angle between two sides of a triangle, from its lengths [Kah14]; NaN if there is no triangle.
Vec2 corner(double a, double b, double opposite) {
  std::array<double, 3> sides{a, b, opposite};
  std::sort(sides.begin(), sides.end(), std::greater<>());
  const auto [x, y, z] = sides;
  const double squared = (x + (y + z)) * (z - (x - y)) * (z + (x - y)) * (x + (y - z));  // 16 area^2
  if (!(squared > 0)) return {NAN, NAN};
  return {((a - opposite) * (a + opposite) + b * b) / (2 * a * b), std::sqrt(squared) / (2 * a * b)};
}

}  // namespace

std::vector<std::uint8_t> halved_vertices(std::span<const Index> component, std::span<const Index> sizes) {
  std::vector<std::uint8_t> halved;
  halved.reserve(component.size());
  for (const Index c : component) halved.push_back(sizes[c] <= most_halved);
  return halved;
}

std::vector<std::uint8_t> halved_vertices(const TangentGraph& graph) {
  if (!graph.is_delaunay()) return {};
  const Components components = connected_components(graph);
  std::vector<Index> sizes(static_cast<std::size_t>(components.count), 0);
  for (const Index c : components.of_vertex) ++sizes[c];
  return halved_vertices(components.of_vertex, sizes);
}

void Wavefront::OneRings::find_neighbors(const TangentGraph& graph, Index vertex, std::vector<Neighbor>& neighbors) {
  neighbors.clear();
  const Star star = graph.star(vertex);
  const bool may_reflect = graph.transport_layout().may_reflect();
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const Vec2 log{star.logs[2 * e], star.logs[2 * e + 1]};
    neighbors.push_back({star.neighbors[e], log, std::sqrt(log[0] * log[0] + log[1] * log[1]), turn(log), e,
                         may_reflect && star.transport(e).reflects()});
  }
  std::sort(neighbors.begin(), neighbors.end(),
            [](const Neighbor& a, const Neighbor& b) { return a.turn != b.turn ? a.turn < b.turn : a.edge < b.edge; });
  const auto is_same = [](const Neighbor& a, const Neighbor& b) { return a.vertex == b.vertex && a.log == b.log; };
  neighbors.erase(std::unique(neighbors.begin(), neighbors.end(), is_same), neighbors.end());
}

void Wavefront::OneRings::append_corners(const TangentGraph& graph, Index vertex, std::vector<Neighbor>& neighbors,
                                         std::vector<Corner>& corners) {
  find_neighbors(graph, vertex, neighbors);
  for (std::size_t k = 0; k < neighbors.size(); ++k) {
    const Neighbor &right = neighbors[k], &left = neighbors[k + 1 < neighbors.size() ? k + 1 : 0];
    const auto append = [&](double third) {
      const Vec2 angle = corner(right.length, left.length, third);
      corners.push_back({right.vertex, right.reflects, false, right.length, angle[0], angle[1]});
    };
    const bool is_open = right.vertex == left.vertex || cross(right.log, left.log) <= 0;
    const double apart = length(right.log - left.log);
    const double edge = is_open ? NAN : edge_between(graph, right, left, apart);
    if (is_open || !std::isnan(edge) || !are_in_polygon(graph, vertex, right, left)) {
      append(edge);
      continue;
    }
    // Only along edges, a path that turns at a corner of a grid would be longer. Curved fronts need triangles.
    const auto far = graph.is_delaunay() ? std::nullopt : far_corner<Neighbor>(graph, neighbors, vertex, right, left);
    if (!far) {
      append(apart);
      continue;
    }
    const double diagonal = length(right.log + left.log);
    const Vec2 to_far = corner(right.length, diagonal, left.length),
               to_left = corner(diagonal, left.length, right.length);
    corners.push_back({right.vertex, right.reflects, false, right.length, to_far[0], to_far[1]});
    corners.push_back({far->vertex, far->reflects, true, diagonal, to_left[0], to_left[1]});
  }
}

double Wavefront::OneRings::curvature_of(std::span<const Corner> corners) {
  AngleSum angle;
  double area = 0, shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Corner &right = corners[k], &left = corners[k + 1 < corners.size() ? k + 1 : 0];
    if (std::isnan(right.cosine)) return 0;
    angle.add(right.cosine, right.sine);
    area += right.length * left.length * right.sine / 6;
    shortest = std::min(shortest, right.length);
    longest = std::max(longest, right.length);
  }
  const double missing = 2 * std::numbers::pi - angle.sum();
  const double curvature = std::abs(missing) * shortest > least_turn * longest ? missing / area : 0;
  return std::isfinite(curvature) ? curvature : 0;
}

/// Cuts each triangle into four. A directed edge is identified by its corner: the one at its start that has the edge on its right side.
class Wavefront::OneRings::Halving {
 public:
  /// @param stars  one-rings to cut
  Halving(const OneRings& stars, std::vector<std::uint8_t>& halved)
      : stars_(stars), halved_(halved), corners_(stars.corners_), twin_(corners_.size(), -1), middle_(corners_.size()) {
    start_.reserve(corners_.size());
    for (Index i = 0; i < stars.size_; ++i) start_.insert(start_.end(), stars.of(i).size(), i);
    leave_flat_ones_whole();
    for (Offset c = 0; c < static_cast<Offset>(corners_.size()); ++c)
      if (halved_[start_[c]]) twin_[c] = find_twin(c);
    for (Offset c = 0; c < static_cast<Offset>(corners_.size()); ++c)
      if (halved_[start_[c]] && (twin_[c] < 0 || twin_[twin_[c]] != c)) leave_whole(start_[c]);
    for (Offset c = 0; c < static_cast<Offset>(corners_.size()); ++c)
      if (halved_[start_[c]] && is_in_doubt(c)) leave_whole(start_[c]);
  }

  /// Makes the one-rings of the vertices, then those of the midpoints.
  void cut(std::vector<Offset>& begin, std::vector<Corner>& corners) {
    Index size = stars_.size_;
    for (Offset c = 0; c < static_cast<Offset>(corners_.size()); ++c)
      if (halved_[start_[c]]) middle_[c] = c < twin_[c] ? size++ : middle_[twin_[c]];
    begin.assign(1, 0);
    for (Index i = 0; i < stars_.size_; ++i) {
      for (Offset c = stars_.begin_[i]; c < stars_.begin_[i + 1]; ++c)
        corners.push_back(halved_[i] ? half(c) : corners_[c]);
      begin.push_back(static_cast<Offset>(corners.size()));
    }
    for (Offset c = 0; c < static_cast<Offset>(corners_.size()); ++c)
      if (halved_[start_[c]] && c < twin_[c]) {
        append_side(c, corners);
        append_side(twin_[c], corners);
        begin.push_back(static_cast<Offset>(corners.size()));
      }
  }

 private:
  Offset next(Offset c) const { return c + 1 < stars_.begin_[start_[c] + 1] ? c + 1 : stars_.begin_[start_[c]]; }
  Offset previous(Offset c) const { return c > stars_.begin_[start_[c]] ? c - 1 : stars_.begin_[start_[c] + 1] - 1; }

  /// Corner of the edge of corner c at its other end; -1 if it is not unique.
  Offset find_twin(Offset c) const {
    const Corner& edge = corners_[c];
    Offset found = -1;
    for (Offset t = stars_.begin_[edge.neighbor]; t < stars_.begin_[edge.neighbor + 1]; ++t) {
      if (corners_[t].neighbor != start_[c]) continue;
      if (!(std::abs(corners_[t].length - edge.length) <= same_length * edge.length)) continue;
      if (found >= 0 || t == c) return -1;
      found = t;
    }
    return found;
  }

  /// Marks the connected component of a vertex.
  void mark(Index vertex, std::uint8_t value, std::vector<std::uint8_t>& marks) const {
    std::vector<Index> stack{vertex};
    marks[vertex] = value;
    while (!stack.empty()) {
      const Index i = stack.back();
      stack.pop_back();
      for (const Corner& c : stars_.of(i))
        if (marks[c.neighbor] != value) marks[c.neighbor] = value, stack.push_back(c.neighbor);
    }
  }

  void leave_whole(Index vertex) { mark(vertex, 0, halved_); }

  /// Does not cut flat components, because distances are exact there.
  void leave_flat_ones_whole() {
    std::vector<std::uint8_t> bent(halved_.size(), 0);
    for (Index i = 0; i < stars_.size_; ++i) {
      if (!halved_[i] || bent[i]) continue;
      double missing = 2 * std::numbers::pi;  // NaN on boundaries
      for (const Corner& c : stars_.of(i)) missing -= std::atan2(c.sine, c.cosine);
      if (std::abs(missing) > least_bend) mark(i, 1, bent);
    }
    for (std::size_t i = 0; i < halved_.size(); ++i) halved_[i] &= bent[i];
  }

  bool is_open(Offset c) const { return std::isnan(corners_[c].cosine); }

  /// The other two sides of the triangle to the left of an edge, at its start and at its end; nullopt if there is no triangle. One of its
  /// corners may be NaN, because the angles at a vertex are scaled to a sum of 2 pi.
  struct Left {
    Offset start_side, end_side;
  };
  std::optional<Left> left_of(Offset c) const {
    const Left sides{next(c), previous(twin_[c])};
    const Offset across = twin_[sides.start_side];
    if (next(across) != twin_[sides.end_side]) return std::nullopt;
    if (is_open(c) + is_open(sides.end_side) + is_open(across) > 1) return std::nullopt;
    return sides;
  }

  /// Whether there may be a triangle that is not found at all of its vertices, because it is too thin or the surface is one-sided.
  bool is_in_doubt(Offset c) const {
    if (left_of(c)) return false;
    const Index j = corners_[c].neighbor, l = corners_[next(c)].neighbor;
    const double a = corners_[c].length, b = corners_[next(c)].length;
    for (Offset t = stars_.begin_[j]; t < stars_.begin_[j + 1]; ++t) {
      if (corners_[t].neighbor != l) continue;
      const double across = corners_[t].length, longest = std::max({a, b, across});
      if (!is_open(c) || a + b + across - 2 * longest <= degenerate * longest) return true;
    }
    return false;
  }

  /// A corner between two half sides of a triangle with these sides.
  static Corner half(Index neighbor, double right, double left, double across) {
    const Vec2 angle = corner(right, left, across);
    return {neighbor, false, false, 0.5 * right, angle[0], angle[1]};
  }
  Corner open_half(Index neighbor, Offset c) const {
    return {neighbor, false, false, 0.5 * corners_[c].length, NAN, NAN};
  }

  /// The corner of a vertex between the first halves of two sides.
  Corner half(Offset c) const {
    const auto left = left_of(c);
    if (!left) return open_half(middle_[c], c);
    return half(middle_[c], corners_[c].length, corners_[left->start_side].length, corners_[left->end_side].length);
  }

  /// The corners of an edge's midpoint to the left of the edge, from its end to before its start.
  void append_side(Offset c, std::vector<Corner>& corners) const {
    const auto left = left_of(c);
    if (!left) return corners.push_back(open_half(corners_[c].neighbor, c));
    const double along = corners_[c].length, start_side = corners_[left->start_side].length,
                 end_side = corners_[left->end_side].length;
    corners.push_back(half(corners_[c].neighbor, along, start_side, end_side));
    corners.push_back(half(middle_[left->end_side], start_side, end_side, along));
    corners.push_back(half(middle_[left->start_side], end_side, along, start_side));
  }

  const OneRings& stars_;
  std::vector<std::uint8_t>& halved_;
  const std::vector<Corner>& corners_;
  std::vector<Index> start_;   ///< vertex of each corner
  std::vector<Offset> twin_;   ///< corner of the same edge at its other end
  std::vector<Index> middle_;  ///< midpoint of each edge
};

Wavefront::OneRings::OneRings(const TangentGraph& graph, std::vector<std::uint8_t> halved, bool all, unsigned threads)
    : vertices_(graph.size()), size_(vertices_) {
  const bool any = std::find(halved.begin(), halved.end(), 1) != halved.end();
  if ((!any && !all) || graph.dimension() != 2) return;
  all_ = all;
  constexpr Offset chunk = 1 << 12;
  std::vector<std::vector<Corner>> parts(static_cast<std::size_t>(vertices_ / chunk) + 1);
  begin_.assign(static_cast<std::size_t>(vertices_) + 1, 0);
  curvatures_.assign(static_cast<std::size_t>(vertices_), 0.0);
  detail::parallel_chunks(vertices_, chunk, threads, [&](Offset begin, Offset end) {
    std::vector<Corner>& corners = parts[begin / chunk];
    std::vector<Neighbor> neighbors;
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      if (!all && !halved[i]) continue;
      const std::size_t before = corners.size();
      append_corners(graph, i, neighbors, corners);
      const std::span<const Corner> own = std::span(corners).subspan(before);
      begin_[i + 1] = std::ssize(own);
      if (!own.empty()) curvatures_[i] = curvature_of(own);
    }
  });
  begin_ = detail::begin_of_groups(std::move(begin_));
  corners_.reserve(static_cast<std::size_t>(begin_.back()));
  for (std::vector<Corner>& part : parts) {
    corners_.insert(corners_.end(), part.begin(), part.end());
    part = {};
  }
  if (!any) return;
  std::vector<Offset> begin;
  std::vector<Corner> corners;
  Halving(*this, halved).cut(begin, corners);
  begin_ = std::move(begin);
  corners_ = std::move(corners);
  size_ = static_cast<Index>(begin_.size()) - 1;
  for (Index middle = vertices_; middle < size_; ++middle) {
    double sum = 0;
    for (const Corner& corner : of(middle))
      if (corner.neighbor < vertices_) sum += curvatures_[corner.neighbor];
    curvatures_.push_back(sum / 2);
  }
}

void Wavefront::OneRings::find_cut_edges(Index vertex, std::vector<CutEdge>& edges) const {
  edges.clear();
  for (const Corner& half : of(vertex)) {
    if (half.neighbor < vertices_) return;
    for (const Corner& beside : of(half.neighbor))
      if (beside.neighbor < vertices_ && beside.neighbor != vertex)
        edges.push_back({beside.neighbor, half.neighbor, half.length});
  }
  std::sort(edges.begin(), edges.end(), [](const CutEdge& a, const CutEdge& b) { return a.end < b.end; });
  auto kept = edges.begin();
  for (auto first = edges.begin(); first != edges.end();) {
    const auto next = std::find_if(first, edges.end(), [&](const CutEdge& e) { return e.end != first->end; });
    if (next - first == 1) *kept++ = *first;
    first = next;
  }
  edges.erase(kept, edges.end());
}

std::shared_ptr<const Wavefront::OneRings> Wavefront::one_rings(const TangentGraph& graph, unsigned threads,
                                                                bool midpoints) {
  if (graph.dimension() != 2) return nullptr;
  const auto make = [&]() -> std::shared_ptr<const OneRings> {
    std::vector<std::uint8_t> halved = midpoints ? halved_vertices(graph) : std::vector<std::uint8_t>();
    if (midpoints && std::ranges::find(halved, 1) == halved.end()) return one_rings(graph, threads, false);
    return std::make_shared<const OneRings>(graph, std::move(halved), true, threads);
  };
  const GraphCache* const cache = graph.cache();
  if (cache == nullptr) return make();
  return cache->get<OneRings>(midpoints ? GraphCache::Kind::one_rings_with_midpoints : GraphCache::Kind::one_rings,
                              make);
}

std::shared_ptr<const Wavefront::OneRings> Wavefront::one_rings_within(const TangentGraph& graph, double radius,
                                                                       unsigned threads) {
  return std::isfinite(radius) ? nullptr : one_rings(graph, threads);
}

}  // namespace ahm
