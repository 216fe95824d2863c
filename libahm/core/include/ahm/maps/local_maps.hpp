/// \file
/// Where chosen vertices lie in the log maps of many sources, each known on its surroundings only.
///
/// \code
/// // The charts of an atlas: of every source the vertices of its own cell.
/// std::vector<double> phi = ahm::local_coordinates(graph, sources, regions);
/// \endcode
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/heat/heat_options.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/source.hpp"

namespace ahm {

/// The coordinates of the vertices of regions[s] in the map of sources[s]. Every map is solved for on what lies no farther from its
/// source along edges than the farthest of its vertices, and a margin; sources near each other share one factorization. Work
/// and memory depend on these patches, however large the graph is.
/// @param heat    t_coef, variant, check_graph, threads, progress (stage "solve")
/// @param margin  in units of sqrt(tau), as `LocalMapOptions::margin`: at 16 the difference to the map of the whole graph is 1e-11 of
///                the distance at most, on flat pieces none
/// @return d numbers per vertex, region by region, world units; NaN where no heat arrives, as in other components
/// @throws InvalidArgument (options, sources, vertices, sizes), InvalidGraph, NotPositiveDefinite (of a patch), ResourceExhausted,
/// Cancelled
std::vector<double> local_coordinates(const TangentGraph& graph, std::span<const Source> sources,
                                      std::span<const std::span<const Vertex>> regions,
                                      const DiffusionOptions& heat = {}, double margin = 16);

struct LocalMapOptions {
  double radius = 0;  ///< world units, finite and > 0; 0 with `nearest`: as far as those are
  /// Keep only so many nearest neighbours, the source's own vertex included; 0: all within the radius. Fewer where the
  /// radius or the component holds fewer.
  Index nearest = 0;
  /// How far beyond the radius each patch reaches, in units of sqrt(tau). Flat pieces are exact at any margin; elsewhere
  /// this is what the difference to the map of the whole graph depends on: about 1e-5 of the radius at 2, and ten times
  /// less at 3, and so on (docs/results/local_maps.md).
  double margin = 2;
  /// Distances no shorter than the straight line in space, as those by row are, where the graph has frames; which vertices are the nearest,
  /// and which lie within the radius, goes by them.
  bool bound_by_straight_line = false;
  DiffusionOptions heat = {};  ///< h is that of the whole graph
  std::size_t memory = 0;      ///< bytes that the result may take; 0: the memory of the machine
};

/// Local maps of many sources in compressed rows: source s has the entries indptr[s] .. indptr[s + 1], nearest first.
///
/// An entry is a vertex j within the radius: its coordinates phi_j in the source's frame, its distance (as `LogMap::distance`), the mass of j as an
/// integration weight, and the source's axes carried to the frame of j, which turn components in the source's frame into
/// components in frame j. The vertex a source stands on is its own neighbour, at distance 0.
/// @tparam Neighbor  Vertex, or Row where the neighbours are rows of the input (`row_local_maps`)
template <class Neighbor>
struct LocalMapsOf {
  int dimension = 2;
  TransportKind kind = TransportKind::rotation2;
  std::vector<Offset> indptr;       ///< sources + 1
  std::vector<Neighbor> neighbors;  ///< j
  std::vector<double> logs;         ///< d per entry, world units
  std::vector<double> distances;    ///< world units
  std::vector<double> weights;  ///< masses, world units to the power d; NaN where no double holds that (`world_mass`)
  std::vector<double> transports;  ///< 2 numbers (cos, sin) or d x d, row major, per entry

  Index sources() const noexcept { return static_cast<Index>(indptr.size()) - 1; }
  std::size_t transport_width() const { return TransportLayout{kind, dimension}.width(); }

  /// The same maps with other names for their neighbours.
  template <class Other>
  LocalMapsOf<Other> renamed(std::vector<Other> names) && {
    return {dimension,          kind,
            std::move(indptr),  std::move(names),
            std::move(logs),    std::move(distances),
            std::move(weights), std::move(transports)};
  }
};

using LocalMaps = LocalMapsOf<Vertex>;

/// The local maps of these sources. Sources close to each other share one small factorization; time and memory depend on
/// the patches only, however large the graph is.
/// @throws InvalidArgument (options, source), InvalidGraph, NotPositiveDefinite (of a patch), ResourceExhausted, Cancelled
LocalMaps local_maps(const TangentGraph& graph, std::span<const Source> sources, const LocalMapOptions& options);
/// Of these vertices.
LocalMaps local_maps(const TangentGraph& graph, std::span<const Vertex> vertices, const LocalMapOptions& options);
/// Of every vertex.
LocalMaps local_maps(const TangentGraph& graph, const LocalMapOptions& options);

}  // namespace ahm
