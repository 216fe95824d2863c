#include "ahm/maps/local_maps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <string>

#include "ahm/error.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/maps/unfolding_front.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "graph/patch.hpp"
#include "heat/blas_control.hpp"
#include "heat/check_options.hpp"
#include "heat/component_scales.hpp"
#include "heat/heat_system.hpp"
#include "maps/affine_heat.hpp"
#include "maps/ball.hpp"
#include "maps/heat_distance.hpp"
#include "maps/source_groups.hpp"

namespace ahm {
namespace {

/// Path lengths along edges exceed distances by up to this factor on good graphs; where it is not enough, a patch grows.
constexpr double usual_detour = 1.2;
/// No sensible graph has longer ones. Beyond, it is the map that is short: folded at a cut locus.
constexpr double largest_detour = 2;

void check(const TangentGraph& graph, std::span<const Source> sources, const LocalMapOptions& options) {
  if (options.nearest < 0)
    throw InvalidArgument("nearest is " + std::to_string(options.nearest) + "; it must be >= 0 (0: all)");
  const bool by_number = options.radius == 0 && options.nearest > 0;
  if (!by_number && (!(options.radius > 0) || !std::isfinite(options.radius)))
    throw InvalidArgument("radius is " + detail::number(options.radius) +
                          "; it must be finite and > 0, or 0 with a number of nearest neighbours");
  if (!(options.margin >= 0) || !std::isfinite(options.margin))
    throw InvalidArgument("margin is " + detail::number(options.margin) + "; it must be finite and >= 0");
  if (options.heat.order != 1)
    throw InvalidArgument("order is " + std::to_string(options.heat.order) + "; local maps have order 1");
  check_heat_options(graph, options.heat);
  for (const Source& source : sources) check_source(source, graph);
}

/// How far from each source its map goes, world units: the radius, or as far as its nearest neighbours are along edges,
/// where distances are no longer.
std::vector<double> radii_of(const TangentGraph& graph, std::span<const Source> sources,
                             const LocalMapOptions& options) {
  std::vector<double> radii(sources.size(), options.radius);
  if (options.radius > 0) return radii;
  Ball ball(graph);
  for (std::size_t s = 0; s < sources.size(); ++s) {
    Index count = 0;
    ball.grow(sources[s].vertices(), std::numeric_limits<double>::infinity(), [&](Index, double distance) {
      radii[s] = std::max(distance, graph.mean_edge_length() / 4) * graph.length_unit();
      return ++count < options.nearest;
    });
  }
  return radii;
}

/// One source's part of the result.
struct Entries {
  std::vector<Index> vertices;
  std::vector<double> logs, distances, transports;
};

class Worker {
 public:
  Worker(const TangentGraph& graph, const ComponentScales& scales, std::span<const Source> sources,
         std::vector<double>& radii, const LocalMapOptions& options)
      : graph_(graph),
        sources_(sources),
        radii_(radii),
        options_(options),
        operators_(options.heat),
        ball_(graph),
        scales_(scales),
        place_(static_cast<std::size_t>(graph.size())),
        d_(static_cast<std::size_t>(graph.dimension())) {
    operators_.progress = {};
    operators_.check_graph = false;
    operators_.threads = 1;
  }

  /// Solves for the sources of one group on one patch; result[s] for source s.
  void solve(std::span<const Index> members, std::vector<Entries>& result) {
    double h = 0;
    for (Index s : members)
      for (Vertex vertex : sources_[s].vertices()) h = std::max(h, scales_.h(vertex.index));
    const double unit = graph_.length_unit(), sqrt_tau = std::sqrt(options_.heat.t_coef) * h;
    const auto reach = [&] {  // graph units
      double radius = 0;
      for (Index s : members) radius = std::max(radius, radii_[s]);
      return radius / unit + options_.margin * sqrt_tau;
    };
    double detour = usual_detour;
    while (true) {
      const bool last = detour >= largest_detour;
      const double far = reach();
      switch (solve(members, (last ? largest_detour : detour) * far, last ? 0 : far * unit, result)) {
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
    patch_too_small,   ///< it does not hold all within `wanted` of a source
    radius_too_small,  ///< fewer vertices than the nearest that are asked for lie within
  };

  /// On the patch of all vertices within `limit` along edges.
  Outcome solve(std::span<const Index> members, double limit, double wanted, std::vector<Entries>& result) {
    std::vector<Vertex> starts;
    std::vector<Index> vertices, edge;
    for (Index s : members) {
      const auto samples = sources_[s].vertices();
      starts.insert(starts.end(), samples.begin(), samples.end());
    }
    ball_.grow(starts, limit, [&](Index vertex, double) {
      vertices.push_back(vertex);
      return true;
    });
    // Sorted, so that the patch does not depend on the way it was found, and its matrix is nearly the graph's own.
    std::sort(vertices.begin(), vertices.end());
    for (std::size_t k = 0; k < vertices.size(); ++k) place_[vertices[k]] = static_cast<Index>(k) + 1;
    const CsrGraph patch = cut_out(
        graph_, vertices, [&](Index j) { return place_[j] - 1; },
        [&](std::size_t k, const Star&, std::size_t) {
          if (edge.empty() || edge.back() != static_cast<Index>(k)) edge.push_back(static_cast<Index>(k));
          return 0.0;
        });
    std::vector<double> tau;
    for (Index vertex : vertices) tau.push_back(diffusion_time(options_.heat.t_coef, scales_.h(vertex)));
    const HeatOperators operators(factored_system(patch, std::move(tau), operators_), patch, {});
    std::vector<Inflow> inflows;
    for (Index s : members) {
      inflows.push_back(inflow_of(sources_[s], graph_, operators, options_.heat.variant));
      for (Index& vertex : inflows.back().vertices) vertex = place_[vertex] - 1;
    }
    std::vector<Source> local;
    for (Index s : members) local.push_back(in_patch(sources_[s]));
    for (Index vertex : vertices) place_[vertex] = 0;
    AffineHeat heat(patch, operators, options_.heat.variant, std::move(inflows));
    heat.diffuse();
    heat.solve();
    if (graph_.is_delaunay())
      stars_ = UnfoldingFront::stars(patch);
    else
      heat.solve_squares();
    for (std::size_t m = 0; m < members.size(); ++m) {
      const Outcome outcome = collect(heat, m, patch, local[m], unfolds(graph_, sources_[members[m]]), vertices, edge,
                                      wanted, radii_[members[m]], result[members[m]]);
      if (outcome != Outcome::complete) return outcome;
    }
    return Outcome::complete;
  }

  /// A source by the places of its vertices.
  Source in_patch(const Source& source) {
    Source result(static_cast<int>(d_));
    const std::vector<double> zero(d_, 0.0);
    for (std::size_t k = 0; k < source.vertices().size(); ++k) {
      const bool plain = source.offsets().empty();
      result.add(Vertex(place_[source.vertices()[k].index] - 1), source.weights()[k],
                 plain ? zero : source.offsets().subspan(k * d_, d_),
                 plain ? std::span<const double>() : source.axes().subspan(k * d_ * d_, d_ * d_), source.place(k));
    }
    return result;
  }

  /// Distances of the patch from its source number m, as those of a whole map (`LogMap::distance`).
  /// @param by_front  unfolded (`unfolds`)
  void measure(const AffineHeat& heat, std::size_t m, const CsrGraph& patch, const Source& source, bool by_front,
               double root_tau, double radius) {
    const auto n = static_cast<std::size_t>(patch.size());
    distance_.resize(n);
    if (by_front) {
      UnfoldingFront front(patch, stars_);
      front.add(source);
      front.run(radius);
      for (std::size_t k = 0; k < n; ++k) distance_[k] = front.distance(Vertex(k));
      return;
    }
    for (std::size_t k = 0; k < n; ++k)
      distance_[k] = heat_distance(length(std::span<const double>(phi_).subspan(k * d_, d_)),
                                   heat.root_mean_square_at(m, static_cast<Index>(k)), root_tau);
    place_source(source, distance_);
  }

  /// The vertices within the radius, nearest first.
  Outcome collect(const AffineHeat& heat, std::size_t m, const CsrGraph& patch, const Source& source, bool by_front,
                  std::span<const Index> vertices, std::span<const Index> edge, double wanted, double radius,
                  Entries& entries) {
    const std::size_t n = vertices.size();
    phi_.resize(n * d_);
    for (std::size_t k = 0; k < n; ++k) heat.coordinates_at(m, static_cast<Index>(k), phi_.data() + k * d_);
    const double root_tau = std::sqrt(options_.heat.t_coef) * scales_.h(vertices[source.vertices().front().index]);
    measure(heat, m, patch, source, by_front, root_tau * graph_.length_unit(), std::max(wanted, radius));
    order_.clear();
    for (std::size_t k = 0; k < n; ++k) {
      const auto vertex = static_cast<Index>(k);
      const double* phi = phi_.data() + k * d_;
      if (!heat.reached(m, vertex) || !all_finite(std::span(phi, d_)))
        distance_[k] = std::numeric_limits<double>::infinity();
      if (distance_[k] <= radius) order_.push_back(vertex);
    }
    for (Index k : edge)
      if (distance_[k] < wanted * (1 - 1e-9)) return Outcome::patch_too_small;
    // A patch without an edge is all there is.
    if (options_.radius == 0 && order_.size() < static_cast<std::size_t>(options_.nearest) && !edge.empty())
      return Outcome::radius_too_small;
    std::sort(order_.begin(), order_.end(),
              [&](Index a, Index b) { return distance_[a] != distance_[b] ? distance_[a] < distance_[b] : a < b; });
    if (options_.nearest > 0 && order_.size() > static_cast<std::size_t>(options_.nearest))
      order_.resize(static_cast<std::size_t>(options_.nearest));

    entries = {};
    const std::size_t size = order_.size();
    entries.vertices.reserve(size);
    entries.distances.reserve(size);
    entries.logs.reserve(size * d_);
    entries.transports.reserve(size * graph_.transport_layout().width());
    const FrameField frames = heat.frames(m);
    std::vector<double> U(graph_.transport_layout().width());
    for (Index k : order_) {
      entries.vertices.push_back(vertices[k]);
      entries.distances.push_back(distance_[k]);
      entries.logs.insert(entries.logs.end(), phi_.begin() + static_cast<std::ptrdiff_t>(k * d_),
                          phi_.begin() + static_cast<std::ptrdiff_t>((k + 1) * d_));
      frames.frame(k, U.data());
      entries.transports.insert(entries.transports.end(), U.begin(), U.end());
    }
    return Outcome::complete;
  }

  const TangentGraph& graph_;
  std::span<const Source> sources_;
  std::vector<double>& radii_;  ///< of the sources; those of one group belong to one worker
  const LocalMapOptions& options_;
  HeatOptions operators_;
  Ball ball_;
  const ComponentScales& scales_;
  SparseArray<Index> place_;  ///< 1 + place in the patch at hand, 0: outside
  std::size_t d_;
  std::vector<double> phi_, distance_;
  std::shared_ptr<const UnfoldingFront::Stars> stars_;  ///< of the patch at hand
  std::vector<Index> order_;
};

LocalMaps joined(const TangentGraph& graph, std::vector<Entries>& entries) {
  LocalMaps maps;
  maps.dimension = graph.dimension();
  maps.kind = graph.transport_kind();
  maps.indptr.push_back(0);
  for (const Entries& e : entries) maps.indptr.push_back(maps.indptr.back() + static_cast<Offset>(e.vertices.size()));
  const auto total = static_cast<std::size_t>(maps.indptr.back());
  maps.indices.reserve(total);
  maps.logs.reserve(total * static_cast<std::size_t>(graph.dimension()));
  maps.distances.reserve(total);
  maps.transports.reserve(total * maps.transport_width());
  maps.weights.reserve(total);
  for (Entries& e : entries) {
    maps.indices.insert(maps.indices.end(), e.vertices.begin(), e.vertices.end());
    maps.logs.insert(maps.logs.end(), e.logs.begin(), e.logs.end());
    maps.distances.insert(maps.distances.end(), e.distances.begin(), e.distances.end());
    maps.transports.insert(maps.transports.end(), e.transports.begin(), e.transports.end());
    e = {};  // so that the peak is little more than the result
  }
  for (Index vertex : maps.indices) maps.weights.push_back(world_mass(graph, graph.mass(vertex)));
  return maps;
}

}  // namespace

LocalMaps local_maps(const TangentGraph& graph, std::span<const Source> sources, const LocalMapOptions& options) {
  return detail::with_memory_check("solving for local maps", [&] {
    check(graph, sources, options);
    options.heat.progress.step("group", 0.0);
    // Sources whose patches overlap anyway.
    const ComponentScales scales(graph);
    std::vector<double> radii = radii_of(graph, sources, options);
    const auto reach = [&](Index seed) {
      return radii[seed] / graph.length_unit() +
             (options.margin + 4) * std::sqrt(options.heat.t_coef) * scales.h(sources[seed].vertices().front().index);
    };
    const auto groups = groups_of(graph, sources, reach);
    std::vector<Entries> entries(sources.size());
    const OneBlasThread one_thread;
    std::mutex mutex;
    std::vector<std::unique_ptr<Worker>> idle;
    Offset done = 0;
    detail::parallel_chunks(static_cast<Offset>(groups.size()), 8, options.heat.threads, [&](Offset begin, Offset end) {
      std::unique_ptr<Worker> worker;
      {
        std::scoped_lock lock(mutex);
        if (!idle.empty()) worker = std::move(idle.back()), idle.pop_back();
      }
      if (!worker) worker = std::make_unique<Worker>(graph, scales, sources, radii, options);
      without_openmp_regions([&] {
        for (Offset g = begin; g < end; ++g) worker->solve(groups[g], entries);
      });
      std::scoped_lock lock(mutex);
      idle.push_back(std::move(worker));
      done += end - begin;
      options.heat.progress.step("solve", static_cast<double>(done) / static_cast<double>(groups.size()));
    });
    return joined(graph, entries);
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
