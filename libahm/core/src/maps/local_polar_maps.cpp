#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/straight_line.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/mutex.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/vec.hpp"
#include "maps/affine_heat.hpp"
#include "maps/carried_axes.hpp"
#include "maps/local_map_parts.hpp"
#include "maps/vector_quality.hpp"

namespace ahm {
namespace {

void check_points(const TangentGraph& graph, std::span<const Source> sources, const LocalMapOptions& options) {
  check_extent(options);
  if (graph.dimension() != 2)
    throw InvalidArgument(
        "dimension_not_2",
        "local polar maps need a graph of dimension 2; this one has dimension " + std::to_string(graph.dimension()),
        "use local_maps");
  for (const Source& source : sources) {
    check_source(source, graph);
    if (source.is_curve())
      throw InvalidArgument("source_is_curve", "local polar maps: a source is a curve; polar maps require points",
                            "use the heat method");
  }
}

/// Collects the entries of one source after the other.
class Collector {
 public:
  Collector(const TangentGraph& graph, std::span<const Source> sources, const LocalMapOptions& options,
            LocalFront front)
      : graph_(graph), sources_(sources), options_(options), front_(std::move(front)), ball_(graph) {}

  /// Appends the entries of source s, nearest first.
  void collect(std::size_t s, LocalEntries& entries) {
    const Wavefront& front = find(s);
    // The front is final up to the farthest neighbor.
    double farthest = 0;
    for (const auto& [distance, vertex] : order_) farthest = std::max(farthest, front.distance(Vertex(vertex)));
    for (const auto& [distance, vertex] : order_) {
      const Vertex v(vertex);
      if (options_.quality) entries.quality.push_back(quality(front, v, distance, farthest));
      entries.vertices.push_back(v);
      entries.distances.push_back(distance);
      const Vec2 log = coordinates(front, v);
      entries.logs.insert(entries.logs.end(), log.begin(), log.end());
      const std::array<double, 4> U = transport(front, sources_[s], v);
      if (graph_.transport_kind() == TransportKind::rotation2)
        entries.transports.insert(entries.transports.end(), {U[0], U[2]});
      else
        entries.transports.insert(entries.transports.end(), U.begin(), U.end());
    }
  }

 private:
  /// Finds the neighbors of source s: fills `order_`.
  const Wavefront& find(std::size_t s) {
    // Distances on clouds may exceed the length of the edge path. Then the radius grows, after some steps to infinity.
    constexpr double growth = 1.3, largest_growth = 10;
    const bool by_number = options_.radius == 0;
    double radius = options_.radius, least = 0;
    if (by_number) {
      const NearestRadius nearest = radius_of_nearest(graph_, ball_, sources_[s], options_.k);
      least = nearest.radius * (1 + 1e-12);
      radius = nearest.is_complete ? std::numeric_limits<double>::infinity() : least;
    }
    while (true) {
      const Wavefront& front = front_(s, radius);
      order_within(front, s, radius);
      const bool all = !by_number || std::isinf(radius) || std::ssize(order_) >= options_.k;
      if (all) {
        if (options_.k > 0 && std::ssize(order_) > options_.k) order_.resize(static_cast<std::size_t>(options_.k));
        return front;
      }
      radius = radius < largest_growth * least ? growth * radius : std::numeric_limits<double>::infinity();
    }
  }

  /// Sorts the vertices within the radius by distance.
  void order_within(const Wavefront& front, std::size_t s, double radius) {
    const auto start =
        options_.bound_by_straight_line ? straight_line_origin(graph_, sources_[s]) : std::optional<Vec3>();
    order_.clear();
    for (const Vertex v : front.reached()) {
      double distance = front.distance(v);
      if (!(distance <= radius)) continue;
      if (start)
        if (const auto frame = graph_.frame(v.index))
          distance = bounded_distance(ahm::distance(frame->origin, *start), distance);
      const Vec2 log = coordinates(front, v);
      if (distance <= radius && std::isfinite(log[0]) && std::isfinite(log[1])) order_.emplace_back(distance, v.index);
    }
    std::sort(order_.begin(), order_.end());
  }

  /// @param farthest  the map contains the vertices up to this distance on the front
  double quality(const Wavefront& front, Vertex v, double distance, double farthest) const {
    const Vec2 here = coordinates(front, v);
    const auto length_in_map = [&](Index j) {
      return front.distance(Vertex(j)) <= farthest ? length(coordinates(front, Vertex(j)) - here)
                                                   : std::numeric_limits<double>::quiet_NaN();
    };
    const double error = distance > 0 ? distance * front.direction_error(v) : 0;
    const double h = graph_.length_unit() * graph_.mean_edge_length();
    return quality_of(graph_, v, std::isfinite(error) ? error : 0, jump_at(graph_, v.index, length_in_map), distance,
                      h);
  }

  static Vec2 coordinates(const Wavefront& front, Vertex v) {
    const double distance = front.distance(v);
    return distance > 0 ? distance * front.direction(v) : Vec2{};
  }

  /// The source's axes at a vertex, as `polar_map`.
  static std::array<double, 4> transport(const Wavefront& front, const Source& source, Vertex v) {
    const Vec2 departure = front.direction(v), arrival = front.arrival(v);
    if (!std::isnan(arrival[0]) && !std::isnan(departure[0]))
      return carried_axes(departure, arrival, front.is_mirrored(v));
    std::array<double, 4> axes{1, 0, 0, 1};
    for (std::size_t k = 0; k < source.vertices().size() && !source.axes().empty(); ++k)
      if (source.vertices()[k] == v) std::ranges::copy(source.axes().subspan(4 * k, 4), axes.begin());
    return axes;
  }

  const TangentGraph& graph_;
  std::span<const Source> sources_;
  const LocalMapOptions& options_;
  LocalFront front_;
  Ball ball_;
  std::vector<std::pair<double, Index>> order_;  ///< distance and number of the neighbors, nearest first
};

}  // namespace

LocalMaps local_polar_maps(const TangentGraph& graph, std::span<const Source> sources, const LocalMapOptions& options,
                           const std::function<LocalFront()>& make_front) {
  return detail::with_memory_check("computing local maps", [&] {
    check_points(graph, sources, options);
    Ball ball(graph);
    const auto radius = [&](std::size_t s) {
      return options.radius > 0 ? options.radius : radius_of_nearest(graph, ball, sources[s], options.k).radius;
    };
    check_memory(graph, sources, radius, options);
    constexpr Offset chunk = 64;
    const auto n = static_cast<Offset>(sources.size());
    std::vector<Offset> indptr(sources.size() + 1, 0);
    std::vector<LocalEntries> chunks(static_cast<std::size_t>((n + chunk - 1) / chunk));
    detail::Mutex mutex;
    std::vector<std::unique_ptr<Collector>> idle;
    Offset done = 0;
    detail::parallel_chunks(n, chunk, options.heat.threads, [&](Offset begin, Offset end) {
      std::unique_ptr<Collector> collector;
      {
        const detail::Lock lock(mutex);
        if (!idle.empty()) collector = std::move(idle.back()), idle.pop_back();
      }
      if (!collector) collector = std::make_unique<Collector>(graph, sources, options, make_front());
      LocalEntries& entries = chunks[static_cast<std::size_t>(begin / chunk)];
      for (Offset s = begin; s < end; ++s) {
        const std::size_t before = entries.vertices.size();
        collector->collect(static_cast<std::size_t>(s), entries);
        indptr[static_cast<std::size_t>(s) + 1] = static_cast<Offset>(entries.vertices.size() - before);
      }
      entries.vertices.shrink_to_fit(), entries.distances.shrink_to_fit();
      entries.logs.shrink_to_fit(), entries.transports.shrink_to_fit(), entries.quality.shrink_to_fit();
      const detail::Lock lock(mutex);
      idle.push_back(std::move(collector));
      done += end - begin;
      options.heat.progress.step("solve", static_cast<double>(done) / static_cast<double>(n));
    });
    idle.clear();
    for (std::size_t s = 0; s < sources.size(); ++s) indptr[s + 1] += indptr[s];
    return joined(graph, std::move(indptr), chunks, options.heat.threads);
  });
}

}  // namespace ahm
