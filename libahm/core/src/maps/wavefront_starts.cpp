// Starts of a front: at sources, and at vertices with known distances and directions.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "ahm/util/scratch.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "maps/affine_heat.hpp"
#include "maps/front_geometry.hpp"
#include "maps/wavefront_impl.hpp"

namespace ahm {
namespace {

Vec2 unit_vector(const Vec2& v) {
  const double size = length(v);
  return {v[0] / size, v[1] / size};  // NaN for the zero vector
}

}  // namespace

Index Wavefront::Impl::add(const Source& source) {
  check_source(source, graph_);
  const double unit = graph_.length_unit();
  const Index first = points_;
  of_curve_ = of_curve_ || source.is_curve();
  const bool may_reflect = graph_.transport_layout().may_reflect();
  std::vector<NearVertex> given;
  Scratch offset(d_), back(d_);
  for (std::size_t k = 0; k < source.vertices().size(); ++k) {
    if (!(source.weights()[k] > 0)) continue;
    const auto [point, away, position] = source.place(k);
    points_ = std::max(points_, first + point + 1);
    const std::span<const double> axes =
        source.axes().empty() ? source.axes() : source.axes().subspan(k * d_ * d_, d_ * d_);
    for (std::size_t c = 0; c < d_; ++c) {
      const double start = d_ == 2 ? position[c] : 0;
      offset.data()[c] = source.offsets().empty() ? 0 : (source.offsets()[k * d_ + c] - start) / unit;
      back.data()[c] = 0;
    }
    for (std::size_t c = 0; c < d_; ++c)
      for (std::size_t a = 0; a < d_ && !source.offsets().empty(); ++a)
        back.data()[c] -= axes[c * d_ + a] * offset.data()[a];
    const Index vertex = source.vertices()[k].index;
    if (d_ != 2) {
      offer(vertex, first + point, away / unit, 0, back.span(), {});
      continue;
    }
    const bool mirrored = !axes.empty() && axes[0] * axes[3] < axes[1] * axes[2];
    given.push_back({vertex,
                     first + point,
                     away / unit,
                     {offset.data()[0], offset.data()[1]},
                     unit_vector({-back.data()[0], -back.data()[1]}),
                     mirrored});
    const auto is_of_point = [&, point = point](std::size_t other) {
      return other < source.vertices().size() && source.place(other).point == point;
    };
    const bool beside = away != 0 && !is_of_point(k - 1) && !is_of_point(k + 1);
    const Star star = graph_.star(vertex);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const double side = length(star.log(e));
      longest_ = std::max(longest_, side);
      // If the point has only one vertex, or the vertex is at the point, the neighbors have known positions in its tangent plane, too.
      if (!(beside || away / unit <= least_ray * side)) continue;
      const Vec2 from{star.log(e)[0] - back.data()[0], star.log(e)[1] - back.data()[1]};
      const Vec2 there =
          axes.empty() ? from : Vec2{axes[0] * from[0] + axes[2] * from[1], axes[1] * from[0] + axes[3] * from[1]};
      Vec2 arrival{};
      star.transport(e).apply_inverse(from.data(), arrival.data());
      given.push_back({star.neighbors[e], first + point, std::hypot(from[0], from[1]), there, unit_vector(arrival),
                       mirrored != (may_reflect && star.transport(e).reflects())});
    }
  }
  // Also if another point is nearer by up to 4 edge lengths: from there the front reaches this point's side of the border.
  for (const NearVertex& one : given)
    offer(one.vertex, one.point, one.distance, 4 * longest_, {},
          {.direction = unit_vector(one.offset), .arrival = one.arrival, .mirrored = one.mirrored});
  if (one_rings_) offer_midpoints(given);
  return first;
}

/// Offers distances to the midpoints of the edges whose both ends are near a point. The distance from the point to the midpoint is
/// the length of a median of the triangle of the point and the two ends.
void Wavefront::Impl::offer_midpoints(std::vector<NearVertex>& given) {
  const auto comes_before = [](const NearVertex& a, const NearVertex& b) {
    return std::tie(a.point, a.vertex) < std::tie(b.point, b.vertex);
  };
  std::sort(given.begin(), given.end(), comes_before);
  std::vector<OneRings::CutEdge> edges;
  for (const NearVertex& one : given) {
    one_rings_->find_cut_edges(one.vertex, edges);
    for (const auto& edge : edges) {
      if (edge.end <= one.vertex) continue;
      NearVertex end = one;
      end.vertex = edge.end;
      const auto [first, last] = std::equal_range(given.begin(), given.end(), end, comes_before);
      for (auto other = first; other != last; ++other) {
        const double a = one.distance, b = other->distance;
        const double squared = 0.5 * (a * a + b * b) - edge.half * edge.half;
        const Vec2 between{one.offset[0] + other->offset[0], one.offset[1] + other->offset[1]};
        offer(edge.midpoint, one.point, std::sqrt(std::max(0.0, squared)), 4 * longest_, {},
              {.direction = unit_vector(between), .mirrored = one.mirrored});
      }
    }
  }
}

void Wavefront::Impl::restart(std::span<const Seed> seeds, std::function<bool(Vertex)> is_closed) {
  struct Start {
    double focusing = 0;
    float widening = 0;
  };
  std::vector<Start> starts;
  starts.reserve(seeds.size());
  struct Neighboring {
    Index vertex;
    Entry entry;
    Path path;
  };
  std::vector<Neighboring> beside_point;  // a seed at its point has no direction that its neighbors could take over
  for (const Seed& seed : seeds) {
    const Entry* const found = find(seed.vertex.index, seed.point);
    starts.push_back(found ? Start{found->focusing, paths_[number(*found)].widening} : Start{});
    if (!std::isnan(seed.direction[0])) continue;
    for (const Corner& corner : one_ring(seed.vertex.index))
      if (const Entry* const next = find(corner.neighbor, seed.point))
        beside_point.push_back({corner.neighbor, *next, paths_[number(*next)]});
  }
  forget();
  is_closed_ = nullptr;
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    const Index vertex = seeds[k].vertex.index;
    offer(vertex, seeds[k].point, seeds[k].distance / graph_.length_unit(), 0, {},
          {.direction = seeds[k].direction,
           .arrival = seeds[k].arrival,
           .variance = static_cast<float>(4 * seeds[k].error * seeds[k].error),
           .widening = starts[k].widening,
           .mirrored = seeds[k].mirrored},
          starts[k].focusing);
    entries_[first_[vertex]].gains = most_gains;  // prevents improvements
  }
  // Only seeds with a neighbor that is not a seed need to spread.
  queue_.clear();
  longest_ = 0;
  is_closed_ = std::move(is_closed);
  const auto is_free = [&](const Corner& corner) {
    return first_[corner.neighbor] == none && !(is_closed_ && is_closed_(Vertex(corner.neighbor)));
  };
  for (const Seed& seed : seeds) {
    const Index vertex = seed.vertex.index;
    const std::span<const Corner> ring = one_ring(vertex);
    if (std::ranges::none_of(ring, is_free)) continue;
    queue_.push({entries_[first_[vertex]].distance, vertex, seed.point});
    for (const Corner& corner : ring) longest_ = std::max(longest_, corner.length);
  }
  for (const auto& [vertex, entry, path] : beside_point)
    if (first_[vertex] == none) offer(vertex, entry.point, entry.distance, 0, {}, path, entry.focusing);
}

}  // namespace ahm
