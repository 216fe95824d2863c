/// \file
/// One log map of a graph that need not fit into memory. A march computes it and passes each vertex to a sink.
///
/// \code
/// struct Rows final : ahm::MapSink {
///   void add(ahm::Index vertex, const ahm::MapRow& row) override { std::cout << vertex << ' ' << row.distance << '\n'; }
/// } rows;
/// ahm::stream_log_map(graph, ahm::Source::at_vertex(ahm::Vertex{0}), {}, rows);
/// \endcode
#pragma once

#include <limits>
#include <span>

#include "ahm/maps/log_map_solver.hpp"

namespace ahm {

/// The result at one vertex. Numbers are NaN where the status is not `ok`. Lengths in world units.
struct MapRow {
  Status status;                        ///< ok, beyond_radius or unreached
  std::span<const double> coordinates;  ///< phi, d numbers in the source's frame; empty for `stream_distances`
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

/// Receives the rows of a streamed map.
class MapSink {
 public:
  virtual ~MapSink() = default;
  /// Called once for each vertex that the march reaches, from one thread, in the order of the march. `row` is valid during the call.
  virtual void add(Index vertex, const MapRow& row) = 0;
};

/// Computes the map of a `LogMapSolver` with strategy `march`, with the same bits. Vertices for which `sink` gets no row are beyond the
/// radius, have no heat, or are in a component without a source.
///
/// Memory is proportional to the front of the march: about 300 bytes per vertex of a band, plus the factors of the band. In addition there
/// are 10 bytes per 256 vertices of the graph. The march requests stars near its front only, from one thread. If the graph `is_delaunay`,
/// distances are first unfolded by a wavefront, which stores 30 bytes per vertex of the graph.
/// @param graph    must provide `component_edge_length` for every vertex. It is not validated
/// @param source   points, not a curve
/// @throws InvalidArgument (source, options, a graph of another kind), InvalidGraph (an edge without its reverse edge),
///         NotPositiveDefinite (of a band), Cancelled, and exceptions of graph and sink
MarchStatistics stream_log_map(const TangentGraph& graph, const Source& source, const StreamOptions& options,
                               MapSink& sink);

/// Computes only the distances and the spread of the localized map. The options' variant is ignored. The distances have the same bits as in
/// the map; the spread is equal up to rounding. No frames are computed, which saves one of the two solves with B in every band.
/// @throws as `stream_log_map`
MarchStatistics stream_distances(const TangentGraph& graph, const Source& source, const StreamOptions& options,
                                 MapSink& sink);

}  // namespace ahm
