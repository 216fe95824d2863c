#include "ahm/maps/local_maps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/maps/straight_line.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "maps/affine_heat.hpp"
#include "maps/local_map_parts.hpp"
#include "maps/one_rings.hpp"
#include "maps/patch_maps.hpp"
#include "maps/vector_quality.hpp"

namespace ahm {
namespace {

using Regions = std::span<const std::span<const Vertex>>;

void check(const TangentGraph& graph, std::span<const Source> sources, Regions regions, const DiffusionOptions& heat,
           double margin) {
  if (regions.size() != sources.size())
    throw InvalidArgument("local_coordinates: `regions` has size " + std::to_string(regions.size()) + ", `sources` " +
                          std::to_string(sources.size()) + "; the sizes must be equal");
  check_patches(graph, sources, heat, margin);
  for (const auto region : regions)
    for (const auto [vertex] : region)
      if (vertex < 0 || vertex >= graph.size())
        throw InvalidArgument("vertex " + std::to_string(vertex) + " is outside [0, " + std::to_string(graph.size()) +
                              ")");
}

/// Length of the edge path from each source to the farthest vertex of its region, graph units.
std::vector<double> extents(const TangentGraph& graph, const ComponentScales& scales, std::span<const Source> sources,
                            Regions regions) {
  std::vector<double> result(sources.size(), 0);
  Ball ball(graph);
  std::vector<std::uint8_t> wanted(static_cast<std::size_t>(graph.size()), 0);
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const SourceComponents components(sources[s], scales.components.of_vertex);
    std::size_t left = 0;
    for (const auto [vertex] : regions[s])
      if (components.hold(vertex) && wanted[vertex] == 0) wanted[vertex] = 1, ++left;
    ball.grow(sources[s].vertices(), std::numeric_limits<double>::infinity(), [&](Index vertex, double distance) {
      if (wanted[vertex] != 0) result[s] = distance, wanted[vertex] = 0, --left;
      return left > 0;
    });
    for (const auto [vertex] : regions[s]) wanted[vertex] = 0;
  }
  return result;
}

}  // namespace

std::vector<double> local_coordinates(const TangentGraph& graph, std::span<const Source> sources, Regions regions,
                                      const DiffusionOptions& heat, double margin) {
  return detail::with_memory_check("solving for local coordinates", [&] {
    check(graph, sources, regions, heat, margin);
    const ComponentScales scales(graph);
    const auto d = static_cast<std::size_t>(graph.dimension());
    std::vector<std::size_t> begin{0};
    for (const auto region : regions) begin.push_back(begin.back() + region.size());
    std::vector<double> result(begin.back() * d, std::numeric_limits<double>::quiet_NaN());

    const std::vector<double> extent = extents(graph, scales, sources, regions);
    const auto groups = patch_groups(graph, scales, sources, extent, heat, margin);
    const auto solve = [&](PatchSolver& patches, std::span<const Index> members) {
      std::vector<Source> group;
      double farthest = 0;
      for (Index s : members) group.push_back(sources[s]), farthest = std::max(farthest, extent[s]);
      const auto patch = patches.solve(patches.cut(group, farthest + margin * patches.sqrt_tau(group)));
      for (std::size_t m = 0; m < members.size(); ++m) {
        const SourceVertices own(patch->sources[m], graph.dimension());
        double* phi = result.data() + begin[members[m]] * d;
        for (const auto [vertex] : regions[members[m]]) {
          const auto found = std::ranges::lower_bound(patch->vertices, vertex);
          const auto place = static_cast<Index>(found - patch->vertices.begin());
          if (found != patch->vertices.end() && *found == vertex && patch->heat->reached(m, place)) {
            patch->heat->coordinates_at(m, place, phi);
            if (const auto* known = own.find(place)) std::copy(known->vector.begin(), known->vector.end(), phi);
            if (!all_finite(std::span(phi, d))) std::fill_n(phi, d, std::numeric_limits<double>::quiet_NaN());
          }
          phi += d;
        }
      }
    };
    share_groups(
        groups, heat.threads, heat.progress, [&] { return std::make_unique<PatchSolver>(graph, scales, heat); }, solve);
    return result;
  });
}

namespace {

/// Edge paths of good graphs are longer than distances by up to this factor. If a patch turns out to be too small, the factor increases.
constexpr double usual_detour = 1.2;
/// Largest factor to try. If it is not sufficient, the distances of the map are too short, for example because it folds at a cut locus.
constexpr double largest_detour = 2;

void check(const TangentGraph& graph, std::span<const Source> sources, const LocalMapOptions& options) {
  check_extent(options);
  if (options.method && *options.method != Method::heat)
    throw InvalidArgument("method is " + std::string(to_string(*options.method)) +
                          "; local maps of a graph are by heat, use PolarMapSolver::local_maps or row_local_maps");
  check_patches(graph, sources, options.heat, options.margin);
}

/// Radius of each map, world units: the radius of the options, or that of the nearest neighbors.
std::vector<double> radii_of(const TangentGraph& graph, std::span<const Source> sources,
                             const LocalMapOptions& options) {
  std::vector<double> radii(sources.size(), options.radius);
  if (options.radius > 0) return radii;
  Ball ball(graph);
  for (std::size_t s = 0; s < sources.size(); ++s)
    radii[s] = radius_of_nearest(graph, ball, sources[s], options).radius;
  return radii;
}

class Worker {
 public:
  Worker(const TangentGraph& graph, const ComponentScales& scales, std::span<const Source> sources,
         std::vector<double>& radii, const LocalMapOptions& options)
      : graph_(graph),
        sources_(sources),
        radii_(radii),
        options_(options),
        patches_(graph, scales, options.heat),
        d_(static_cast<std::size_t>(graph.dimension())) {}

  /// Solves the sources of one group on one patch. Writes result[s] for each source s.
  void solve(std::span<const Index> members, std::vector<LocalEntries>& result) {
    std::vector<Source> sources;
    for (Index s : members) sources.push_back(sources_[s]);
    const double unit = graph_.length_unit(), margin = options_.margin * patches_.sqrt_tau(sources);
    const auto reach = [&] {  // graph units
      double radius = 0;
      for (Index s : members) radius = std::max(radius, radii_[s]);
      return radius / unit + margin;
    };
    double detour = usual_detour;
    while (true) {
      const bool last = detour >= largest_detour;
      const double far = reach(), wanted = last ? 0 : far * unit;
      Patch patch = patches_.cut(sources, (last ? largest_detour : detour) * far);
      Outcome outcome = measure(patch, members, wanted);
      if (outcome == Outcome::complete) outcome = collect(*patches_.solve(std::move(patch)), members, wanted, result);
      switch (outcome) {
        case Outcome::complete:
          return;
        case Outcome::patch_too_small:
          detour *= 1.3;
          break;
        case Outcome::radius_too_small:
          for (Index s : members) radii_[s] *= 1.3;
      }
    }
  }

 private:
  enum class Outcome {
    complete,
    patch_too_small,   ///< the patch does not contain all vertices within `wanted` of a source
    radius_too_small,  ///< fewer vertices than `LocalMapOptions::k` lie within the radius
  };

  /// Unfolds the distances on the patch from the sources where this is possible. So a patch that is too small is detected before its
  /// systems are solved.
  Outcome measure(const Patch& patch, std::span<const Index> members, double wanted) {
    const std::size_t n = patch.vertices.size();
    std::shared_ptr<const Wavefront::OneRings> one_rings;
    if (graph_.is_delaunay()) {
      one_rings = std::make_shared<const Wavefront::OneRings>(patch.graph, std::vector<std::uint8_t>(), true);
      find_rim(patch);
    }
    distances_.resize(members.size() * n);
    for (std::size_t k = 0; k < members.size(); ++k) {
      // The last members of a group are nearest to the edge of the patch, so they detect first that it is too small.
      const std::size_t m = options_.radius > 0 ? members.size() - 1 - k : k;
      if (!unfolds(graph_, patch.sources[m])) continue;
      const double radius = radii_[members[m]];
      Wavefront front(patch.graph, one_rings);
      front.add(patch.sources[m]);
      front.run(is_within(patch, sources_[members[m]], wanted) ? radius : std::max(wanted, radius));
      const std::span<double> distance = distances(m, n);
      for (std::size_t i = 0; i < n; ++i) distance[i] = front.distance(Vertex(i));
      const Outcome outcome = judge(patch, distance, wanted, radius);
      if (outcome != Outcome::complete) return outcome;
    }
    return Outcome::complete;
  }

  /// Finds the positions of the edge of the patch in space; none if the graph has no frames.
  void find_rim(const Patch& patch) {
    rim_.clear();
    for (const Index k : patch.edge)
      if (const auto frame = graph_.frame(patch.vertices[k])) rim_.push_back(frame->origin);
  }

  /// Whether the edge of the patch is farther than `wanted` from the source even along straight lines. No path is shorter, so distances
  /// beyond the radius are not needed.
  bool is_within(const Patch& patch, const Source& source, double wanted) const {
    const std::optional<Vec3> start = source_position(graph_, source);
    return start && !rim_.empty() && rim_.size() == patch.edge.size() &&
           std::ranges::all_of(rim_, [&](const Vec3& end) { return distance(end, *start) >= wanted; });
  }

  /// Whether the patch and the radius are large enough.
  /// @param distance  distance of each vertex of the patch from a source
  Outcome judge(const Patch& patch, std::span<const double> distance, double wanted, double radius) const {
    for (Index k : patch.edge)
      if (distance[k] < wanted * (1 - 1e-9)) return Outcome::patch_too_small;
    if (options_.radius > 0 || patch.edge.empty()) return Outcome::complete;
    Index count = 0;
    for (std::size_t i = 0; i < distance.size(); ++i)
      if (distance[i] <= radius && is_neighbor(options_, patch.vertices[i])) ++count;
    return count < options_.k ? Outcome::radius_too_small : Outcome::complete;
  }

  std::span<double> distances(std::size_t m, std::size_t n) { return std::span(distances_).subspan(m * n, n); }

  Outcome collect(PatchMaps& patch, std::span<const Index> members, double wanted, std::vector<LocalEntries>& result) {
    if (!graph_.is_delaunay()) patch.heat->solve_squares(), patch.heat->solve_lengths();
    for (std::size_t m = 0; m < members.size(); ++m) {
      const Outcome outcome = collect(patch, m, members[m], wanted, result[members[m]]);
      if (outcome != Outcome::complete) return outcome;
    }
    return Outcome::complete;
  }

  /// Increases distances on a patch that are shorter than the straight line from the source to its length.
  void raise(const PatchMaps& patch, const Source& source, std::span<double> distances) const {
    const std::optional<Vec3> start = straight_line_origin(graph_, source);
    if (!start) return;
    for (std::size_t k = 0; k < distances.size(); ++k)
      if (const auto frame = graph_.frame(patch.vertices[k]))
        distances[k] = bounded_distance(distance(frame->origin, *start), distances[k]);
  }

  /// Collects the vertices within the radius, nearest first.
  /// @param m       number of the source in the patch
  /// @param source  number of the source among all sources
  Outcome collect(const PatchMaps& patch, std::size_t m, Index source, double wanted, LocalEntries& entries) {
    const double radius = radii_[source];
    const std::size_t n = patch.vertices.size();
    const AffineHeat& heat = *patch.heat;
    const std::span<double> distance = distances(m, n);
    if (!unfolds(graph_, patch.sources[m])) {
      for (std::size_t k = 0; k < n; ++k) distance[k] = heat.distance_at(m, static_cast<Index>(k));
      set_source_distances(patch.sources[m], distance);
    }
    if (options_.bound_by_straight_line) raise(patch, sources_[source], distance);
    phi_.resize(n * d_);
    order_.clear();
    farthest_ = 0;
    // A patch without an edge contains the whole component.
    const double farthest = options_.radius == 0 && patch.edge.empty() ? std::numeric_limits<double>::max() : radius;
    for (std::size_t k = 0; k < n; ++k) {
      const auto vertex = static_cast<Index>(k);
      if (distance[k] > std::max(wanted, farthest)) continue;
      double* const phi = phi_.data() + k * d_;
      heat.coordinates_at(m, vertex, phi);
      if (!heat.reached(m, vertex) || !all_finite(std::span<const double>(phi, d_)))
        distance[k] = std::numeric_limits<double>::infinity();
      if (!(distance[k] <= farthest)) continue;
      farthest_ = std::max(farthest_, distance[k]);
      if (is_neighbor(options_, patch.vertices[k])) order_.emplace_back(distance[k], vertex);
    }
    const Outcome outcome = judge(patch, distance, wanted, radius);
    if (outcome != Outcome::complete) return outcome;
    std::sort(order_.begin(), order_.end());
    if (options_.k > 0 && order_.size() >= static_cast<std::size_t>(options_.k)) {
      order_.resize(static_cast<std::size_t>(options_.k));
      farthest_ = order_.back().first;
    }

    for (const auto& [vertex, known] : SourceVertices(patch.sources[m], graph_.dimension()))
      std::copy(known.vector.begin(), known.vector.end(), phi_.begin() + static_cast<std::ptrdiff_t>(vertex * d_));
    entries = {};
    if (options_.quality) add_quality(patch, distance, entries);
    const std::size_t size = order_.size();
    entries.vertices.reserve(size);
    entries.distances.reserve(size);
    entries.logs.reserve(size * d_);
    entries.transports.reserve(size * graph_.transport_layout().width());
    const FrameField frames = heat.frames(m);
    std::vector<double> U(graph_.transport_layout().width());
    for (const auto& [from_source, k] : order_) {
      entries.vertices.emplace_back(patch.vertices[k]);
      entries.distances.push_back(from_source);
      entries.logs.insert(entries.logs.end(), phi_.begin() + static_cast<std::ptrdiff_t>(k * d_),
                          phi_.begin() + static_cast<std::ptrdiff_t>((k + 1) * d_));
      frames.frame(k, U.data());
      entries.transports.insert(entries.transports.end(), U.begin(), U.end());
    }
    return Outcome::complete;
  }

  /// Adds the quality of the vertices in `order_`.
  /// @param distance  of each vertex of the patch
  void add_quality(const Patch& patch, std::span<const double> distance, LocalEntries& entries) const {
    const double h = graph_.length_unit() * graph_.mean_edge_length();
    const auto phi = [&](Index k) { return std::span(phi_).subspan(to_size(k) * d_, d_); };
    for (const auto& [from_source, k] : order_) {
      const auto length_in_map = [&, here = k](Index j) {
        if (!(distance[to_size(j)] <= farthest_)) return std::numeric_limits<double>::quiet_NaN();
        double apart = 0;
        for (std::size_t a = 0; a < d_; ++a) apart = std::hypot(apart, phi(j)[a] - phi(here)[a]);
        return apart;
      };
      entries.quality.push_back(quality_of(graph_, Vertex(patch.vertices[to_size(k)]),
                                           std::abs(length(phi(k)) - from_source),
                                           jump_at(patch.graph, k, length_in_map), from_source, h));
    }
  }

  const TangentGraph& graph_;
  std::span<const Source> sources_;
  std::vector<double>& radii_;  ///< radius of each source; only the worker of its group changes it
  const LocalMapOptions& options_;
  PatchSolver patches_;
  std::size_t d_;
  std::vector<double> distances_;  ///< distances on the current patch from each of its sources, n each
  std::vector<Vec3> rim_;          ///< positions of the vertices at the edge of the patch
  std::vector<double> phi_;
  std::vector<std::pair<double, Index>> order_;  ///< distance and number of the neighbors, nearest first
  double farthest_ = 0;  ///< the map contains the vertices up to this distance, neighbors or not
};

}  // namespace

LocalMaps local_maps(const TangentGraph& graph, std::span<const Source> sources, const LocalMapOptions& options) {
  return detail::with_memory_check("solving for local maps", [&] {
    check(graph, sources, options);
    options.heat.progress.step("group", 0.0);
    const ComponentScales scales(graph);
    std::vector<double> radii = radii_of(graph, sources, options), extent;
    check_memory(
        graph, sources, [&](std::size_t s) { return radii[s]; }, options);
    for (const double radius : radii) extent.push_back(radius / graph.length_unit());
    const auto groups = patch_groups(graph, scales, sources, extent, options.heat, options.margin);
    std::vector<LocalEntries> entries(sources.size());
    share_groups(
        groups, options.heat.threads, options.heat.progress,
        [&] { return std::make_unique<Worker>(graph, scales, sources, radii, options); },
        [&](Worker& worker, const std::vector<Index>& group) { worker.solve(group, entries); });
    std::vector<Offset> indptr{0};
    for (const LocalEntries& e : entries) indptr.push_back(indptr.back() + static_cast<Offset>(e.vertices.size()));
    return joined(graph, std::move(indptr), entries, options.heat.threads);
  });
}

LocalMaps local_maps(const TangentGraph& graph, std::span<const Vertex> vertices, const LocalMapOptions& options) {
  std::vector<Source> sources;
  sources.reserve(vertices.size());
  for (Vertex vertex : vertices) sources.push_back(Source::at_vertex(vertex));
  return local_maps(graph, sources, options);
}

LocalMaps local_maps(const TangentGraph& graph, const LocalMapOptions& options) {
  std::vector<Vertex> vertices;
  for (Index i = 0; i < graph.size(); ++i) vertices.push_back(Vertex(i));
  return local_maps(graph, vertices, options);
}

}  // namespace ahm
