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

/// Width d, in the frame of each vertex: U_i phi_i / |phi_i|, the unit vector away from the map's source; 0 at the source itself
/// and where opposite ways to it cancel.
/// @param map  with frames, of this graph
/// @throws InvalidArgument
VertexField distance_gradient(const TangentGraph& graph, const LogMap& map);

struct DistanceField {
  VertexField distance;  ///< width 1, world units: `LogMap::distance`
  VertexField gradient;  ///< `distance_gradient`
};

/// The distance from a source, and the direction U_i phi_i / |phi_i| of half the gradient of its square (Lemma 1): nothing
/// is differentiated. Within a few edges of the cut locus heat from both sides mixes, and directions are blended.
/// @param source   in one place; or any set of samples with offset 0: the distance to the nearest of them
/// @param options  of the map that this solves for; the variant is localized unless given, the only one for sets
/// @throws as `LogMapSolver::solve`
DistanceField distance_and_gradient(const LogMapSolver& solver, const Source& source, const MapOptions& options = {});

}  // namespace ahm
