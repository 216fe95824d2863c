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
  std::vector<double> longest_at(triangulation.half_edges().tail.size(), 0.0);  // per vertex, of which there are fewer
  for (Half h = 0; h < triangulation.half_edges().size(); ++h) {
    if (triangulation.is_dropped(h / 3)) continue;
    const double length = triangulation.length(h);
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
    for (Index v : {triangulation.half_edges().tail[h], triangulation.half_edges().head(h)})
      longest_at[v] = std::max(longest_at[v], length);
  }
  double finest = longest;
  for (double length : longest_at)
    if (length > 0) finest = std::min(finest, length);
  report.finest = finest * length_unit;
  report.shortest_edge = shortest * length_unit;
  report.longest_edge = longest * length_unit;
}

/// The triangulation the graph is built from. Sides without a direction, which only flips of faces without area can make
/// once edges without length are contracted, are the only reason to change a length.
IntrinsicTriangulation triangulate(const TriangleMesh& mesh, const MeshOptions& options, MeshDetails& report) {
  IntrinsicTriangulation triangulation(mesh, false, options.threads);
  measure_edges(triangulation, mesh.length_unit(), report);
  report.collinear = triangulation.thin_faces();
  report.degenerate_faces = report.dropped_faces + static_cast<Index>(report.collinear.size());
  if (!(report.longest_edge > 0)) throw InvalidGeometry("all vertices of the mesh are at the same place");
  auto flip = [&](IntrinsicTriangulation& t) {
    return !options.intrinsic_delaunay || t.flip_to_delaunay(options.progress);
  };
  if (flip(triangulation) && triangulation.has_angles()) return triangulation;
  triangulation = IntrinsicTriangulation(mesh, true, options.threads);
  if (!flip(triangulation)) report.flips_stopped = true;
  if (!triangulation.has_angles())
    throw InvalidGeometry(
        "faces stay degenerate after mollification: edge lengths span too many orders of "
        "magnitude (" +
        detail::number(report.shortest_edge) + " to " + detail::number(report.longest_edge) + ")");
  return triangulation;
}

RowMap rows_of(const TriangleMesh& mesh) {
  return RowMap(mesh.report().vertices, mesh.vertex_count(), mesh.topology().rows());
}

exact::PolyhedralSurface polyhedron(const TriangleMesh& mesh) {
  return {mesh.topology().half_edges(), [&](Index face) { return mesh.layout(face); }, mesh.corners()};
}

/// The same without the faces that were dropped.
exact::PolyhedralSurface polyhedron_of_kept(const TriangleMesh& mesh) {
  const HalfEdges edges = mesh.topology().half_edges();
  std::vector<Half> place(edges.tail.size(), -1), corners;  // numbers among the half-edges kept
  std::vector<Index> kept;
  for (Index f = 0; f < edges.size() / 3; ++f) {
    if (mesh.is_dropped(f)) continue;
    for (int s = 0; s < 3; ++s) place[3 * f + s] = static_cast<Half>(3 * kept.size()) + s;
    kept.push_back(f);
  }
  std::vector<Index> tail;
  std::vector<Half> twin;
  std::vector<std::uint8_t> mirrored;
  for (Half h = 0; h < edges.size(); ++h) {
    if (place[h] < 0) continue;
    tail.push_back(edges.tail[h]);
    twin.push_back(edges.twin[h] < 0 ? edges.twin[h] : place[edges.twin[h]]);
    if (!edges.mirrored.empty()) mirrored.push_back(edges.mirrored[h]);
  }
  for (Half h : mesh.corners()) corners.push_back(place[h]);
  return {HalfEdges{tail, twin, mirrored}, [&](Index face) { return mesh.layout(kept[face]); }, corners};
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
  std::vector<Vec3> positions;
  if (mesh.has_positions()) {
    positions.reserve(static_cast<std::size_t>(mesh.vertex_count()));
    for (Index v = 0; v < mesh.vertex_count(); ++v) positions.push_back(mesh.original_position(Vertex(v)));
  }
  return {details().dropped_faces == 0 ? polyhedron(mesh) : polyhedron_of_kept(mesh), std::move(positions),
          mesh.length_unit()};
}

exact::MeshPoint TriangleMeshSurface::flat_point_in_face(const FacePoint& point) const {
  const TriangleMesh& mesh = impl_->mesh;
  const auto [face, weight] = impl_->stored(point);
  Index kept = 0;
  for (Index f = 0; f < face; ++f) kept += !mesh.is_dropped(f);
  return {kept, weight};
}

Surface::Reason TriangleMeshSurface::why_without_vertex(Row row) const {
  const std::vector<Index>& used = impl_->face_rows;
  if (std::find(used.begin(), used.end(), row.index) == used.end()) return Surface::why_without_vertex(row);
  return {"row_without_area", "lies in faces without area alone", "choose another one"};
}

Report TriangleMeshSurface::report() const {
  const MeshDetails& d = details();
  Report report{{"vertices", d.vertices},
                {"faces", d.topology.faces},
                {"edges", d.edges},
                {"flips", d.flips},
                {"merged_vertices", d.merged_vertices},
                {"dropped_faces", d.dropped_faces},
                {"mollification", d.mollification},
                {"degenerate_faces", d.degenerate_faces}};
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
  if (d.merged_vertices > 0)
    result.push_back({"merged", {static_cast<double>(d.merged_vertices), static_cast<double>(d.dropped_faces)}, {}});
  if (!d.collinear.empty())
    result.push_back(
        {"collinear_faces", {static_cast<double>(d.collinear.size()), static_cast<double>(d.collinear.front())}, {}});
  if (d.mollification > 0)
    result.push_back({"mollified", {static_cast<double>(d.degenerate_faces), d.mollification}, {}});
  if (d.longest_edge > 1e6 * d.finest) result.push_back({"edge_lengths", {d.finest, d.longest_edge}, {}});
  return result;
}

TriangleMeshSurface TriangleMeshSurface::build(TriangleMesh mesh, const MeshOptions& options, double seconds_checks) {
  MeshDetails details;
  details.seconds_checks = seconds_checks;
  details.topology = mesh.report();
  details.vertices = mesh.vertex_count();
  details.merged_vertices = static_cast<Index>(mesh.topology().merged().size());
  for (std::uint8_t dropped : mesh.topology().dropped()) details.dropped_faces += dropped;
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
    TriangleMesh mesh = TriangleMesh::from_positions(positions, faces, options.non_manifold, options.turned);
    return build(std::move(mesh), options, stopwatch.lap());
  });
}

}  // namespace ahm::trimesh
