#include "ahm/surface/repaired_surface.hpp"

#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"

namespace ahm {
namespace {

RowMap rows_of(const Surface& built, const RepairedMesh& mesh) {
  std::vector<RowVertex> pairs;
  for (std::size_t r = 0; r < mesh.joined.size(); ++r)
    for (Vertex vertex : built.rows().vertices(Row(mesh.joined[r])))
      pairs.push_back({Row(static_cast<Index>(r)), vertex});
  return RowMap(static_cast<Index>(mesh.joined.size()), built.rows().vertex_count(), pairs);
}

/// Vertices that no face uses, nor does the one that stands for them.
double unreferenced(const RepairedMesh& mesh) {
  std::vector<bool> used(mesh.joined.size(), false);
  for (Index v : mesh.face_vertices) used[v] = true;
  double count = 0;
  for (Index v : mesh.joined) count += !used[v];
  return count;
}

}  // namespace

RepairedSurface::RepairedSurface(std::unique_ptr<const Surface> built, std::vector<Vec3> positions, RepairedMesh mesh)
    : built_(std::move(built)), positions_(std::move(positions)), mesh_(std::move(mesh)) {
  const auto rows = static_cast<std::size_t>(built_->rows().row_count());
  if (rows != mesh_.joined.size() || rows != positions_.size())
    throw InvalidArgument("the surface has " + std::to_string(rows) + " rows, the repaired mesh " +
                          std::to_string(mesh_.joined.size()) + " vertices and " + std::to_string(positions_.size()) +
                          " positions");
  rows_ = rows_of(*built_, mesh_);
}

FlatTriangles RepairedSurface::flat_triangles() const { return built_->flat_triangles(); }

FlatTriangles RepairedSurface::flat_approximation() const { return built_->flat_approximation(); }

Report RepairedSurface::report() const {
  Report report = built_->report();
  const RepairCounts& c = mesh_.counts;
  report.push_back({"repair.welded", c.welded});
  report.push_back({"repair.shortened", c.shortened});
  report.push_back({"repair.degenerate", c.degenerate});
  report.push_back({"repair.not_finite", c.not_finite});
  report.push_back({"repair.duplicates", c.duplicates});
  report.push_back({"repair.turned", c.turned});
  return report;
}

std::vector<Warning> RepairedSurface::warnings() const {
  std::vector<Warning> result;
  const auto warn = [&](std::string_view id, double count) {
    if (count > 0) result.push_back({id, {count}, {}});
  };
  const RepairCounts& c = mesh_.counts;
  warn("welded", c.welded);
  warn("faces_shortened", c.shortened);
  warn("degenerate_dropped", c.degenerate);
  warn("not_finite_dropped", c.not_finite);
  warn("duplicates_dropped", c.duplicates);
  warn("faces_turned", c.turned);
  for (Warning& warning : built_->warnings())
    warning.id == "unreferenced" ? warn(warning.id, unreferenced(mesh_)) : result.push_back(std::move(warning));
  return result;
}

PlacedSource RepairedSurface::source_in_face(const FacePoint& point, const std::optional<Vec3>& u_axis) const {
  return built_->source(point, u_axis);
}

PlacedSource RepairedSurface::source_on_edge(const EdgePoint& point, const std::optional<Vec3>& u_axis) const {
  return built_->source(joined(point), u_axis);
}

Sample RepairedSurface::sample_in_face(const LogMap& map, const FacePoint& point) const {
  return built_->at(map, point);
}

exact::MeshPoint RepairedSurface::flat_point_in_face(const FacePoint& point) const { return built_->flat_point(point); }

FacePoint RepairedSurface::face_point(const EdgePoint& point) const { return Surface::face_point(joined(point)); }

EdgePoint RepairedSurface::joined(const EdgePoint& point) const {
  EdgePoint result = point;
  result.from = Row(mesh_.joined[point.from.index]);
  result.to = Row(mesh_.joined[point.to.index]);
  return result;
}

}  // namespace ahm
