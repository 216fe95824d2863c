#include "ahm/trimesh/triangle_mesh_graph.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/stopwatch.hpp"
#include "ahm/util/text.hpp"
#include "impl.hpp"
#include "mesh_edges.hpp"

namespace ahm::trimesh {
namespace {

void measure_edges(const IntrinsicTriangulation& triangulation, double length_unit, MeshReport& report) {
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
IntrinsicTriangulation triangulate(const TriangleMesh& mesh, const MeshOptions& options, MeshReport& report) {
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
  if (!flip(triangulation)) report.warnings.push_back("edge flips were stopped before all edges were Delaunay");
  if (const Index count = triangulation.count_degenerate(); count > 0)
    throw InvalidGeometry(std::to_string(count) +
                          " faces stay degenerate after mollification: edge lengths span too many orders of "
                          "magnitude (" +
                          detail::number(report.shortest_edge) + " to " + detail::number(report.longest_edge) + ")");
  return triangulation;
}

void add_warnings(MeshReport& report) {
  const TopologyReport& t = report.topology;
  auto warn = [&](auto count, const std::string& text) {
    if (count > 0) report.warnings.push_back(std::to_string(count) + text);
  };
  warn(t.unreferenced, " vertices are used by no face and were left out");
  warn(t.reoriented, " faces were turned over to orient the mesh consistently");
  warn(t.non_manifold_edges, " edges with more than two faces were cut");
  warn(t.non_manifold_vertices, " additional vertices were made where several fans of faces met");
  if (!t.orientable) report.warnings.push_back("the mesh is not orientable; it is solved with reflections");
  if (t.components > 1)
    report.warnings.push_back("the mesh falls into " + std::to_string(t.components) +
                              " components; a map covers those that hold its source");
  if (report.mollification > 0)
    report.warnings.push_back(std::to_string(report.degenerate_faces) +
                              " degenerate faces: every edge was made longer by " +
                              detail::number(report.mollification));
  if (report.longest_edge > 1e6 * report.shortest_edge)
    report.warnings.push_back("edge lengths range from " + detail::number(report.shortest_edge) + " to " +
                              detail::number(report.longest_edge) + "; one diffusion time cannot suit them all");
}

}  // namespace

TriangleMeshGraph::TriangleMeshGraph(std::unique_ptr<const Impl> impl) : impl_(std::move(impl)) {}
TriangleMeshGraph::~TriangleMeshGraph() = default;
TriangleMeshGraph::TriangleMeshGraph(TriangleMeshGraph&&) noexcept = default;
TriangleMeshGraph& TriangleMeshGraph::operator=(TriangleMeshGraph&&) noexcept = default;

const CsrGraph& TriangleMeshGraph::graph() const& noexcept { return impl_->graph; }
const MeshReport& TriangleMeshGraph::report() const noexcept { return impl_->report; }
const TriangleMesh& TriangleMeshGraph::mesh() const noexcept { return impl_->mesh; }

TriangleMeshGraph TriangleMeshGraph::build(TriangleMesh mesh, const MeshOptions& options, double seconds_checks) {
  MeshReport report;
  report.seconds_checks = seconds_checks;
  report.topology = mesh.report();
  report.vertices = mesh.vertex_count();
  detail::Stopwatch stopwatch;
  options.progress.step("flips", 0.0);
  IntrinsicTriangulation triangulation = triangulate(mesh, options, report);
  report.flips = static_cast<Offset>(triangulation.history().size());
  report.history_bytes = static_cast<Offset>(triangulation.history().bytes());
  report.mollification = triangulation.mollification() * mesh.length_unit();
  options.progress.step("flips", 1.0);
  report.seconds_delaunay = stopwatch.lap();

  VertexFrames frames = find_frames(mesh, triangulation, options.threads);
  CsrGraphData data = mesh_edges(mesh, triangulation, frames, options.clamp_weights, options.threads, report);
  data.frames = frames_in_space(mesh, options.threads);
  add_warnings(report);
  options.progress.step("graph", 1.0);
  report.seconds_graph = stopwatch.lap();
  return TriangleMeshGraph(std::make_unique<const Impl>(Impl{
      std::move(mesh), std::move(triangulation), std::move(frames), CsrGraph(std::move(data)), std::move(report)}));
}

TriangleMeshGraph TriangleMeshGraph::build(TriangleMesh mesh, const MeshOptions& options) try {
  return build(std::move(mesh), options, 0.0);
} catch (const std::bad_alloc&) {
  throw ResourceExhausted("out of memory while building the graph of a triangle mesh");
}

TriangleMeshGraph TriangleMeshGraph::build(std::span<const Vec3> positions, std::span<const Triangle> faces,
                                           const MeshOptions& options) try {
  detail::Stopwatch stopwatch;
  options.progress.step("checks", 0.0);
  TriangleMesh mesh = TriangleMesh::from_positions(positions, faces, options.non_manifold);
  return build(std::move(mesh), options, stopwatch.lap());
} catch (const std::bad_alloc&) {
  throw ResourceExhausted("out of memory while building the graph of a mesh of " + std::to_string(faces.size()) +
                          " faces");
}

}  // namespace ahm::trimesh
