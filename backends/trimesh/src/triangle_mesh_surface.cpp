#include "ahm/trimesh/triangle_mesh_surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/stopwatch.hpp"
#include "ahm/util/text.hpp"
#include "impl.hpp"
#include "mesh_edges.hpp"

namespace ahm::trimesh {
namespace {

void measure_edges(const IntrinsicTriangulation& triangulation, double length_unit, MeshDetails& report) {
  double shortest = HUGE_VAL, longest = 0;
  for (Half h = 0; h < triangulation.half_edges().size(); ++h) {
    const double length = triangulation.length(h);
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  report.shortest_edge = shortest * length_unit;
  report.longest_edge = longest * length_unit;
}

/// The triangulation the graph is built from. Flips alone heal flat caps, and leave good faces as they are;
/// mollification changes every length, so it comes second.
IntrinsicTriangulation triangulate(const TriangleMesh& mesh, const MeshOptions& options, MeshDetails& report) {
  IntrinsicTriangulation triangulation(mesh, false, options.threads);
  measure_edges(triangulation, mesh.length_unit(), report);
  report.degenerate_faces = triangulation.count_degenerate();
  if (!(report.longest_edge > 0)) throw InvalidGeometry("all vertices of the mesh are at the same place");
  auto flip = [&](IntrinsicTriangulation& t) {
    return !options.intrinsic_delaunay || t.flip_to_delaunay(options.progress);
  };
  if (!triangulation.has_collapsed_sides() && flip(triangulation) && triangulation.count_degenerate() == 0)
    return triangulation;
  triangulation = IntrinsicTriangulation(mesh, true, options.threads);
  if (!flip(triangulation)) report.flips_stopped = true;
  if (const Index count = triangulation.count_degenerate(); count > 0)
    throw InvalidGeometry(std::to_string(count) +
                          " faces stay degenerate after mollification: edge lengths span too many orders of "
                          "magnitude (" +
                          detail::number(report.shortest_edge) + " to " + detail::number(report.longest_edge) + ")");
  return triangulation;
}

RowMap rows_of(const TriangleMesh& mesh) {
  std::vector<RowVertex> pairs;
  for (Index v = 0; v < mesh.vertex_count(); ++v) pairs.push_back({Row(mesh.input_of_vertex()[v]), Vertex(v)});
  return RowMap(mesh.report().vertices, mesh.vertex_count(), pairs);
}

}  // namespace

TriangleMeshSurface::TriangleMeshSurface(std::unique_ptr<const Impl> impl) : impl_(std::move(impl)) {}
TriangleMeshSurface::~TriangleMeshSurface() = default;
TriangleMeshSurface::TriangleMeshSurface(TriangleMeshSurface&&) noexcept = default;
TriangleMeshSurface& TriangleMeshSurface::operator=(TriangleMeshSurface&&) noexcept = default;

const CsrGraph& TriangleMeshSurface::graph() const& { return impl_->graph; }
const RowMap& TriangleMeshSurface::rows() const { return impl_->rows; }
std::span<const Vec3> TriangleMeshSurface::positions() const { return impl_->mesh.input_positions(); }
FaceList TriangleMeshSurface::faces() const { return {impl_->mesh.topology().face_begin(), impl_->face_rows}; }
std::span<const Index> TriangleMeshSurface::corner_vertices() const { return impl_->mesh.tails(); }
const MeshDetails& TriangleMeshSurface::details() const noexcept { return impl_->details; }
const TriangleMesh& TriangleMeshSurface::mesh() const noexcept { return impl_->mesh; }

FlatTriangles TriangleMeshSurface::flat_triangles() const {
  const TriangleMesh& mesh = impl_->mesh;
  std::vector<exact::FaceSides> sides;
  for (Index f = 0; f < mesh.face_count(); ++f) sides.push_back(mesh.layout(f));
  std::vector<Vec3> positions;
  if (mesh.has_positions())
    for (Index v = 0; v < mesh.vertex_count(); ++v) positions.push_back(mesh.original_position(v));
  return {{mesh.topology().half_edges(), sides, mesh.corners()}, std::move(positions), mesh.length_unit()};
}

exact::MeshPoint TriangleMeshSurface::flat_point_in_face(const FacePoint& point) const {
  exact::MeshPoint result{point.face, {}};
  for (int s = 0; s < 3; ++s) result.barycentric[impl_->mesh.stored_corner(point.face, s)] = point.barycentric[s];
  return result;
}

Report TriangleMeshSurface::report() const {
  const MeshDetails& d = details();
  Report report{{"vertices", d.vertices}, {"faces", d.topology.faces},        {"edges", d.edges},
                {"flips", d.flips},       {"mollification", d.mollification}, {"degenerate_faces", d.degenerate_faces}};
  const Report topology = figures(d.topology);
  report.insert(report.end(), topology.begin(), topology.end());
  report.push_back({"seconds.checks", d.seconds_checks});
  report.push_back({"seconds.delaunay", d.seconds_delaunay});
  report.push_back({"seconds.graph", d.seconds_graph});
  return report;
}

std::vector<Warning> TriangleMeshSurface::warnings() const {
  const MeshDetails& d = details();
  std::vector<Warning> result;
  if (d.flips_stopped) result.push_back({"flips_stopped", {}, {}});
  const std::vector<Warning> topology = ahm::warnings(d.topology);
  result.insert(result.end(), topology.begin(), topology.end());
  if (d.mollification > 0)
    result.push_back({"mollified", {static_cast<double>(d.degenerate_faces), d.mollification}, {}});
  if (d.longest_edge > 1e6 * d.shortest_edge) result.push_back({"edge_lengths", {d.shortest_edge, d.longest_edge}, {}});
  return result;
}

TriangleMeshSurface TriangleMeshSurface::build(TriangleMesh mesh, const MeshOptions& options, double seconds_checks) {
  MeshDetails details;
  details.seconds_checks = seconds_checks;
  details.topology = mesh.report();
  details.vertices = mesh.vertex_count();
  detail::Stopwatch stopwatch;
  options.progress.step("flips", 0.0);
  IntrinsicTriangulation triangulation = triangulate(mesh, options, details);
  details.flips = static_cast<Offset>(triangulation.history().size());
  details.history_bytes = static_cast<Offset>(triangulation.history().bytes());
  details.mollification = triangulation.mollification() * mesh.length_unit();
  options.progress.step("flips", 1.0);
  details.seconds_delaunay = stopwatch.lap();

  VertexFrames frames = find_frames(mesh, triangulation, options.threads);
  CsrGraphData data = mesh_edges(mesh, triangulation, frames, options.clamp_weights, options.threads, details);
  data.is_delaunay = options.intrinsic_delaunay;
  data.frames = frames_in_space(mesh, options.threads);
  options.progress.step("graph", 1.0);
  details.seconds_graph = stopwatch.lap();
  RowMap rows = rows_of(mesh);
  std::vector<Index> face_rows = mesh.topology().given_corners();
  return TriangleMeshSurface(
      std::make_unique<const Impl>(Impl{std::move(mesh), std::move(triangulation), std::move(frames),
                                        CsrGraph(std::move(data)), details, std::move(rows), std::move(face_rows)}));
}

TriangleMeshSurface TriangleMeshSurface::build(TriangleMesh mesh, const MeshOptions& options) {
  return detail::with_memory_check("building the graph of a triangle mesh",
                                   [&] { return build(std::move(mesh), options, 0.0); });
}

TriangleMeshSurface TriangleMeshSurface::build(std::span<const Vec3> positions, std::span<const Triangle> faces,
                                               const MeshOptions& options) {
  const std::string what = "building the graph of a mesh of " + std::to_string(faces.size()) + " faces";
  return detail::with_memory_check(what, [&] {
    detail::Stopwatch stopwatch;
    options.progress.step("checks", 0.0);
    TriangleMesh mesh = TriangleMesh::from_positions(positions, faces, options.non_manifold);
    return build(std::move(mesh), options, stopwatch.lap());
  });
}

}  // namespace ahm::trimesh
