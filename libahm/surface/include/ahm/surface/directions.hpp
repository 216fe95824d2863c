/// \file
/// Directions for the u axis of a log map: along a vector of space, or along the surface's principal curvature.
///
/// \code
/// auto up = ahm::Source::at_vertex(ahm::Vertex{7}, ahm::direction_in_frame(graph, ahm::Vertex{7}, {0, 0, 1}));   // u runs upwards
/// ahm::PrincipalCurvatures bend = ahm::curvature_directions(graph);
/// auto along = ahm::Source::at_vertex(ahm::Vertex{7}, bend.direction(ahm::Vertex{7}));                           // u: where it bends most
/// \endcode
#pragma once

#include <array>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"

namespace ahm {

/// A vector of space projected to the tangent plane of a vertex: unit length, in the frame of the vertex. For graphs
/// with d = 2 and frames in space.
/// @throws InvalidArgument (d, index, no frames, a vector that is zero, not finite or perpendicular to the plane)
std::array<double, 2> direction_in_frame(const TangentGraph& graph, Vertex vertex, const Vec3& vector);

/// Principal curvatures, n rows; NaN at vertices with too few neighbours to tell.
struct PrincipalCurvatures {
  /// n x 2: kappa_1, kappa_2 with |kappa_1| >= |kappa_2|, in 1 / world units; positive where the surface bends away
  /// from its normal, as a sphere does with normals outwards.
  std::vector<double> values;
  /// n x 2: unit vector in the frame of the vertex along which the curvature is kappa_1, up to its sign. Across it the
  /// curvature is kappa_2. Arbitrary where the two are equal.
  std::vector<double> directions;

  std::span<const double> direction(Vertex vertex) const {
    return std::span(directions).subspan(2 * static_cast<std::size_t>(vertex.index), 2);
  }
};

/// Eigenvalues and eigenvectors of the shape operator S of a paraboloid fitted to each vertex, its neighbours and
/// theirs: over the tangent plane of the vertex heights are z = t . x - (x . S x) / 2, in the sense of least squares of
/// z / |x|^2 [CP05]. First order in h on smooth surfaces; noise of the positions grows by 1 / h^2.
/// @throws InvalidArgument (d is not 2, no frames)
PrincipalCurvatures curvature_directions(const TangentGraph& graph);

}  // namespace ahm
