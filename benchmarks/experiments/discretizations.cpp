// Fig. 15 and 16: the unit sphere as triangles, polygons and points, against the closed form.
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

constexpr int source_count = 8;

/// A common interface of the backends: the source at a point, (u, v) at the points, and the vertex of a point.
struct Backend {
  const TangentGraph& graph;
  std::function<Source(Index point)> source;
  std::function<std::array<std::vector<double>, 2>(const LogMap&)> logs;
  std::function<Index(Index point)> vertex;
};

void measure(const char* name, std::span<const Vec3> points, const Backend& backend, Table& table) {
  for (double t_coef : {1.0, 4.0})
    for (Variant variant : all_variants) {
      std::vector<Cell> row{name, points.size(), t_coef, to_string(variant)};
      try {
        const LogMapSolver solver(backend.graph, {.t_coef = t_coef, .strategy = Strategy::global});
        test::SphereError mean;
        for (Index s = 0; s < source_count; ++s) {
          const Index p = 7 + s * static_cast<Index>(points.size() / source_count);
          const auto [u, v] = backend.logs(solver.solve(backend.source(p), {.variant = variant}));
          const Frame frame = *backend.graph.frame(backend.vertex(p));
          const test::SphereError e = test::sphere_error(points, u, v, p, frame.x, frame.y);
          mean.rms += e.rms / source_count, mean.hemisphere += e.hemisphere / source_count;
          mean.angle += e.angle / source_count, mean.missing += e.missing;
        }
        row.insert(row.end(), {mean.rms, mean.hemisphere, mean.angle, mean.missing});
      } catch (const NotPositiveDefinite&) {
        row.insert(row.end(), {{}, {}, {}, source_count * points.size()});
      }
      table.add(row);
    }
}

/// Measures triangle and polygon graphs.
template <class Surface>
void measure_mesh(const char* name, std::span<const Vec3> points, const Surface& surface, Table& table) {
  measure(name, points,
          {surface.graph(), [&](Index p) { return surface.source(Row(p)).source; },
           [&](const LogMap& map) {
             auto on = surface.to_rows(map);
             return std::array{std::move(on.u), std::move(on.v)};
           },
           [&](Index p) { return surface.vertex(Row(p)).index; }},
          table);
}

void measure_cloud(const char* name, const std::vector<Vec3>& points, Table& table) {
  const auto cloud = pointcloud::PointCloudSurface::build(points);
  measure(name, points,
          {cloud.graph(), [&](Index p) { return cloud.source(Row(p)).source; },
           [&](const LogMap& map) {
             auto on = cloud.to_rows(map);
             return std::array{std::move(on.u), std::move(on.v)};
           },
           [&](Index p) { return cloud.vertex(Row(p)).index; }},
          table);
}

void measure_polygons(const std::string& name, const test::Polygons& mesh, Table& table) {
  auto graph = [&](polymesh::PolygonOptions options) {
    options.discretization = polymesh::Discretization::polygons;
    return polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners, options);
  };
  measure_mesh(name.c_str(), mesh.positions, graph({}), table);
  measure_mesh((name + ", as published").c_str(), mesh.positions, graph({.clamp_weights = false}), table);
  const auto refined = polymesh::PolygonMesh::from_faces(mesh.positions, mesh.begin, mesh.corners).refined();
  measure_mesh((name + ", refined").c_str(), mesh.positions,
               trimesh::TriangleMeshSurface::build(refined.positions, refined.triangles), table);
}

}  // namespace

Table discretizations(const Settings& settings) {
  Table table(
      {"discretization", "vertices", "t_coef", "variant", "rms", "largest, hemisphere", "angle rms", "missing"});
  for (Index n : settings.toy ? std::vector<Index>{600} : std::vector<Index>{2500, 10000, 40000, 160000}) {
    const Mesh mesh = split_icosphere(n);
    measure_mesh("triangles", mesh.positions, trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces), table);
    measure_cloud("points of the icosphere", mesh.positions, table);
    measure_cloud("random points", test::random_sphere(n).points, table);
    measure_cloud("points on a spiral", test::even_sphere(n).points, table);
    if (n > 20000) continue;
    measure_polygons("quads", test::cube_sphere(static_cast<Index>(std::sqrt(n / 6.0))), table);
    measure_polygons("hexagons", test::dual_sphere(static_cast<Index>(std::sqrt(n / 20.0))), table);
    measure_polygons("Voronoi cells", test::voronoi_sphere(n / 2), table);
  }
  for (const char* how : {"triangles", "quads", "hexagons", "Voronoi cells", "random points"}) {
    const Table rows = table.where("discretization", how).where("t_coef", "1").where("variant", "localized");
    table.seen += fmt::format("{}{} {:.3f}", table.seen.empty() ? "Least root mean square error, AHM_l: " : ", ", how,
                              rows.smallest("rms"));
  }
  table.seen += ".";
  return table;
}

}  // namespace ahm::bench
