/// \file
/// Directions for the u axis of a log map: along a vector of space, or along a principal curvature direction.
///
/// \code
/// auto up = surface.source(ahm::Row{7}, ahm::Vec3{0, 0, 1});               // u runs upwards
/// ahm::Vec3 bend = ahm::bending_direction(surface.graph(), surface.vertex(ahm::Row{7}));
/// auto along = surface.source(ahm::Row{7}, bend);                          // u: where the surface bends most
/// ahm::PrincipalCurvatures all = ahm::curvature_directions(surface.graph());
/// \endcode
#pragma once

#include <span>
#include <string>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"

namespace ahm {

/// A vector of space projected to the tangent plane of a vertex: unit length, in the frame of the vertex. For graphs with d = 2
/// and frames in space.
/// @throws InvalidArgument (d, index, no frames; a vector that is zero or not finite; fault "axis_along_normal": a vector less
/// than `normal_error` from the normal)
Vec2 direction_in_frame(const TangentGraph& graph, Vertex vertex, const Vec3& vector);

/// The projection of a vector of space to the frame of a vertex, of any length > 0. Sufficient for `Source::at_vertex`.
Vec2 projected(const TangentGraph& graph, Vertex vertex, const Vec3& vector);

/// The components of a vector along the axes of a frame, scaled to any length > 0. `where` ends the message, for example "in
/// face 7".
/// @throws InvalidArgument (a vector that is zero or not finite; fault "axis_along_normal": a vector perpendicular to both
/// axes)
Vec2 projected(const Vec3& x, const Vec3& y, const Vec3& vector, const std::string& where);

/// Bounds on the error of normals, degrees: of meshes and input normals, and of normals estimated from points. An axis closer
/// to the normal than this is rejected, because the error of the normal decides where its projection points. Estimated normals
/// have a median error of 0.3 to 2.5 degrees and 95 % within 0.7 to 5.6 degrees (docs/guides/point_clouds.md).
inline constexpr double normal_error = 1, estimated_normal_error = 5;

/// Checks that a direction is far enough from a normal to be projected.
/// @param error  error of the normal, degrees
/// @param where  end of the message, for example "at row 7"
/// @throws InvalidArgument (fault "axis_along_normal": less than `error` from the normal; zero, not finite)
void check_off_normal(const Vec3& direction, const Vec3& normal, double error, const std::string& where);

/// A frame rotated about its normal so that its x axis is the projection of `direction`.
Frame turned(const Frame& frame, const Vec3& direction);

/// Principal curvatures, n rows; NaN at vertices with too few neighbors.
struct PrincipalCurvatures {
  /// n x 2: kappa_1, kappa_2 with |kappa_1| >= |kappa_2|, in 1 / world units; positive where the surface bends away from its
  /// normal, as on a sphere with outward normals.
  std::vector<double> values;
  /// n x 2: unit vector in the frame of the vertex along which the curvature is kappa_1, up to its sign. In the perpendicular
  /// direction the curvature is kappa_2. Arbitrary where the two are equal.
  std::vector<double> directions;

  std::span<const double> direction(Vertex vertex) const {
    return std::span(directions).subspan(2 * static_cast<std::size_t>(vertex.index), 2);
  }
};

/// Eigenvalues and eigenvectors of the shape operator S of a paraboloid fitted to each vertex, its neighbors and their
/// neighbors. Heights over the tangent plane of the vertex are z = t . x - (x . S x) / 2, by least squares of z / |x|^2 [CP05].
/// First order in h on smooth surfaces; noise of the positions grows by 1 / h^2.
/// @param threads  0: one per core; the result does not depend on it
/// @throws InvalidArgument (d is not 2, no frames)
PrincipalCurvatures curvature_directions(const TangentGraph& graph, unsigned threads = 0);

/// Unit vector in space along which the surface bends most at a vertex, up to its sign.
/// @param threads  as in `curvature_directions`
/// @throws InvalidArgument (as `curvature_directions`; fault "no_bending_direction": too few neighbors; a surface that is flat
/// or bends equally in all directions; neighbors whose directions contradict each other)
Vec3 bending_direction(const TangentGraph& graph, Vertex vertex, unsigned threads = 0);

}  // namespace ahm
