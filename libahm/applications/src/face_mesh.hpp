/// \file
/// The faces of a surface as triangles in space, and curves on them.
#pragma once

#include <span>
#include <vector>

#include "ahm/surface/exact/polyhedral_surface.hpp"
#include "ahm/surface/surface.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// Triangles in space that are glued along their sides. Every point has one fan of triangles.
struct FaceMesh {
  std::vector<Vec3> points;
  std::vector<Triangle> faces;
  std::vector<Index> vertices;         ///< per point: vertex of the surface's graph; -1: none
  std::vector<detail::Half> twin;      ///< opposite side of each side, side s of face f is 3 f + s; on the boundary -1
  std::vector<std::uint8_t> mirrored;  ///< 1 where the faces of a side have opposite orientations

  std::size_t size() const { return faces.size(); }
  Index tail(detail::Half h) const { return faces[static_cast<std::size_t>(h / 3)][static_cast<std::size_t>(h % 3)]; }
  Index head(detail::Half h) const { return tail(detail::next(h)); }
  Vec3 position(const exact::MeshPoint& point) const;
  /// Twice the area of a face times its unit normal.
  Vec3 area_normal(Index face) const;
  double area(Index face) const;
};

/// Glues triangles: sides between the same two points are twins, where they are exactly two. Points with several fans of
/// faces are split, and points without faces dropped.
FaceMesh glued(std::vector<Vec3> points, std::vector<Triangle> faces, std::vector<Index> vertices);

/// The faces of a surface. Flat polygons are triangulated as for exact geodesics, twisted ones as fans from their first
/// corner. A cloud has the triangles of `Surface::flat_approximation`.
/// @throws InvalidArgument (no positions; a cloud without triangles: as `Surface::flat_approximation`)
FaceMesh face_mesh(const Surface& surface);

/// A polyline on a mesh. Between consecutive points it is straight inside a face.
struct MeshCurve {
  std::vector<exact::MeshPoint> points;  ///< a closed curve does not repeat its first point
  std::vector<Index> faces;              ///< face of the segment after each point; an open curve has one fewer
  bool closed = false;
};

/// The curves on which the linear interpolation of a function has a value. Larger values are on the left. Faces with a NaN
/// are left out. Each curve has at least two different points.
/// @param values  one per point
std::vector<MeshCurve> level_curves(const FaceMesh& mesh, std::span<const double> values, double level);

/// The point of a side at a share of it, from its tail.
exact::MeshPoint on_side(detail::Half side, double share);

/// A point of a face in the barycentric coordinates of another face that contains it. @param face  the other face
exact::MeshPoint in_face(const FaceMesh& mesh, const exact::MeshPoint& point, Index face);

}  // namespace ahm
