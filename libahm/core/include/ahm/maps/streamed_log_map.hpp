/// \file
/// One log map of a graph that need not fit into memory: by march, handed over vertex after vertex as the front passes.
///
/// \code
/// struct Rows final : ahm::MapSink {
///   void put(ahm::Index vertex, const ahm::MapRow& row) override { std::cout << vertex << ' ' << row.distance << '\n'; }
/// } rows;
/// ahm::stream_log_map(graph, ahm::Source::at_vertex(ahm::Vertex{0}), {}, rows);
/// \endcode
#pragma once

#include <limits>
#include <span>

#include "ahm/maps/log_map_solver.hpp"

namespace ahm {

/// What a map says of a vertex; numbers are NaN where the status is not `ok`. Lengths in world units.
struct MapRow {
  Status status;                        ///< ok, beyond_radius or unreached
  std::span<const double> coordinates;  ///< phi, d numbers in the source's frame; none of `stream_distances`
  double distance;                      ///< as `LogMap::distance`
  double spread;                        ///< as `LogMap::spread`
};

/// Options of streamed maps.
struct StreamOptions {
  double t_coef = 1.0;  ///< tau = t_coef h^2; > 0
  Variant variant = Variant::adaptive;
  double accuracy = 1e-9;  ///< largest relative difference to a global solve; in [1e-14, 0.1]
  /// The march ends at this distance. World units; > 0.
  double radius = std::numeric_limits<double>::infinity();
  unsigned threads = 0;  ///< 0: one per core. No result depends on it
  Progress progress = {};
};

class MapSink {
 public:
  virtual ~MapSink() = default;
  /// Called once for each vertex that the march comes to, from one thread, in the order of the march. `row` lives as long as the call.
  virtual void put(Index vertex, const MapRow& row) = 0;
};

/// The map that a marching `LogMapSolver` makes of the same graph and source, to the bit. Vertices that `sink` is not told
/// of are beyond the radius, without heat, or in a component without the source.
///
/// Memory is in proportion to the march's front (about 300 bytes per vertex of a band, besides its factors) and 10 bytes per
/// 256 vertices of the graph; the graph is asked for stars along the front alone, from one thread. Where it `is_delaunay`, distances
/// are unfolded first, by a front that keeps 30 bytes per vertex of the graph.
/// @param graph    tells `component_edge_length` of every vertex. It is not validated
/// @param source   points, not a curve
/// @throws InvalidArgument (source, options, a graph of another kind), InvalidGraph (an edge that only one end knows),
/// NotPositiveDefinite (of a band), Cancelled, and what graph and sink throw
MarchStatistics stream_log_map(const TangentGraph& graph, const Source& source, const StreamOptions& options,
                               MapSink& sink);

/// The distances of the localized map alone, to the bit, whatever variant the options name; its spread to rounding. No frames are
/// solved for, which is one of the two solves with B in every band.
/// @throws as `stream_log_map`
MarchStatistics stream_distances(const TangentGraph& graph, const Source& source, const StreamOptions& options,
                                 MapSink& sink);

}  // namespace ahm
