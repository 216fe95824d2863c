#include "ahm/maps/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "ahm/error.hpp"
#include "ahm/graph/mean_edge.hpp"
#include "ahm/maps/place_in_space.hpp"
#include "ahm/maps/unfolding_front.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "heat/component_scales.hpp"

namespace ahm {
namespace {

/// What a spread and a difference come to, relative to the distance, where no more than every second vector is right.
constexpr double doubtful_spread = 0.3, doubtful_difference = 0.1;
/// Where ways of heat spread by less than this share of the distance they come along lines, and phi is the unrolling of what
/// they pass: a plane behind its holes. There its length is asked for and its direction is not.
constexpr double unrolled_spread = 0.01;
/// Where as much of the lengths of edges is lost a map is no longer one of the neighbourhood.
constexpr double doubtful_loss = 0.5;
/// In mean edge lengths, by which fronts over edges that are no triangulation may be off, and the share of edges that maps lose
/// beside them all the same.
constexpr double forgiven = 1, forgiven_loss = 0.2;
/// Likewise, from curves on triangulations: what lies between samples half an edge apart is known to half of that.
constexpr double forgiven_between_samples = 0.25;
/// Of the triangles that vertices see around them, the shares that the others must see, too, for a front to count at all
/// and in full: with noise every vertex sees triangles of its own.
constexpr double believed_from = 0.7, believed_in_full = 0.8;
/// Of the stars, the shares that are open, as at boundaries, for the directions of ways that bend there to count not at all and in
/// full: noise and few neighbours open stars anywhere, and bend ways that go straight.
constexpr double bent_to = 0.1, bent_in_full = 0.05;
/// As many vertices are asked for both.
constexpr std::size_t asked = 1000;
/// A vertex of a map that ends at a radius is nearer than this many radii for the front, or else the two differ by far.
constexpr double reach = 1.25;

/// How far a way is from geodesic polar coordinates, as far as these count and its spread, relative to the distance d, is not that
/// of an unrolling; else how far its length is from d.
double disagreement(std::span<const double> way, double d, const Vec2& polar, double spread, double counts = 1) {
  const double by_length = std::abs(length(way) - d);
  if (std::isnan(polar[0])) return by_length;
  const double by_vector = length(Vec2{way[0] - polar[0], way[1] - polar[1]});
  return by_length + counts * std::min(spread / unrolled_spread, 1.0) * std::max(0.0, by_vector - by_length);
}

/// phi from where the ways to the vertices begin: at a point itself, along a curve at its sample nearest to the vertex. n x d.
std::vector<double> ways_of(const LogMap& map) {
  std::vector<double> ways(map.coordinates().begin(), map.coordinates().end());
  const Source& source = map.source();
  if (!source.is_curve()) return ways;
  std::vector<Vec2> starts;
  for (std::size_t k = 0; k < source.vertices().size(); ++k) {
    const auto [point, distance, position] = source.place(k);
    starts.resize(std::max(starts.size(), static_cast<std::size_t>(point) + 1));
    starts[point] = position;
  }
  for (std::size_t i = 0; i < map.status().size(); ++i)
    for (std::size_t a = 0; a < 2 && map.status()[i] == Status::ok; ++a) ways[2 * i + a] -= starts[map.nearest()[i]][a];
  return ways;
}

/// The vectors of a front over edges that are no triangulation, beside those of a map.
class Comparison {
 public:
  Comparison(const TangentGraph& graph, const LogMap& map, const UnfoldingFront& front)
      : front_(front), radius_(map.radius()) {
    std::vector<Vertex> reached, some;
    for (Index i = 0; i < graph.size(); ++i)
      if (map.status()[i] == Status::ok) reached.emplace_back(i);
    for (std::size_t k = 0; k < reached.size(); k += reached.size() / asked + 1) some.push_back(reached[k]);
    const auto [agreed, open] = UnfoldingFront::agreement(graph, some);
    belief_ = std::clamp((agreed - believed_from) / (believed_in_full - believed_from), 0.0, 1.0);
    belief_in_bends_ = std::clamp((bent_to - open) / (bent_to - bent_in_full), 0.0, 1.0);
    if (!front.has_directions() || reached.empty()) return;
    const auto bent = std::ranges::count_if(reached, [&](Vertex vertex) { return front.is_bent(vertex); });
    const double share = static_cast<double>(bent) / static_cast<double>(reached.size());
    directions_compared_ = belief_ * (1 - share * (1 - belief_in_bends_));
  }

  /// How far a way is off by what the front says, world units. @param spread  relative to the distance
  double off(Vertex vertex, std::span<const double> way, double spread, double h) const {
    const double d = std::min(front_.distance(vertex), reach * radius_);
    const double counts = front_.is_bent(vertex) ? belief_in_bends_ : 1;
    return belief_ * disagreement(way, d, polar(vertex, d), spread, counts) - forgiven * h;
  }

  /// Geodesic polar coordinates; NaN where the way bends at the boundary.
  Vec2 polar_coordinates(Vertex vertex) const {
    return front_.is_bent(vertex) ? Vec2{NAN, NAN} : polar(vertex, front_.distance(vertex));
  }
  double belief() const { return belief_; }
  double directions_compared() const { return directions_compared_; }

 private:
  Vec2 polar(Vertex vertex, double d) const {
    const Vec2 direction = front_.direction(vertex);
    return {d * direction[0], d * direction[1]};
  }

  const UnfoldingFront& front_;
  double radius_;
  double belief_ = 0, belief_in_bends_ = 0;  ///< in what the front says, and in its directions behind bends
  double directions_compared_ = 1;
};

/// Geodesic polar coordinates, from where the way begins, as a map on a Delaunay triangulation has them; NaN on other graphs.
Vec2 polar_coordinates(const LogMap& map, Index vertex) {
  if (map.directions().empty()) return {NAN, NAN};
  const double d = map.distances()[vertex];
  return {d * map.directions()[2 * vertex], d * map.directions()[2 * vertex + 1]};
}

/// How much of the edges of a vertex a map loses that geodesic polar coordinates keep: root mean squares over that of the edges,
/// the lesser one of what is lost of their lengths and of how unlike both change along them; 0 where nothing is known.
/// @param polar  polar(j): geodesic polar coordinates; NaN: unknown
template <class Polar>
double lost_along_edges(const TangentGraph& graph, const LogMap& map, Index vertex, const Polar& polar) {
  const Vec2 psi = polar(vertex);
  if (std::isnan(psi[0])) return 0;
  const Star star = graph.star(vertex);
  const std::span<const double> phi = map.coordinates(Vertex(vertex));
  const double unit = graph.length_unit();
  double off = 0, all = 0, kept = 0, edges = 0;
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const Index j = star.neighbors[e];
    const Vec2 psi_j = polar(j);
    if (map.status()[j] != Status::ok || std::isnan(psi_j[0])) continue;
    const std::span<const double> phi_j = map.coordinates(Vertex(j));
    const Vec2 by_psi{psi_j[0] - psi[0], psi_j[1] - psi[1]};
    const Vec2 by_phi{phi_j[0] - phi[0], phi_j[1] - phi[1]};
    const double edge = length(star.log(e)), longest = std::max(edge, length(by_psi) / unit),
                 difference = length(Vec2{by_phi[0] - by_psi[0], by_phi[1] - by_psi[1]}) / unit,
                 by_map = length(by_phi) / unit;
    off += difference * difference;
    all += longest * longest;
    kept += by_map * by_map;
    edges += edge * edge;
  }
  return all > 0 ? std::sqrt(std::clamp(1 - kept / edges, 0.0, off / all)) : 0;
}

/// Of what fronts over edges that are no triangulation say is lost, since neighbours of theirs differ by more than edges do.
double forgiving(double lost) { return std::max(0.0, lost - forgiven_loss) / (1 - forgiven_loss); }

void check_map(const TangentGraph& graph, const LogMap& map) {
  if (map.size() != graph.size() || map.dimension() != graph.dimension())
    throw InvalidArgument("map_quality: the map has " + std::to_string(map.size()) + " vertices, the graph " +
                          std::to_string(graph.size()));
  if (map.source().is_curve() && (map.dimension() != 2 || map.nearest().size() != map.status().size()))
    throw InvalidArgument("a map from a curve has a quality where its dimension is 2 and it knows the nearest samples");
  if (map.spread().empty())
    throw InvalidArgument("map_without_spread", "the map has no spread", "solve with MapOptions::spread");
}

std::vector<double> quality_beside(const TangentGraph& graph, const LogMap& map, const Comparison* comparison,
                                   unsigned threads) {
  std::vector<double> quality(static_cast<std::size_t>(graph.size()), std::numeric_limits<double>::quiet_NaN());
  const ComponentScales scales(graph);
  const std::vector<double> ways = ways_of(map);
  const auto dimension = static_cast<std::size_t>(map.dimension());
  const bool of_curve = map.source().is_curve();
  // Distances of heat may be below the straight line; unfolded ones hardly are.
  const bool may_be_short = map.method() == Method::heat && !graph.is_delaunay();
  const std::optional<Vec3> source = may_be_short ? place_in_space(graph, map.source()) : std::nullopt;
  detail::for_each_index(quality.size(), threads, [&](std::size_t i) {
    if (map.status()[i] != Status::ok) return;
    const Vertex vertex(static_cast<Index>(i));
    const std::span<const double> way = std::span(ways).subspan(i * dimension, dimension);
    const double h = scales.h(vertex.index) * graph.length_unit();
    double d = map.distances()[i];
    if (const auto frame = source ? graph.frame(vertex.index) : std::nullopt)
      d = std::max(d, distance(frame->origin, *source));
    const double away = std::max(d, std::min(h, mean_edge(graph, std::span(&vertex, 1)))),
                 spread = map.spread()[i] / away;
    const Vec2 psi = polar_coordinates(map, vertex.index);
    double off = disagreement(way, d, psi, spread), lost = 0;
    if (of_curve) {  // along curves psi jumps from sample to sample
      off = std::max(0.0, off - forgiven_between_samples * h);
    } else if (!std::isnan(psi[0])) {
      lost = lost_along_edges(graph, map, vertex.index, [&](Index j) { return polar_coordinates(map, j); });
    } else if (comparison && comparison->belief() > 0) {
      lost = comparison->belief() * forgiving(lost_along_edges(graph, map, vertex.index, [&](Index j) {
               return comparison->polar_coordinates(Vertex(j));
             }));
    }
    if (comparison) off = std::max(off, comparison->off(vertex, way, spread, h));
    const double doubt = std::hypot(spread / doubtful_spread, off / away / doubtful_difference, lost / doubtful_loss);
    quality[i] = 1 / (1 + doubt * doubt);
  });
  return quality;
}

}  // namespace

QualityFront::QualityFront(const TangentGraph& graph, const Source& source, double radius,
                           const std::stop_token& stop) {
  if (graph.is_delaunay()) return;
  front_.emplace(graph, nullptr, true);
  front_->add(source);
  front_->run(reach * radius, stop);
}

ComparedQuality map_quality(const TangentGraph& graph, const LogMap& map, const QualityFront& front, unsigned threads) {
  check_map(graph, map);
  if (map.method() != Method::heat || !front.get()) return {quality_beside(graph, map, nullptr, threads)};
  const Comparison comparison(graph, map, *front.get());
  return {quality_beside(graph, map, &comparison, threads), comparison.directions_compared()};
}

std::vector<double> map_quality(const TangentGraph& graph, const LogMap& map, unsigned threads) {
  check_map(graph, map);
  if (map.method() != Method::heat) return quality_beside(graph, map, nullptr, threads);
  return map_quality(graph, map, QualityFront(graph, map.source(), map.radius()), threads).quality;
}

}  // namespace ahm
