#include "ahm/maps/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/maps/straight_line.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "heat/component_scales.hpp"
#include "maps/vector_quality.hpp"

namespace ahm {
namespace {

/// The radius of the front divided by the radius of the map. The front goes farther because its distances differ from those of the map.
constexpr double reach = 1.25;

/// phi relative to the start of the path: the source point, or for a curve the sample nearest to the vertex. n x d.
std::vector<double> vectors_from_source(const LogMap& map) {
  std::vector<double> vectors(map.coordinates().begin(), map.coordinates().end());
  const Source& source = map.source();
  if (!source.is_curve()) return vectors;
  std::vector<Vec2> starts;
  for (std::size_t k = 0; k < source.vertices().size(); ++k) {
    const auto [point, distance, position] = source.place(k);
    starts.resize(std::max(starts.size(), static_cast<std::size_t>(point) + 1));
    starts[point] = position;
  }
  for (std::size_t i = 0; i < map.status().size(); ++i)
    for (std::size_t a = 0; a < 2 && map.status()[i] == Status::ok; ++a)
      vectors[2 * i + a] -= starts[map.nearest()[i]][a];
  return vectors;
}

/// Geodesic polar coordinates of a vertex and their expected error, world units; NaN if there is no front with directions.
struct Polar {
  Vec2 psi;
  double error;
};

Polar polar_of(const LogMap& map, const Wavefront* front, Index vertex) {
  if (!map.directions().empty()) {
    const double d = map.distances()[vertex];
    return {d * Vec2{map.directions()[2 * vertex], map.directions()[2 * vertex + 1]},
            d * map.direction_errors()[vertex]};
  }
  if (front == nullptr || !front->has_directions()) return {{NAN, NAN}, NAN};
  const double d = std::min(front->distance(Vertex(vertex)), reach * map.radius());
  return {d * front->direction(Vertex(vertex)), d * front->direction_error(Vertex(vertex))};
}

/// Expected error of a vector by heat, world units.
double error_of_heat(const LogMap& map, const Wavefront* front, Index vertex, std::span<const double> phi, double d,
                     double h) {
  if (const auto [psi, error] = polar_of(map, front, vertex); !std::isnan(psi[0])) {
    const double apart = std::hypot(phi[0] - psi[0], phi[1] - psi[1]);
    if (!map.source().is_curve()) return std::hypot(apart, error);
    return std::max(0.0, std::hypot(apart, error) - (front == nullptr ? h / 4 : h));
  }
  const double off = std::abs(length(phi) - d);
  if (front == nullptr || map.dimension() == 2) return off;
  const double unfolded = std::min(front->distance(Vertex(vertex)), reach * map.radius());
  return std::max(off, std::abs(length(phi) - unfolded) - h);  // behind obstacles the front has errors up to h
}

void check_map(const TangentGraph& graph, const LogMap& map) {
  if (map.size() != graph.size() || map.dimension() != graph.dimension())
    throw InvalidArgument("map_quality: the map has " + detail::counted(map.size(), "vertex") + " and dimension " +
                          std::to_string(map.dimension()) + ", the graph " + detail::counted(graph.size(), "vertex") +
                          " and dimension " + std::to_string(graph.dimension()));
  if (map.source().is_curve() && (map.dimension() != 2 || map.nearest().size() != map.status().size()))
    throw InvalidArgument("map_quality: a map from a curve must have dimension 2 and contain the nearest samples");
  if (map.spread().empty())
    throw InvalidArgument("map_without_spread", "the map has no spread", "solve with MapOptions::spread");
}

std::vector<double> quality_beside(const TangentGraph& graph, const LogMap& map, const Wavefront* front,
                                   unsigned threads) {
  std::vector<double> quality(static_cast<std::size_t>(graph.size()), std::numeric_limits<double>::quiet_NaN());
  const ComponentScales scales(graph);
  const std::vector<double> vectors = vectors_from_source(map);
  const auto dimension = static_cast<std::size_t>(map.dimension());
  // Distances by heat may be shorter than the straight line; unfolded distances rarely are.
  const bool may_be_short = map.method() == Method::heat && !graph.is_delaunay();
  const std::optional<Vec3> source = may_be_short ? source_position(graph, map.source()) : std::nullopt;
  detail::for_each_index(quality.size(), threads, [&](std::size_t i) {
    if (map.status()[i] != Status::ok) return;
    const Vertex vertex(static_cast<Index>(i));
    const double h = scales.h(vertex.index) * graph.length_unit();
    double d = map.distances()[i];
    if (const auto frame = source ? graph.frame(vertex.index) : std::nullopt)
      d = std::max(d, distance(frame->origin, *source));
    const auto error = [&] {
      if (map.method() == Method::exact) return 0.0;
      if (map.method() == Method::polar) return map.error_estimate()[i];
      return error_of_heat(map, front, vertex.index, std::span(vectors).subspan(i * dimension, dimension), d, h);
    };
    quality[i] = quality_of(graph, vertex, error(), map.spread()[i], d, h);
  });
  return quality;
}

}  // namespace

std::optional<double> reliable_distance(std::span<const double> distances, std::span<const double> quality) {
  constexpr std::size_t least_entries = 20, share = 20;  // one of 20 may have a lower quality
  if (distances.size() != quality.size())
    throw InvalidArgument("reliable_distance: there are " + detail::counted(distances.size(), "distance") + ", but " +
                          std::to_string(quality.size()) + " qualities");
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (!std::isnan(distances[i]) && !std::isnan(quality[i])) order.push_back(i);
  std::ranges::sort(order, {}, [&](std::size_t i) { return distances[i]; });
  std::optional<double> reliable;
  for (std::size_t k = 0, low = 0; k < order.size(); ++k) {
    low += quality[order[k]] < reliable_quality ? 1 : 0;
    const bool is_last_at_distance = k + 1 == order.size() || distances[order[k]] < distances[order[k + 1]];
    if (is_last_at_distance && share * low <= k + 1 && (k + 1 >= least_entries || k + 1 == order.size()))
      reliable = distances[order[k]];
  }
  return reliable;
}

ReferenceFront::ReferenceFront(const TangentGraph& graph, const Source& source, double radius, const StopToken& stop) {
  if (graph.is_delaunay()) return;
  front_.emplace(graph, Wavefront::one_rings_within(graph, radius), true);
  front_->add(source);
  front_->run(reach * radius, stop);
}

std::vector<double> map_quality(const TangentGraph& graph, const LogMap& map, const ReferenceFront& front,
                                unsigned threads) {
  check_map(graph, map);
  return quality_beside(graph, map, front.get(), threads);
}

std::vector<double> map_quality(const TangentGraph& graph, const LogMap& map, unsigned threads) {
  check_map(graph, map);
  if (map.method() != Method::heat) return quality_beside(graph, map, nullptr, threads);
  return map_quality(graph, map, ReferenceFront(graph, map.source(), map.radius()), threads);
}

}  // namespace ahm
