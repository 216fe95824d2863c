// Polygon meshes of the sphere and of the plane by each discretization: bench_polygon_figures [largest]
//
// Clamped and published weights on the polygons, and the triangle backend on the refinement. The rows are Markdown.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

#include "ahm/error.hpp"
#include "ahm/trimesh/triangle_mesh_graph.hpp"
#include "measure.hpp"
#include "polymesh/polygons.hpp"

namespace {

using ahm::Index, ahm::LogMap, ahm::Status, ahm::Vec3, ahm::test::Polygons, ahm::bench::seconds;

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Errors {
  double l2 = 0, hemisphere = 0, h = 0;
  Index unreached = 0;
};

/// Against the closed form on the unit sphere, vertices of equal weight, up to 0.85 pi; `frame` is that of the source.
Errors errors(const Polygons& mesh, const LogMap& map, const ahm::Frame& frame, const Vec3& p) {
  Errors e;
  double count = 0;
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const Vec3& q = mesh.positions[i];
    const double c = std::clamp(dot(p, q), -1.0, 1.0), r = std::acos(c);
    if (map.status(i) != Status::ok) {
      ++e.unreached;
      continue;
    }
    if (r > 0.85 * std::numbers::pi) continue;
    const Vec3 t{q[0] - c * p[0], q[1] - c * p[1], q[2] - c * p[2]};
    const double s = r > 0 ? r / std::sqrt(std::max(dot(t, t), 1e-300)) : 0;
    const double off =
        std::hypot(map.coordinates(i)[0] - s * dot(t, frame.x), map.coordinates(i)[1] - s * dot(t, frame.y));
    e.l2 += off * off;
    count += 1;
    if (r < std::numbers::pi / 2) e.hemisphere = std::max(e.hemisphere, off);
  }
  e.l2 = std::sqrt(e.l2 / count);
  return e;
}

template <class Surface>
void row(const char* shape, const char* how, const Polygons& mesh, const Surface& surface, double build) {
  const auto& graph = surface.graph();
  for (ahm::Variant variant : {ahm::Variant::adaptive, ahm::Variant::localized}) {
    try {
      const LogMap map = ahm::LogMapSolver(graph, {}, {.strategy = ahm::Strategy::global})
                             .solve(surface.source_at_vertex(0), {.variant = variant});
      const Errors e = errors(mesh, map, *graph.frame(surface.vertex(0)), mesh.positions[0]);
      const double h = graph.mean_edge_length() * graph.length_unit();
      std::printf("| %s | %d | %s | %s | %.4f | %.2e | %.2e | %d | %.2f |\n", shape, mesh.vertices(), how,
                  std::string(to_string(variant)).c_str(), h, e.l2, e.hemisphere, e.unreached,
                  build / mesh.vertices() * 1e6);
    } catch (const ahm::Error& error) {
      std::printf("| %s | %d | %s | %s | | %s | | |\n", shape, mesh.vertices(), how,
                  std::string(to_string(variant)).c_str(), error.what());
    }
    std::fflush(stdout);
  }
}

void run(const char* shape, const Polygons& mesh) {
  for (bool clamp : {true, false}) {
    std::optional<ahm::polymesh::PolygonMeshGraph> surface;
    const double build = seconds([&] { surface.emplace(mesh.graph({.clamp_weights = clamp})); });
    row(shape, clamp ? "polygons" : "polygons, published", mesh, *surface, build);
    if (!clamp)
      std::printf("  (%d faces, %.2f %% of the edges negative)\n", mesh.faces(),
                  100.0 * surface->report().negative_weights / surface->report().edges);
  }
  const auto polygons = ahm::polymesh::PolygonMesh::from_faces(mesh.positions, mesh.begin, mesh.corners);
  const auto refined = polygons.refined();
  std::optional<ahm::trimesh::TriangleMeshGraph> surface;
  const double build =
      seconds([&] { surface.emplace(ahm::trimesh::TriangleMeshGraph::build(refined.positions, refined.triangles)); });
  row(shape, "refined", mesh, *surface, build);
}

/// The identity on the plane.
void flat(const char* shape, const Polygons& mesh) {
  auto worst = [&](const auto& surface, auto vertex_of) {
    const LogMap map = ahm::LogMapSolver(surface.graph()).solve(surface.source_at_vertex(0));
    double error = 0;
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const double d = std::hypot(mesh.plane[i][0] - mesh.plane[0][0], mesh.plane[i][1] - mesh.plane[0][1]);
      error = std::max(error, std::abs(map.distance(vertex_of(i)) - d));
    }
    return error / mesh.diameter();
  };
  const auto surface = mesh.graph();
  const auto refined = surface.mesh().refined();
  const auto triangles = ahm::trimesh::TriangleMeshGraph::build(refined.positions, refined.triangles);
  std::printf("| %s | %d | %.1e | %.1e | %.1f |\n", shape, mesh.vertices(), worst(surface, [](Index i) { return i; }),
              worst(triangles, [](Index i) { return i; }),
              100.0 * surface.report().negative_weights / surface.report().edges);
}

}  // namespace

int main(int argc, char** argv) {
  const int largest = argc > 1 ? std::atoi(argv[1]) : 20000;
  std::printf(
      "| planar | vertices | polygons: distance error / diameter | refined: the same | negative weights % "
      "|\n|---|---|---|---|---|\n");
  flat("Voronoi cells", ahm::test::voronoi_square(1000));
  flat("quads", ahm::test::quad_grid(40));
  flat("bricks", ahm::test::brick_wall(40));
  flat("L shapes", ahm::test::l_shapes(20));
  flat("stretched L shapes, 10", ahm::test::l_shapes(20, 10));
  flat("stretched L shapes, 100", ahm::test::l_shapes(20, 100));
  flat("U shapes", ahm::test::u_shapes(12));
  std::printf(
      "\n| shape | vertices | discretization | variant | h | L2 error | largest on the hemisphere | unreached | build "
      "us each |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  for (Index n : {1200, 5000, 20000, 80000}) {
    if (n > largest) break;
    run("cube-sphere quads", ahm::test::cube_sphere(static_cast<Index>(std::sqrt(n / 6.0))));
    run("hexagons", ahm::test::dual_sphere(static_cast<Index>(std::sqrt(n / 20.0))));
    if (n <= 20000) run("Voronoi cells", ahm::test::voronoi_sphere(n / 2));
  }
}
