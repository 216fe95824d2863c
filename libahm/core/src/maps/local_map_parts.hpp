/// \file
/// Parts of local maps that all methods share: checks of the options, radii, memory, and the assembly of the result.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/source.hpp"
#include "maps/patch_maps.hpp"

namespace ahm {

/// Checks radius and k. @throws InvalidArgument
void check_extent(const LocalMapOptions& options);

/// Whether a vertex counts as a neighbor.
inline bool is_neighbor(const LocalMapOptions& options, Index vertex) {
  return !options.is_neighbor || options.is_neighbor(Vertex(vertex));
}

/// An upper bound of the distance of the k nearest neighbors, world units: the length of the edge path to the k-th neighbor on edge paths.
struct NearestRadius {
  double radius;
  bool is_complete;  ///< the component has fewer than k neighbors, all within the radius
  Index vertices;    ///< number of vertices on edge paths of at most this length, at least k unless `is_complete`
};
/// @param ball  workspace for `graph`
NearestRadius radius_of_nearest(const TangentGraph& graph, Ball& ball, const Source& source,
                                const LocalMapOptions& options);

/// Checks the memory for the result. Estimates the median number of vertices within the radius from a sample of the sources.
/// @param radius  radius(s): radius of source s, world units
/// @throws ResourceExhausted
void check_memory(const TangentGraph& graph, std::span<const Source> sources,
                  const std::function<double(std::size_t)>& radius, const LocalMapOptions& options);

/// The entries of one or several sources, in their order.
struct LocalEntries {
  std::vector<Vertex> vertices;
  std::vector<double> logs, distances, transports, quality;
};

/// Appends entries to maps, except for `indptr`. Frees the parts one by one.
/// @param total  expected number of entries of the maps in the end: memory for as many is reserved at the first call
void append(const TangentGraph& graph, std::vector<LocalEntries>& entries, std::size_t total, LocalMaps& maps,
            unsigned threads);

/// The maps of all entries.
LocalMaps joined(const TangentGraph& graph, std::vector<Offset> indptr, std::vector<LocalEntries>& entries,
                 unsigned threads);

}  // namespace ahm
