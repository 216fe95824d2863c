/// \file
/// Geodesic distance and its gradient (Sec. 5, Figs. 20 and 21).
///
/// \code
/// ahm::DistanceField field = ahm::distance_and_gradient(solver, ahm::Source::at_vertex(ahm::Vertex{3}));
/// const double* away = &field.gradient.values[2 * i];                  // unit vector in frame i, away from vertex 3
/// \endcode
#pragma once

#include "ahm/fields/vector_heat.hpp"

namespace ahm {

/// The gradient of the distance: U_i phi_i / |phi_i|, the unit vector away from the map's source. Width d, in the frame of each
/// vertex. 0 at the source, and where opposite geodesic paths to it cancel.
/// @param map  map of this graph, with frames
/// @throws InvalidArgument
VertexField distance_gradient(const TangentGraph& graph, const LogMap& map);

struct DistanceField {
  VertexField distance;  ///< width 1, world units: `LogMap::distance`
  VertexField gradient;  ///< `distance_gradient`
};

/// The distance from a source and its gradient. The gradient is the direction U_i phi_i / |phi_i| of half the gradient of the squared
/// distance (Lemma 1), so nothing is differentiated. Within a few edges of the cut locus, directions from both sides are blended.
/// @param source   a source at one point, or a set of samples with offset 0; then the distance is that from the nearest sample
/// @param options  options of the map. The default variant is localized, the only one for sets of samples
/// @throws as `LogMapSolver::solve`
DistanceField distance_and_gradient(const LogMapSolver& solver, const Source& source, const MapOptions& options = {});

}  // namespace ahm
