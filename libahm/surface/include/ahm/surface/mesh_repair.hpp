/// \file
/// Repairs of a mesh before a surface is built from it.
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

/// The repairs to make. Edges of more than two faces and pinched vertices are not repaired but cut when the surface is built
/// (`NonManifold::split`). Building also orients neighboring faces consistently in any case.
struct RepairOptions {
  /// Merges each vertex with the nearest earlier vertex that remains and is at most this far away, world units, >= 0. 0 merges
  /// equal positions. Faces lose corners by merging; degenerate ones are dropped as by `drop_degenerate`.
  std::optional<double> weld;
  /// Removes a corner at the vertex of the corner before. Drops faces that are left with fewer than three corners, visit a
  /// vertex twice, or have a vertex whose position is not finite.
  bool drop_degenerate = false;
  bool drop_duplicates = false;  ///< keeps the first of several faces with the same vertices
  /// Reverses faces so that neighbors agree with the majority of their part and closed parts face outward. Parts that cannot be
  /// oriented stay unchanged.
  bool orient = false;

  bool any() const { return weld || drop_degenerate || drop_duplicates || orient; }
  static RepairOptions all() { return {0.0, true, true, true}; }
};

/// Counts of the repairs that were made.
struct RepairCounts {
  Index welded = 0;            ///< vertices merged with another one
  Index repeated_corners = 0;  ///< faces that lost corners and remain
  Index degenerate = 0;        ///< degenerate faces dropped
  Index not_finite = 0;        ///< faces dropped because of a vertex that is not finite
  Index duplicates = 0;        ///< duplicate faces dropped
  Index reversed = 0;          ///< faces reversed

  bool any() const { return welded || repeated_corners || degenerate || not_finite || duplicates || reversed; }
  bool operator==(const RepairCounts&) const = default;
};

/// The remaining faces in the input's order, with the input's vertex numbers.
struct RepairedMesh {
  std::vector<Index> joined;         ///< per vertex: the vertex that represents it; never a greater number
  std::vector<Offset> face_begin;    ///< faces + 1
  std::vector<Index> face_vertices;  ///< corners of the faces; only vertices that represent themselves
  std::vector<Index> given_face;     ///< per face: its number in the input; ascending
  RepairCounts counts;

  FaceList faces() const { return {face_begin, face_vertices}; }
  /// The new number of an input face; none where it was dropped.
  std::optional<Index> remaining(Index given) const;
};

/// Repairs the faces of a mesh.
/// @param positions  n, world units
/// @param faces      faces of vertices in [0, n); `begin` rises from 0 to the number of corners
/// @throws InvalidGeometry (offsets; a vertex index out of range), InvalidArgument (weld not finite or negative)
RepairedMesh repair_mesh(std::span<const Vec3> positions, const FaceList& faces, const RepairOptions& options);

/// A surface built from a repaired mesh. Its rows are the input vertices; merged rows share the vertices of the row that
/// represents them. Its faces are the remaining ones, with new numbers (`RepairedMesh::given_face`).
///
/// The report is that of the built surface, then repair.welded, repair.repeated_corners, repair.degenerate, repair.not_finite,
/// repair.duplicates, repair.reversed. The warnings are welded, repeated_corners, degenerate_dropped, not_finite_dropped,
/// duplicates_dropped, faces_reversed (each with its count), then those of the built surface. Merged vertices are not reported as
/// unreferenced.
class RepairedSurface final : public Surface {
 public:
  /// @param built      surface of the repaired faces, with one row per input vertex
  /// @param positions  input positions, one per row; those of `built` may differ where they are not finite
  /// @throws InvalidArgument (different numbers of rows)
  RepairedSurface(std::unique_ptr<const Surface> built, std::vector<Vec3> positions, RepairedMesh mesh);

  const TangentGraph& graph() const& override { return built_->graph(); }
  void graph() const&& = delete;
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
