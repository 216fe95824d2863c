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

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ahm/surface/mesh_topology.hpp"
#include "ahm/surface/surface.hpp"
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

/// Rows are the vertices given: those that were joined share the vertices of the one that stands for them. Faces are those
/// that remained, with new numbers (`RepairedMesh::given_face`).
///
/// Its report: that of the surface built, then repair.welded, repair.shortened, repair.degenerate, repair.not_finite,
/// repair.duplicates, repair.turned. Its warnings: welded, faces_shortened, degenerate_dropped, not_finite_dropped,
/// duplicates_dropped, faces_turned (each with its number), then those of the surface built, where joined vertices do not
/// count as unreferenced.
class RepairedSurface final : public Surface {
 public:
  /// @param built      of the repaired faces, with a row for every vertex given
  /// @param positions  as given, one per row; those of `built` may differ where they are not finite
  /// @throws InvalidArgument where the numbers of rows differ
  RepairedSurface(std::unique_ptr<const Surface> built, std::vector<Vec3> positions, RepairedMesh mesh);

  const TangentGraph& graph() const& override { return built_->graph(); }
  void graph() && = delete;
  const RowMap& rows() const override { return rows_; }
  std::span<const Vec3> positions() const override { return positions_; }
  FaceList faces() const override { return built_->faces(); }
  std::span<const Index> corner_vertices() const override { return built_->corner_vertices(); }
  FlatTriangles flat_triangles() const override;
  FlatTriangles flat_approximation() const override;
  Method suggested_method() const override { return built_->suggested_method(); }
  std::vector<Vec2> to_corners(const LogMap& map) const override { return built_->to_corners(map); }
  Report report() const override;
  std::vector<Warning> warnings() const override;
  const RepairedMesh& mesh() const noexcept { return mesh_; }

 protected:
  SurfaceSource source_in_face(const FacePoint& point, const std::optional<Vec3>& u_axis) const override;
  SurfaceSource source_on_edge(const EdgePoint& point, const std::optional<Vec3>& u_axis) const override;
  Sample sample_in_face(const LogMap& map, const FacePoint& point) const override;
  exact::MeshPoint flat_point_in_face(const FacePoint& point) const override;
  FacePoint face_point(const EdgePoint& point) const override;

 private:
  EdgePoint joined(const EdgePoint& point) const;

  std::unique_ptr<const Surface> built_;
  std::vector<Vec3> positions_;
  RepairedMesh mesh_;
  RowMap rows_;
};

}  // namespace ahm
