/// \file
/// Geodesic Voronoi cells and farthest point sampling ([SS25] Sec. 5; [SSC19] Sec. 8.5).
///
/// \code
/// auto seeds = ahm::farthest_points(graph, ahm::Vertex{0}, 12);  // 12 vertices spread evenly, the first is vertex 0
/// auto cells = ahm::voronoi_cells(graph, seeds);                 // per vertex: which of the 12 is nearest, how far away
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/progress.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"

namespace ahm {

struct VoronoiCells {
  /// Nearest source of each vertex, as an index into `vertices`; -1 in components without a source.
  std::vector<Index> labels;
  /// Distance of each vertex from its nearest source, world units; NaN in components without a source. Where the graph has
  /// frames, no distance is shorter than the straight line in space.
  std::vector<double> distances;
};

/// Geodesic Voronoi cells by a wavefront (`Wavefront`), in one pass for any number of sources. Up to ties, cells are exact
/// on flat Delaunay triangulations of convex outline. Around a reentrant corner of the boundary distances are slightly too
/// long.
/// @throws InvalidArgument (no vertices, index, a vertex that occurs twice), ResourceExhausted
VoronoiCells voronoi_cells(const TangentGraph& graph, std::span<const Vertex> vertices);
/// Voronoi cells by a front whose points are the first of `vertices`, or that has none. The other vertices are added; only
/// what is nearer to them is updated.
/// @throws as the overload for graphs; InvalidArgument (a front with more points than `vertices`)
VoronoiCells voronoi_cells(Wavefront& front, std::span<const Vertex> vertices);
/// Voronoi cells by exact distances over the flat faces.
/// @param options  radius, beyond which there are no cells; progress
/// @throws as the overload for graphs, as `ExactGeodesics::log_map`
VoronoiCells voronoi_cells(const ExactGeodesics& geodesics, std::span<const Vertex> vertices,
                           const ExactMapOptions& options = {});

/// `count` vertices, beginning with `first`; each is the farthest from the previous ones. Vertices of components without a
/// point are infinitely far. Each new point updates only the vertices that are nearer to it than to the previous ones.
/// @param progress  stage "farthest points"; checked before every point
/// @param among     candidates, for example the vertices that have rows (`vertices_with_rows`); empty: all vertices
/// @throws InvalidArgument (index; count less than 1 or more than the candidates), ResourceExhausted, Cancelled
std::vector<Vertex> farthest_points(const TangentGraph& graph, Vertex first, Index count, const Progress& progress = {},
                                    std::span<const Vertex> among = {});
/// Farthest points by a front without points. Afterwards the front has all of them but the last, so that `voronoi_cells`
/// can continue it.
/// @throws as the overload for graphs; InvalidArgument (a front with points)
std::vector<Vertex> farthest_points(Wavefront& front, Vertex first, Index count, const Progress& progress = {},
                                    std::span<const Vertex> among = {});
/// Farthest points by exact distances over the flat faces; of equally far vertices the first is taken.
/// @param options  progress, as in the overload for graphs. The radius is ignored
/// @throws as the overload for graphs, as `ExactGeodesics::log_map`
std::vector<Vertex> farthest_points(const ExactGeodesics& geodesics, Vertex first, Index count,
                                    const ExactMapOptions& options = {}, std::span<const Vertex> among = {});

}  // namespace ahm
