/// \file
/// A surface of a repaired mesh, on the rows that were given.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "ahm/surface/mesh_repair.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm {

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
  std::vector<Vec2> on_corners(const LogMap& map) const override { return built_->on_corners(map); }
  Report report() const override;
  std::vector<Warning> warnings() const override;
  const RepairedMesh& mesh() const noexcept { return mesh_; }

 protected:
  PlacedSource source_in_face(const FacePoint& point, const std::optional<Vec3>& u_axis) const override;
  PlacedSource source_on_edge(const EdgePoint& point, const std::optional<Vec3>& u_axis) const override;
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
