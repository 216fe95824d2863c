#include "ahm/maps/wavefront.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/scratch.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "maps/front_geometry.hpp"
#include "maps/wavefront_impl.hpp"

namespace ahm {
namespace {

/// Smallest relative improvement of a distance. Smaller ones are rounding.
constexpr double least_gain = 1e-14;
/// Paths whose lengths differ by less than `same_length` (relative) are equally long. Of these the one with the smaller focusing is
/// chosen, so that rounding does not choose between paths through the same flat faces.
constexpr double same_length = 1e-10, same_focusing = 1e-6;
/// Largest number of points for which a vertex stores distances: of points, of samples of a curve, and of the latter the nearest
/// ones. Curves have many samples at nearly equal distances.
constexpr std::size_t most_points = 8, most_of_curve = 12, nearest_of_curve = 4;
/// Shares of a side by which a line may miss it and still passes its end: on triangulations and on other graphs. On other graphs, for
/// example points in squares, a line may pass between two triangles that both miss it; then only the edges would remain.
constexpr double missed = 1e-9, missed_between = 1e-3;
/// Size of the cache of one-rings. Those ahead of the front are used several times.
constexpr std::size_t ring_cache_size = 2048;

/// How the front arrives at a vertex.
struct Arrival {
  double distance, focusing;
  bool follows_edge;
};

/// Whether an arrival replaces another one. Where the front crosses an edge at a tiny angle, the detour along the edge is below `least_gain`,
/// but the direction is wrong by the square root of that: there the path across triangles is chosen.
bool comes_before(const Arrival& one, const Arrival& other) {
  if (!one.follows_edge && other.follows_edge && one.distance <= other.distance * (1 + least_gain)) return true;
  if (!(std::abs(one.distance - other.distance) <= same_length * other.distance)) return one.distance < other.distance;
  const double gain = std::abs(other.focusing) - std::abs(one.focusing);
  return std::abs(gain) > same_focusing * std::abs(other.focusing) ? gain > 0
                                                                   : one.distance < other.distance * (1 - least_gain);
}

}  // namespace

Wavefront::Impl::Impl(const TangentGraph& graph, std::shared_ptr<const OneRings> one_rings, bool directions)
    : graph_(graph),
      d_(static_cast<std::size_t>(graph.dimension())),
      missed_(graph.is_delaunay() ? missed : missed_between),
      is_curved_(graph.is_delaunay() && d_ == 2),
      directions_(directions && d_ == 2),
      one_rings_(one_rings || !graph.is_delaunay()
                     ? std::move(one_rings)
                     : std::make_shared<const OneRings>(graph, halved_vertices(graph), false)) {
  first_.assign(static_cast<std::size_t>(one_rings_ ? one_rings_->size() : graph.size()), none);
  entries_.reserve(first_.size());
}

/// Removes the entries of all vertices.
void Wavefront::Impl::forget() {
  for (const Index vertex : touched_) first_[vertex] = none;
  touched_.clear();
  entries_.clear();
  displacements_.clear();
  paths_.clear();
  for (std::vector<Index>& rows : free_) rows.clear();
  queue_.clear();
}

void Wavefront::Impl::clear() {
  forget();
  is_closed_ = nullptr;
  points_ = 0;
  of_curve_ = false;
  longest_ = 0;
}

std::vector<Vertex> Wavefront::Impl::reached() const {
  std::vector<Vertex> vertices;
  vertices.reserve(touched_.size());
  for (const Index vertex : touched_)
    if (vertex < graph_.size()) vertices.emplace_back(vertex);
  return vertices;
}

void Wavefront::Impl::run(double radius, const StopToken& stop) {
  constexpr std::uint32_t between_looks = 4096;
  limit_ = radius / graph_.length_unit();
  longest_within_ = longest_;
  for (std::uint32_t taken = 0; !queue_.empty() && queue_.top().distance - longest_within_ <= limit_; ++taken) {
    if (taken % between_looks == 0 && stop.stop_requested()) throw Cancelled("cancelled during unfold");
    const auto [distance, vertex, point] = queue_.top();
    queue_.pop();
    if (one_rings_ && !queue_.empty())  // prefetch the corners of the vertex that is probably next
      for (const Corner& corner : one_rings_->of(queue_.top().vertex)) __builtin_prefetch(&corner);
    if (const Entry* entry = find(vertex, point); entry && entry->distance == distance) spread(vertex, point, distance);
  }
}

/// The entry of a full vertex that a new point replaces; none if all entries have priority over the new point. Nearer points have priority.
/// For curves the nearest samples are kept. Among the others those have priority whose numbers are multiples of larger powers of two. So
/// neighbors keep the same samples, both close together and far apart, whatever the density of the samples is.
Index Wavefront::Impl::entry_to_replace(Index vertex, Index point, double distance) {
  struct Kept {
    double distance;
    Index entry, point;
  };
  // Of equally distant points the one with the largest number is replaced.
  const auto comes_before = [](const Kept& a, const Kept& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.point < b.point;
  };
  const auto counts_less = [&](const Kept& a, const Kept& b) {
    const int level_a = std::countr_zero(static_cast<unsigned>(a.point)),
              level_b = std::countr_zero(static_cast<unsigned>(b.point));
    return of_curve_ && level_a != level_b ? level_a < level_b : comes_before(b, a);
  };
  std::array<Kept, most_of_curve + 1> all{{{distance, none, point}}};
  std::size_t count = 1;
  for (const Entry& entry : entries_of(vertex)) all[count++] = {entry.distance, number(entry), entry.point};
  const auto end = all.begin() + static_cast<std::ptrdiff_t>(count),
             others = all.begin() + (of_curve_ ? nearest_of_curve : 0);
  if (of_curve_) std::nth_element(all.begin(), others, end, comes_before);
  return std::min_element(others, end, counts_less)->entry;
}

/// Stores a distance if it is the smallest from its point so far, and at most by `slack` larger than that of the nearest point.
void Wavefront::Impl::offer(Index vertex, Index point, double distance, double slack,
                            std::span<const double> displacement, const Path& path, double focusing) {
  const std::span<const Entry> entries = entries_of(vertex);
  const double nearest = entries.empty() ? std::numeric_limits<double>::infinity() : entries.front().distance;
  if (!(distance <= nearest + slack)) return;
  if (entries.empty() && is_closed_ && is_closed_(Vertex(vertex))) return;
  Index own;
  bool is_added = false;
  if (const Entry* known = find(vertex, point)) {
    const bool follows_edge = directions_ && paths_[number(*known)].follows_edge();
    if (!comes_before({distance, focusing, path.follows_edge()}, {known->distance, known->focusing, follows_edge}) ||
        known->gains == most_gains)
      return;
    distance = std::min(distance, known->distance);
    own = number(*known);
  } else {
    is_added = entries.size() < (of_curve_ ? most_of_curve : most_points);
    own = is_added ? append(vertex) : entry_to_replace(vertex, point, distance);
    if (own == none) return;
    entries_[own].point = point;
    entries_[own].gains = 0;
  }
  ++entries_[own].gains;
  entries_[own].distance = distance;
  entries_[own].focusing = focusing;
  if (directions_) paths_[own] = path;
  if (d_ != 2)
    std::copy(displacement.begin(), displacement.end(), displacements_.begin() + static_cast<std::ptrdiff_t>(own * d_));
  // The entry of the nearest point comes first; of equally near points the one that was added last.
  const Index first = first_[vertex];
  Index least = first;
  if (own == first)
    least = number(*std::ranges::min_element(entries_of(vertex), {}, &Entry::distance));
  else if (distance < nearest || (is_added && distance == nearest))
    least = own;
  if (least != first) swap_entries(first, least);
  queue_.push({distance, vertex, point});
}

/// The corners of a vertex. Valid until the next call for another vertex.
std::span<const Wavefront::OneRings::Corner> Wavefront::Impl::one_ring(Index vertex) {
  if (one_rings_ && one_rings_->keeps(vertex)) return one_rings_->of(vertex);
  if (ring_cache_.empty()) ring_cache_.resize(std::min(ring_cache_size, first_.size()));
  CachedRing& seen = ring_cache_[static_cast<std::size_t>(vertex) % ring_cache_.size()];
  if (seen.vertex != vertex) {
    seen.vertex = vertex;
    seen.corners.clear();
    OneRings::append_corners(graph_, vertex, neighbors_, seen.corners);
  }
  return seen.corners;
}

/// Gaussian curvature at a vertex or midpoint; 0 if paths do not carry the curvature of the front.
double Wavefront::Impl::curvature(Index vertex) {
  if (!is_curved_) return 0;
  if (one_rings_->keeps(vertex)) return one_rings_->curvature(vertex);
  if (curvatures_.empty()) curvatures_.assign(static_cast<std::size_t>(graph_.size()), NAN);
  double& known = curvatures_[vertex];
  if (std::isnan(known)) known = OneRings::curvature_of(one_ring(vertex));
  return known;
}

/// Spreads the front from a vertex: along its edges, and across the triangles of its one-ring. In each triangle the distances of the vertex
/// and one neighbor give the distance of the other neighbor.
void Wavefront::Impl::spread(Index from, Index point, double distance) {
  if (d_ != 2) return carry(from, point, distance);
  std::span<const Corner> corners = one_ring(from);
  if (is_curved_ && !one_rings_->keeps(from)) {  // a copy: `curvature` of a neighbor may replace the cached corners
    ring_.assign(corners.begin(), corners.end());
    corners = ring_;
  }
  const std::size_t degree = corners.size();
  states_.resize(degree);
  double longest = 0;
  const auto path_of = [&](const Entry* entry) { return paths_[number(*entry)]; };
  const Entry* const here = find(from, point);
  const Path own = directions_ ? path_of(here) : Path{};
  const double focusing = here->focusing, curvature_here = distance > 0 ? curvature(from) : 0;
  const auto focusing_along = [&](const Corner& edge, double along) {
    if (!is_curved_) return 0.0;
    return focusing_after(focusing, distance, along, 0.5 * (curvature_here + curvature(edge.neighbor)));
  };
  for (std::size_t k = 0; k < degree; ++k) {
    const Entry* entry = find(corners[k].neighbor, point);
    const double before = entry ? entry->distance : std::numeric_limits<double>::infinity();
    // The source has no direction; from it the far corner of a square is found across the sides.
    const bool is_direct = distance > 0 || !corners[k].is_far;
    const double along = is_direct ? distance + corners[k].length : std::numeric_limits<double>::infinity();
    NeighborState& known = states_[k];
    known.is_new = !(before <= along);
    known.distance = known.is_new ? along : before;
    known.along = along;
    known.focusing = known.is_new ? focusing_along(corners[k], along) : entry ? entry->focusing : 0;
    if (directions_) {
      known.path = known.is_new ? Path{own.direction, {}, {from, distance > 0 ? from : none}, 0, own.variance}
                   : entry      ? path_of(entry)
                                : Path{};
      if (known.is_new && corners[k].is_far) {  // through the middle between the other corners of the square
        known.path.last = {corners[k - 1].neighbor, corners[k + 1 < degree ? k + 1 : 0].neighbor};
        known.path.share = 0.5F;
      }
      if (known.is_new && is_curved_)
        known.path.widening = own.widening + widening_between(distance, focusing, along, known.focusing);
    }
    longest = std::max(longest, corners[k].length);
  }
  if (!graph_.is_delaunay() || distance - longest / 2 <= limit_) longest_within_ = std::max(longest_within_, longest);
  for (std::size_t k = 0; k < degree; ++k) {
    const std::size_t next = k + 1 < degree ? k + 1 : 0;
    const Corner &right = corners[k], &left = corners[next];
    if (std::isnan(right.cosine)) continue;
    const auto unfold = [&](std::size_t base, double base_length, std::size_t target, double target_length,
                            double side) {
      const NeighborState& other = states_[base];
      NeighborState& found = states_[target];
      if (!(other.distance < other.along)) return;
      const double most = found.distance + (!is_curved_ ? 0 : max_curvature_correction * base_length);
      const double limit = most * most;
      const double cx = target_length * right.cosine, cy = target_length * right.sine;
      if (found.distance <= distance && is_beyond(distance, other.distance, base_length, cx, cy, limit)) return;
      const Across across = across_side(distance, other.distance, base_length, cx, cy, limit, missed_);
      if (!across.found) return;
      double length = across.length(), bent_by = 0, bend = 0, crossing = across.share;
      float wider = 0;
      if (is_curved_) {
        const auto between = [&](double a, double b) { return (1 - across.share) * a + across.share * b; };
        const double height = cy + across.depth, to_side = across.depth / height * length;
        const double at_side = between(focusing, other.focusing);
        const double squared_sine = height * height / across.squared;
        bend = bend_along(base_length, at_side, to_side);
        const double bent = length + curvature_correction(bend, base_length, across.share, squared_sine);
        if (!(bent <= found.distance * (1 + same_length))) return;
        const double curved = between(curvature_here, curvature(corners[base].neighbor));
        bent_by = focusing_after(at_side, to_side, length, 0.5 * (curved + curvature(corners[target].neighbor)));
        if (directions_) wider = widening_between(to_side, at_side, length, bent_by);
        crossing = bent_crossing(across.share, bend, base_length, length - to_side);
        length = bent;
      }
      if (!comes_before({length, bent_by, false}, {found.distance, found.focusing, found.path.follows_edge()})) return;
      found.distance = std::min(length, found.distance);
      found.focusing = bent_by;
      found.is_new = true;
      if (!directions_) return;
      const Vec2 towards = crossing == across.share ? Vec2{cx, cy} : Vec2{crossing * base_length, 0};
      const auto [direction, difference] =
          direction_across(across, crossing, towards, base_length, own.direction, other.path.direction,
                           own.mirrored ? -side : side, bend, other.path.widening - own.widening);
      found.path.widening = static_cast<float>((1 - crossing) * own.widening + crossing * other.path.widening + wider);
      found.path.direction = direction;
      found.path.variance =
          static_cast<float>((1 - crossing) * own.variance + crossing * other.path.variance + difference * difference);
      found.path.arrival = {};
      found.path.last = {from, corners[base].neighbor};
      found.path.share = static_cast<float>(crossing);
    };
    unfold(k, right.length, next, left.length, 1);
    unfold(next, left.length, k, right.length, -1);
  }
  longest_ = std::max(longest_, longest);
  // The fronts of both points continue a few edges beyond the border between them, so that both can unfold up to it.
  for (std::size_t k = 0; k < degree; ++k) {
    if (!states_[k].is_new) continue;
    states_[k].path.mirrored = own.mirrored != corners[k].reflects;
    offer(corners[k].neighbor, point, states_[k].distance, 4 * longest, {}, states_[k].path, states_[k].focusing);
  }
}

/// Appends an entry to those of a vertex. The others may move to a larger block. @return number of the new entry
Index Wavefront::Impl::append(Index vertex) {
  Index& first = first_[vertex];
  const std::size_t count = entries_of(vertex).size();
  if (count == 0) {
    touched_.push_back(vertex);
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

/// Takes an unused block of entries, or makes one. @return number of its first entry
Index Wavefront::Impl::new_row(std::size_t size) {
  const std::size_t kind = std::bit_width(size) - 1;
  if (kind < free_.size() && !free_[kind].empty()) {
    const Index row = free_[kind].back();
    free_[kind].pop_back();
    return row;
  }
  const std::size_t row = entries_.size();
  if (row + size > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw ResourceExhausted("Wavefront: too many distances from several points; use fewer source points");
  entries_.resize(row + size);
  if (d_ != 2) displacements_.resize(entries_.size() * d_);
  if (directions_) paths_.resize(entries_.size());
  return static_cast<Index>(row);
}

/// Swaps two entries except `count`, which belongs to the block.
void Wavefront::Impl::swap_entries(Index a, Index b) {
  std::swap(entries_[a], entries_[b]);
  std::swap(entries_[a].count, entries_[b].count);
  if (directions_) std::swap(paths_[a], paths_[b]);
  if (d_ == 2) return;
  const auto of = [&](Index entry) { return displacements_.begin() + static_cast<std::ptrdiff_t>(entry * d_); };
  std::swap_ranges(of(a), of(a) + static_cast<std::ptrdiff_t>(d_), of(b));
}

/// Spreads the front from a vertex in other dimensions than 2: transports the displacement from the point along the edges.
void Wavefront::Impl::carry(Index from, Index point, double distance) {
  Scratch here(d_), left(d_), there(d_);
  std::ranges::copy(displacement(*find(from, point)), here.data());
  const std::size_t degree = graph_.star(from).degree();
  for (std::size_t e = 0; e < degree; ++e) {
    const Star star = graph_.star(from);  // again, because `factor_at` requests another star
    const Index to = star.neighbors[e];
    for (std::size_t a = 0; a < d_; ++a) left.data()[a] = here.data()[a] - star.log(e)[a];
    star.transport(e).apply_inverse(left.data(), there.data());
    const double slack = 2 * length(star.log(e)), straight = length(there.span());
    if (const Entry* known = find(to, point); known && known->distance <= straight) continue;
    offer(to, point, straight * factor_at(to, point, there.span(), distance), slack, there.span(), {});
  }
}

/// The factor u by which the path to a vertex is longer than the straight line, computed from the neighbors up to `distance`
/// (`eikonal_factor`).
double Wavefront::Impl::factor_at(Index vertex, Index point, std::span<const double> displacement, double distance) {
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

Wavefront::Wavefront(const TangentGraph& graph, std::shared_ptr<const OneRings> one_rings, bool directions)
    : impl_(std::make_unique<Impl>(graph, std::move(one_rings), directions)) {}
Wavefront::~Wavefront() = default;
Wavefront::Wavefront(Wavefront&&) noexcept = default;
Wavefront& Wavefront::operator=(Wavefront&&) noexcept = default;

Index Wavefront::add(const Source& source) { return impl_->add(source); }
Index Wavefront::points() const noexcept { return impl_->points_; }
const TangentGraph& Wavefront::graph() const noexcept { return impl_->graph_; }
bool Wavefront::has_directions() const noexcept { return impl_->directions_; }
void Wavefront::clear() { impl_->clear(); }
void Wavefront::restart(std::span<const Seed> seeds, std::function<bool(Vertex)> is_closed) {
  impl_->restart(seeds, std::move(is_closed));
}
void Wavefront::run(double radius, const StopToken& stop) { impl_->run(radius, stop); }
double Wavefront::next() const { return impl_->next(); }
std::vector<Vertex> Wavefront::reached() const { return impl_->reached(); }

double Wavefront::distance(Vertex vertex) const {
  const auto* const entry = impl_->nearest(vertex);
  return entry ? entry->distance * impl_->graph_.length_unit() : std::numeric_limits<double>::infinity();
}

Index Wavefront::nearest(Vertex vertex) const {
  const auto* const entry = impl_->nearest(vertex);
  return entry ? entry->point : -1;
}

Vec2 Wavefront::direction(Vertex vertex) const {
  const auto* const path = impl_->path(vertex);
  return path ? path->direction : Vec2{NAN, NAN};
}

double Wavefront::direction_error(Vertex vertex) const {
  // The two estimates of a direction lie on both sides of it, so the expected error is half of their difference
  // (docs/concepts/accuracy.md).
  constexpr double share_of_difference = 0.5;
  const auto* const path = impl_->path(vertex);
  return path ? share_of_difference * std::sqrt(path->variance) : NAN;
}

bool Wavefront::is_mirrored(Vertex vertex) const {
  const auto* const path = impl_->path(vertex);
  return path && path->mirrored;
}

Vec2 Wavefront::arrival(Vertex vertex) const {
  const auto* const path = impl_->path(vertex);
  if (!path) return {NAN, NAN};
  if (path->arrival != Vec2{}) return path->arrival;  // also if it is NaN
  const Star star = impl_->graph_.star(vertex.index);
  std::array<Vec2, 2> ends{};
  for (std::size_t k = 0; k < 2; ++k)
    if (const auto end = std::ranges::find(star.neighbors, path->last[k]); end != star.neighbors.end()) {
      const std::span<const double> log = star.log(static_cast<std::size_t>(end - star.neighbors.begin()));
      ends[k] = {log[0], log[1]};
    }
  const Vec2 crossing = (1.0 - path->share) * ends[0] + static_cast<double>(path->share) * ends[1];
  const double away = length(crossing);
  return (-1 / away) * crossing;
}

}  // namespace ahm
