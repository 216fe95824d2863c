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
  /// Per vertex the position in `vertices` of the nearest source; -1 in components without one.
  std::vector<Index> labels;
  /// Per vertex the distance from that source, world units, no shorter than the straight line in space where the graph has frames; NaN
  /// in components without a source.
  std::vector<double> distances;
};

/// Cells by geodesic distance (`Wavefront`), all in one pass whatever the number of sources. Exact to ties on flat
/// Delaunay triangulations of convex outline: around a corner of the boundary that points inwards ways come out a little too long.
/// @throws InvalidArgument (empty, index, a vertex given twice), ResourceExhausted
VoronoiCells voronoi_cells(const TangentGraph& graph, std::span<const Vertex> vertices);
/// The same by a front that has come from the first of these vertices before, if from any: it goes on from the others, over what is
/// nearer to them.
/// @throws as above; InvalidArgument (more points than vertices)
VoronoiCells voronoi_cells(Wavefront& front, std::span<const Vertex> vertices);
/// The same by exact distances over the flat faces.
/// @param options  radius, beyond which there are no cells; tolerance; progress
/// @throws as above, as `ExactGeodesics::log_map`
VoronoiCells voronoi_cells(const ExactGeodesics& geodesics, std::span<const Vertex> vertices,
                           const ExactMapOptions& options = {});

/// `count` vertices, each the farthest from those before it, beginning with `first`; vertices of components without one
/// count as infinitely far. Each one costs what is nearer to it than to those before.
/// @param progress  stage "farthest points"; asked before every point
/// @param among     vertices to choose from, as those of rows (`vertices_with_rows`); empty: all
/// @throws InvalidArgument (index, count not in [1, n], n of those to choose from), ResourceExhausted, Cancelled
std::vector<Vertex> farthest_points(const TangentGraph& graph, Vertex first, Index count, const Progress& progress = {},
                                    std::span<const Vertex> among = {});
/// The same by a front that has not come from anywhere; it has come from all of them but the last then, so that `voronoi_cells` goes on
/// from there.
/// @throws as above; InvalidArgument (a front with points)
std::vector<Vertex> farthest_points(Wavefront& front, Vertex first, Index count, const Progress& progress = {},
                                    std::span<const Vertex> among = {});
/// The same by exact distances over the flat faces; of equally far vertices the first.
/// @param options  tolerance; progress, as above. Points spread over everything, whatever the radius
/// @throws as above, as `ExactGeodesics::log_map`
std::vector<Vertex> farthest_points(const ExactGeodesics& geodesics, Vertex first, Index count,
                                    const ExactMapOptions& options = {}, std::span<const Vertex> among = {});

}  // namespace ahm
