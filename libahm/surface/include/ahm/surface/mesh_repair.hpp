/// \file
/// What can be mended in a mesh before a surface is built of it.
///
/// \code
/// const auto repaired = ahm::repair_mesh(points, faces, ahm::RepairOptions::all());
/// auto built = std::make_unique<ahm::polymesh::PolygonMeshSurface>(ahm::polymesh::PolygonMeshSurface::build(
///     points, repaired.face_begin, repaired.face_vertices, {.non_manifold = ahm::NonManifold::split}));
/// const ahm::RepairedSurface surface(std::move(built), points, repaired);   // rows are those of `points` again
/// \endcode
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ahm/surface/mesh_topology.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// What is to be mended. Edges of more than two faces and pinched vertices are cut when the surface is built
/// (`NonManifold::split`), and neighbouring faces are turned alike there in any case.
struct RepairOptions {
  /// Joins a vertex to the nearest one before it that stays and is at most this far away, world units, >= 0; 0: at equal
  /// positions. Faces lose corners by it, and are dropped as by `drop_degenerate`.
  std::optional<double> weld;
  /// A corner at the vertex of the corner before it is left out; faces that are left with fewer than three corners, or come
  /// to a vertex twice, or have one whose position is not finite, are dropped.
  bool drop_degenerate = false;
  bool drop_duplicates = false;  ///< of faces with the same vertices the first remains
  /// Turns faces over so that neighbours agree, as the majority of their part does, and closed parts look outwards. Parts
  /// that cannot be oriented stay as they are.
  bool orient = false;

  bool any() const { return weld || drop_degenerate || drop_duplicates || orient; }
  static RepairOptions all() { return {0.0, true, true, true}; }
};

/// What was done.
struct RepairCounts {
  Index welded = 0;      ///< vertices joined to another one
  Index shortened = 0;   ///< faces that lost corners and remain
  Index degenerate = 0;  ///< faces dropped, likewise
  Index not_finite = 0;  ///< faces dropped for a vertex that is not finite
  Index duplicates = 0;  ///< faces dropped
  Index turned = 0;      ///< faces turned over

  bool any() const { return welded || shortened || degenerate || not_finite || duplicates || turned; }
  bool operator==(const RepairCounts&) const = default;
};

/// The faces that remain, in their order, of the same vertices.
struct RepairedMesh {
  std::vector<Index> joined;         ///< per vertex: the one that stands for it, which has no greater number
  std::vector<Offset> face_begin;    ///< faces + 1
  std::vector<Index> face_vertices;  ///< those that stand for others, and those that were not joined
  std::vector<Index> given_face;     ///< per face, its number as given; ascending
  RepairCounts counts;

  FaceList faces() const { return {face_begin, face_vertices}; }
  /// The number of a face that was given; none where it was dropped.
  std::optional<Index> remaining(Index given) const;
};

/// @param positions  n, world units
/// @param faces      of vertices in [0, n); `begin` rises from 0 to the number of corners
/// @throws InvalidGeometry (offsets; a vertex that there is not), InvalidArgument (weld not finite or negative)
RepairedMesh repair_mesh(std::span<const Vec3> positions, const FaceList& faces, const RepairOptions& options);

}  // namespace ahm
