#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <compare>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
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
            LocalPolarCoordinates coordinates)
      : graph_(graph), sources_(sources), options_(options), coordinates_(std::move(coordinates)), ball_(graph) {
    if (options.quality) places_.emplace(static_cast<std::size_t>(graph.size()));
  }

  /// Appends the entries of source s, nearest first.
  void collect(std::size_t s, LocalEntries& entries) {
    const std::span<const Wavefront::Seed> vertices = find(s);
    if (options_.quality) add_quality(vertices, entries);
    for (const Neighbor& neighbor : order_) {
      const Wavefront::Seed& vertex = vertices[neighbor.place];
      entries.vertices.push_back(vertex.vertex);
      entries.distances.push_back(neighbor.distance);
      const Vec2 log = log_of(vertex);
      entries.logs.insert(entries.logs.end(), log.begin(), log.end());
      const std::array<double, 4> U = transport(sources_[s], vertex);
      if (graph_.transport_kind() == TransportKind::rotation2)
        entries.transports.insert(entries.transports.end(), {U[0], U[2]});
      else
        entries.transports.insert(entries.transports.end(), U.begin(), U.end());
    }
  }

 private:
  struct Neighbor {
    double distance;
    Index vertex;
    std::size_t place;  ///< in the polar coordinates
    auto operator<=>(const Neighbor&) const = default;
  };

  /// Finds the neighbors of source s: fills `order_`. @return the polar coordinates around the source
  std::span<const Wavefront::Seed> find(std::size_t s) {
    // Distances on clouds may exceed the length of the edge path. Then the radius grows, after some steps to infinity.
    constexpr double growth = 1.3, largest_growth = 10;
    const bool by_number = options_.radius == 0;
    double radius = options_.radius, least = 0;
    Index enough = options_.is_neighbor ? 0 : options_.k;
    if (by_number) {
      const NearestRadius nearest = radius_of_nearest(graph_, ball_, sources_[s], options_);
      least = nearest.radius * (1 + 1e-12);
      radius = nearest.is_complete ? std::numeric_limits<double>::infinity() : least;
      // Among as many vertices along geodesic paths there may be some neighbors less than along edge paths.
      if (options_.is_neighbor) enough = nearest.vertices + nearest.vertices / 4;
    }
    while (true) {
      const PolarNeighbors around = coordinates_(s, radius, enough);
      order_within(around.vertices, s, std::min(radius, around.horizon));
      if (options_.k > 0 && std::ssize(order_) >= options_.k) {
        order_.resize(static_cast<std::size_t>(options_.k));
        farthest_ = 0;
        for (const Neighbor& neighbor : order_)
          farthest_ = std::max(farthest_, around.vertices[neighbor.place].distance);
        return around.vertices;
      }
      if (around.horizon < radius)
        enough = 0;  // distances were increased to that of the straight line
      else if (!by_number || std::isinf(radius))
        return around.vertices;
      else
        radius = radius < largest_growth * least ? growth * radius : std::numeric_limits<double>::infinity();
    }
  }

  /// Sorts the vertices within the radius by distance.
  void order_within(std::span<const Wavefront::Seed> vertices, std::size_t s, double radius) {
    const auto start =
        options_.bound_by_straight_line ? straight_line_origin(graph_, sources_[s]) : std::optional<Vec3>();
    order_.clear();
    farthest_ = 0;
    for (std::size_t place = 0; place < vertices.size(); ++place) {
      const Wavefront::Seed& vertex = vertices[place];
      double distance = vertex.distance;
      if (!(distance <= radius)) continue;
      if (start)
        if (const auto frame = graph_.frame(vertex.vertex.index))
          distance = bounded_distance(ahm::distance(frame->origin, *start), distance);
      const Vec2 log = log_of(vertex);
      if (!(distance <= radius) || !std::isfinite(log[0]) || !std::isfinite(log[1])) continue;
      farthest_ = std::max(farthest_, vertex.distance);
      if (is_neighbor(options_, vertex.vertex.index)) order_.push_back({distance, vertex.vertex.index, place});
    }
    std::sort(order_.begin(), order_.end());
  }

  /// Adds the quality of the neighbors in `order_`.
  void add_quality(std::span<const Wavefront::Seed> vertices, LocalEntries& entries) {
    for (std::size_t place = 0; place < vertices.size(); ++place)
      if (vertices[place].distance <= farthest_)
        (*places_)[vertices[place].vertex.index] = static_cast<Index>(place + 1);
    const double h = graph_.length_unit() * graph_.mean_edge_length();
    for (const Neighbor& neighbor : order_) {
      const Wavefront::Seed& vertex = vertices[neighbor.place];
      const Vec2 here = log_of(vertex);
      const auto length_in_map = [&](Index j) {
        const Index place = (*places_)[j];
        return place > 0 ? length(log_of(vertices[to_size(place - 1)]) - here)
                         : std::numeric_limits<double>::quiet_NaN();
      };
      const double error = neighbor.distance > 0 ? neighbor.distance * vertex.error : 0;
      entries.quality.push_back(quality_of(graph_, vertex.vertex, std::isfinite(error) ? error : 0,
                                           jump_at(graph_, vertex.vertex.index, length_in_map), neighbor.distance, h));
    }
    for (const Wavefront::Seed& vertex : vertices) (*places_)[vertex.vertex.index] = 0;
  }

  static Vec2 log_of(const Wavefront::Seed& vertex) {
    return vertex.distance > 0 ? vertex.distance * vertex.direction : Vec2{};
  }

  /// The source's axes at a vertex, as `polar_map`.
  static std::array<double, 4> transport(const Source& source, const Wavefront::Seed& vertex) {
    if (!std::isnan(vertex.arrival[0]) && !std::isnan(vertex.direction[0]))
      return carried_axes(vertex.direction, vertex.arrival, vertex.mirrored);
    std::array<double, 4> axes{1, 0, 0, 1};
    for (std::size_t k = 0; k < source.vertices().size() && !source.axes().empty(); ++k)
      if (source.vertices()[k] == vertex.vertex) std::ranges::copy(source.axes().subspan(4 * k, 4), axes.begin());
    return axes;
  }

  const TangentGraph& graph_;
  std::span<const Source> sources_;
  const LocalMapOptions& options_;
  LocalPolarCoordinates coordinates_;
  Ball ball_;
  std::vector<Neighbor> order_;               ///< the neighbors, nearest first
  double farthest_ = 0;                       ///< the map contains the vertices up to this distance, neighbors or not
  std::optional<SparseArray<Index>> places_;  ///< 1 + place of each vertex in the polar coordinates; 0: not in the map
};

}  // namespace

LocalMaps local_polar_maps(const TangentGraph& graph, std::span<const Source> sources, const LocalMapOptions& options,
                           const std::function<LocalPolarCoordinates()>& make_coordinates) {
  return detail::with_memory_check("computing local maps", [&] {
    check_points(graph, sources, options);
    Ball ball(graph);
    const auto radius = [&](std::size_t s) {
      return options.radius > 0 ? options.radius : radius_of_nearest(graph, ball, sources[s], options).radius;
    };
    check_memory(graph, sources, radius, options);
    // Batches of sources, appended to the result one after the other: so their parts take little memory. Each has enough chunks for many
    // threads.
    constexpr Offset chunk = 64;
    const auto n = static_cast<Offset>(sources.size());
    const Offset batch = std::max(chunk, n / 16 / chunk) * chunk;
    LocalMaps maps;
    maps.dimension = graph.dimension();
    maps.kind = graph.transport_kind();
    maps.indptr.assign(sources.size() + 1, 0);
    detail::Mutex mutex;
    std::vector<std::unique_ptr<Collector>> idle;
    Offset done = 0;
    for (Offset first = 0; first < n; first += batch) {
      const Offset count = std::min(batch, n - first);
      std::vector<LocalEntries> chunks(static_cast<std::size_t>((count + chunk - 1) / chunk));
      detail::parallel_chunks(count, chunk, options.heat.threads, [&](Offset begin, Offset end) {
        std::unique_ptr<Collector> collector;
        {
          const detail::Lock lock(mutex);
          if (!idle.empty()) collector = std::move(idle.back()), idle.pop_back();
        }
        if (!collector) collector = std::make_unique<Collector>(graph, sources, options, make_coordinates());
        LocalEntries& entries = chunks[static_cast<std::size_t>(begin / chunk)];
        for (auto s = static_cast<std::size_t>(first + begin); s < static_cast<std::size_t>(first + end); ++s) {
          const std::size_t before = entries.vertices.size();
          collector->collect(s, entries);
          maps.indptr[s + 1] = static_cast<Offset>(entries.vertices.size() - before);
        }
        const detail::Lock lock(mutex);
        idle.push_back(std::move(collector));
        done += end - begin;
        options.heat.progress.step("solve", static_cast<double>(done) / static_cast<double>(n));
      });
      if (first + count == n) idle.clear();
      std::size_t found = 0;
      for (const LocalEntries& entries : chunks) found += entries.vertices.size();
      append(graph, chunks, found * static_cast<std::size_t>((n + count - 1) / count), maps, options.heat.threads);
    }
    std::partial_sum(maps.indptr.begin(), maps.indptr.end(), maps.indptr.begin());
    return maps;
  });
}

}  // namespace ahm
