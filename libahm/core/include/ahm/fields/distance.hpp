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

struct DistanceField {
  VertexField distance;  ///< width 1, world units
  /// Width d, in the frame of each vertex: the unit vector away from the source; 0 where the radial field is,
  /// i.e. at the source itself and where opposite ways to it cancel.
  VertexField gradient;
};

/// Length and direction of the radial field Y_x = - log_x(source), half the gradient of the squared distance (Lemma 1):
/// no distance is differentiated. One solve by A and one by B.
///
/// The distance is that of the localized variant. Within a few edges of the cut locus heat from both sides mixes:
/// distances are too short there, and directions blended.
/// @param source  in one place; or any set of samples with offset 0: the distance to the nearest of them
/// @param options  threads
/// @throws InvalidArgument when the source does not fit the graph; as `radial_field`
DistanceField distance_and_gradient(const LogMapSolver& solver, const Source& source, const MapOptions& options = {});

}  // namespace ahm
