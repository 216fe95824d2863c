// Tool paths over whole parts: area covered, gaps, double cover, links, time and memory.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <memory>

#include "ahm/applications/tool_path.hpp"
#include "ahm/conformance/parts.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/vec.hpp"
#include "experiments/comparison.hpp"
#include "timing.hpp"

namespace ahm::bench {
namespace {

constexpr Index largest_part = 150'000;

using SurfacePtr = std::unique_ptr<const ahm::Surface>;

double diagonal(std::span<const Vec3> points) {
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points)
    for (std::size_t axis = 0; axis < 3; ++axis)
      low[axis] = std::min(low[axis], p[axis]), high[axis] = std::max(high[axis], p[axis]);
  return norm(high - low);
}

void measure(const std::string& name, const SurfacePtr& surface, const Settings& settings, Table& table) {
  const double spacing = diagonal(surface->positions()) / (settings.toy ? 20 : 60);
  const ToolPathOptions options{.spacing = spacing, .threads = settings.threads};
  ToolPath path;
  const double time = seconds([&] { path = tool_path(*surface, options); });
  const double memory = added_megabytes([&] { tool_path(*surface, options); });
  const ToolPathMeasures measures = tool_path_measures(*surface, path);
  table.add({name, surface->faces().size(), measures.area / (spacing * spacing), path.passes.size(), measures.covered,
             measures.largest_gap, measures.double_covered, path.pass_length * spacing / measures.area,
             path.link_length / path.pass_length, path.surface_links, path.lifted_links, path.missing_links, time,
             known(memory)});
}

SurfacePtr triangles(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces) {
  return std::make_unique<trimesh::TriangleMeshSurface>(trimesh::TriangleMeshSurface::build(positions, faces));
}

/// Measures a part; reports and leaves out one that cannot be covered.
void try_part(const std::string& name, const std::function<SurfacePtr()>& build, const Settings& settings,
              Table& table) {
  run_or_leave_out(name, [&] { measure(name, build(), settings, table); });
}

void measure_user_parts(const Settings& settings, Table& table) {
  const UserSurfaces user = user_surfaces(settings, largest_part);
  for (const NamedMesh& mesh : user.triangles)
    try_part(
        mesh.name, [&] { return triangles(mesh.positions, mesh.faces); }, settings, table);
  for (const NamedPolygons& mesh : user.polygons)
    try_part(
        mesh.name,
        [&]() -> SurfacePtr {
          return std::make_unique<polymesh::PolygonMeshSurface>(
              polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners));
        },
        settings, table);
  for (const NamedCloud& cloud : user_clouds(settings, largest_part))
    try_part(
        cloud.name,
        [&]() -> SurfacePtr {
          return std::make_unique<pointcloud::PointCloudSurface>(pointcloud::PointCloudSurface::build(cloud.positions));
        },
        settings, table);
}

}  // namespace

Table toolpaths(const Settings& settings) {
  Table table({"part", "faces", "area / spacing^2", "passes", "covered", "largest gap / spacing", "double",
               "pass length x spacing / area", "link / pass length", "surface links", "lifted links", "missing links",
               "seconds", "added MB"});
  const Index n = settings.toy ? 640 : 10000;
  for (const NamedMesh& mesh :
       {NamedMesh{split_icosphere(n), "sphere"}, NamedMesh{{test::cylinder(4, false)}, "open cylinder"},
        NamedMesh{{test::cylinder(4, true)}, "closed cylinder"}, NamedMesh{{test::box({4, 3, 2})}, "box"},
        NamedMesh{torus(n), "torus"}, NamedMesh{{test::holed_plate()}, "plate with holes"},
        NamedMesh{bumpy_sphere(n), "bumpy sphere"}, NamedMesh{ellipsoid(n), "ellipsoid"},
        NamedMesh{closed_cone(2.5, settings.toy ? 12 : 40), "double cone"}})
    try_part(
        mesh.name, [&] { return triangles(mesh.positions, mesh.faces); }, settings, table);
  measure_user_parts(settings, table);
  table.seen = fmt::format(
      "{} parts: at least {:.2f} % of the area within 0.6 spacings, gaps up to {:.2f} spacings, double cover up to "
      "{:.2f} %.",
      table.rows().size(), 100 * table.smallest("covered"), table.largest("largest gap / spacing"),
      100 * table.largest("double"));
  return table;
}

}  // namespace ahm::bench
