/// \file
/// Log maps of many sources, each computed on a small part of the graph. For surfaces use `row_local_maps`.
///
/// \code
/// // The charts of an atlas: for each source the vertices of its own cell.
/// std::vector<double> phi = ahm::local_coordinates(graph, sources, regions);
/// \endcode
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/heat/heat_options.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/maps/wavefront.hpp"

namespace ahm {

/// Coordinates of the vertices regions[s] in the map of sources[s]. Each map is solved on a patch: all vertices whose edge path from the
/// source is at most as long as that of the farthest vertex of the region, plus a margin. Nearby sources share one factorization. Work and
/// memory depend on the patches, not on the size of the graph.
/// @param heat    t_coef, variant, check_graph, threads, progress (stage "solve")
/// @param margin  in units of sqrt(tau), as `LocalMapOptions::margin`. At 16 the difference to the map of the whole graph is at most
///                1e-11 of the distance; flat patches have no difference
/// @return d numbers per vertex, region by region, world units; NaN where no heat arrives, as in other components
/// @throws InvalidArgument (options, sources, vertices, sizes), InvalidGraph, NotPositiveDefinite (of a patch), ResourceExhausted,
///         Cancelled
std::vector<double> local_coordinates(const TangentGraph& graph, std::span<const Source> sources,
                                      std::span<const std::span<const Vertex>> regions,
                                      const DiffusionOptions& heat = {}, double margin = 16);

struct LocalMapOptions {
  double radius = 0;  ///< world units, finite and > 0; 0: no limit, requires `k` > 0
  /// The number of nearest neighbors to keep, including the source's own vertex; 0: all within the radius. The result has fewer if the
  /// radius or the component contains fewer.
  Index k = 0;
  /// heat, or polar (`PolarMapSolver::local_maps`, `row_local_maps`). None: the method of the solver, or the one suggested for the
  /// surface; heat for graphs.
  std::optional<Method> method = {};
  /// Heat: how far each patch extends beyond the radius, in units of sqrt(tau). Flat patches are exact at any margin. Other patches differ from
  /// the map of the whole graph by about 1e-5 of the radius at 2, ten times less at 3, and so on (docs/results/local_maps.md).
  double margin = 2;
  /// Increase distances that are shorter than the straight line in space to its length, as in results by row. The radius and `k`
  /// apply to the increased distances. Ignored if the graph has no frames.
  bool bound_by_straight_line = false;
  /// Compute `LocalMaps::quality`. On clouds, polar maps take twice the time.
  bool quality = false;
  /// Polar maps use `threads` and `progress` only. Heat: the mean edge length h is measured on the whole graph.
  DiffusionOptions heat = {};
  std::size_t memory = 0;  ///< bytes available for the result; 0: the memory of the machine
  /// Whether a vertex may be a neighbor; `k` counts only these. Empty: all. Must be safe to call from several threads.
  std::function<bool(Vertex)> is_neighbor = {};
};

/// Local maps of many sources in compressed rows: source s has the entries indptr[s] .. indptr[s + 1], nearest first.
///
/// An entry is a vertex j within the radius. It has the coordinates phi_j in the source's frame, the distance (as `LogMap::distance`), the
/// mass of j as an integration weight, and the parallel transport from the source's frame to the frame of j. The vertex of a source is
/// its own neighbor, at distance 0.
/// @tparam Neighbor  Vertex, or Row if the neighbors are rows of the input (`row_local_maps`)
template <class Neighbor>
struct LocalMapsOf {
  int dimension = 2;
  TransportKind kind = TransportKind::rotation2;
  std::vector<Offset> indptr;       ///< sources + 1
  std::vector<Neighbor> neighbors;  ///< vertex or row j of each entry
  std::vector<double> logs;         ///< d per entry, world units
  std::vector<double> distances;    ///< world units
  std::vector<double> weights;      ///< masses, world units to the power d; NaN out of range of double (`world_mass`)
  std::vector<double> transports;   ///< 2 numbers (cos, sin) or d x d, row major, per entry
  /// How reliable each vector is, in (0, 1], as `map_quality`. The error of a polar map is that of its direction, and of a map by heat the
  /// difference of |phi| and the distance. The spread is half of the largest excess of an edge's length in the map over its length, over the
  /// neighbors within the radius. Empty unless requested.
  std::vector<double> quality = {};

  Index sources() const noexcept { return static_cast<Index>(indptr.size()) - 1; }
  std::size_t transport_width() const { return TransportLayout{kind, dimension}.width(); }

  /// Replaces `neighbors` by `names`, one per entry.
  template <class Other>
  LocalMapsOf<Other> renamed(std::vector<Other> names) && {
    return {dimension,          kind,
            std::move(indptr),  std::move(names),
            std::move(logs),    std::move(distances),
            std::move(weights), std::move(transports),
            std::move(quality)};
  }
};

using LocalMaps = LocalMapsOf<Vertex>;

/// Local maps of these sources by the heat method. Nearby sources share one small factorization. Time and memory depend on the patches,
/// not on the size of the graph.
/// @throws InvalidArgument (options, source; another method), InvalidGraph, NotPositiveDefinite (of a patch), ResourceExhausted, Cancelled
LocalMaps local_maps(const TangentGraph& graph, std::span<const Source> sources, const LocalMapOptions& options);
/// Local maps of these vertices.
LocalMaps local_maps(const TangentGraph& graph, std::span<const Vertex> vertices, const LocalMapOptions& options);
/// Local maps of every vertex.
LocalMaps local_maps(const TangentGraph& graph, const LocalMapOptions& options);

/// Geodesic polar coordinates of the vertices around a source.
struct PolarNeighbors {
  std::span<const Wavefront::Seed> vertices;
  double horizon;  ///< `vertices` contains all vertices up to this distance, world units
};
/// Computes polar coordinates around source s up to a radius, world units. The horizon may be smaller if at least `enough` vertices lie
/// within it (0: it may not). The result is valid until the next call.
using LocalPolarCoordinates = std::function<PolarNeighbors(std::size_t s, double radius, Index enough)>;

/// Local maps from geodesic polar coordinates, d = 2. Nothing is factored. Time and memory depend on the number of entries, not on the size
/// of the graph.
/// @param sources           the sources of the coordinates; no curves
/// @param make_coordinates  makes the coordinates of one thread
/// @throws InvalidArgument (options, source, dimension), ResourceExhausted, Cancelled
LocalMaps local_polar_maps(const TangentGraph& graph, std::span<const Source> sources, const LocalMapOptions& options,
                           const std::function<LocalPolarCoordinates()>& make_coordinates);

}  // namespace ahm
