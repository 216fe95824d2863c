// Accuracy on the unit sphere against its closed form, averaged over eight sources: bench_sphere_accuracy [points ...]
#include <cstdio>
#include <cstdlib>
#include <string>

#include "ahm/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_graph.hpp"
#include "ahm/trimesh/triangle_mesh_graph.hpp"
#include "shapes.hpp"
#include "sphere_error.hpp"

namespace {

using ahm::Index;
using ahm::bench::SphereError;

/// One row per variant and time. `surface` has graph(), and the three functions take it from there.
template <class SourceAt, class OnPoints, class FrameAt>
void rows(const std::string& name, const std::vector<ahm::Vec3>& points, const ahm::TangentGraph& graph,
          const SourceAt& source_at, const OnPoints& on_points, const FrameAt& frame_at) {
  for (double t_coef : {1.0, 4.0}) {
    const ahm::LogMapSolver solver(graph, {.t_coef = t_coef});
    for (ahm::Variant variant : {ahm::Variant::adaptive, ahm::Variant::localized}) {
      SphereError mean;
      for (Index s = 0; s < 8; ++s) {
        const Index source = 7 + s * static_cast<Index>(points.size() / 8);
        const auto map = on_points(solver.solve(source_at(source), {.variant = variant}));
        const SphereError e = ahm::bench::sphere_error(points, map.u, map.v, source, frame_at(source));
        mean.rms += e.rms / 8, mean.hemisphere += e.hemisphere / 8, mean.angle += e.angle / 8;
      }
      std::printf("| %zu | %s | %g | %s | %.4f | %.4f | %.4f |\n", points.size(), name.c_str(), t_coef,
                  std::string(ahm::to_string(variant)).c_str(), mean.rms, mean.hemisphere, mean.angle);
    }
  }
}

void cloud_rows(const std::string& name, const std::vector<ahm::Vec3>& points) {
  const auto cloud = ahm::pointcloud::PointCloudGraph::build(points);
  rows(
      name, points, cloud.graph(), [&](Index p) { return cloud.source_at_point(p); },
      [&](const ahm::LogMap& map) { return cloud.on_points(map); },
      [&](Index p) { return *cloud.graph().frame(cloud.vertex_of_point()[p]); });
}

void mesh_rows(const std::string& name, const ahm::bench::Mesh& mesh) {
  const auto surface = ahm::trimesh::TriangleMeshGraph::build(mesh.points, mesh.faces);
  rows(
      name, mesh.points, surface.graph(), [&](Index p) { return surface.source_at_vertex(p); },
      [&](const ahm::LogMap& map) { return surface.on_vertices(map); },
      [&](Index p) { return *surface.graph().frame(surface.vertex(p)); });
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Index> sizes;
  for (int a = 1; a < argc; ++a) sizes.push_back(std::atoi(argv[a]));
  if (sizes.empty()) sizes = {10000, 40000, 160000};
  std::printf(
      "| points | shape | t_coef | variant | rms | max, hemisphere | angle rms |\n|---|---|---|---|---|---|---|\n");
  for (Index n : sizes) {
    const auto icosphere = ahm::bench::icosphere(n);
    mesh_rows("icosphere, triangles", icosphere);
    cloud_rows("icosphere, cloud", icosphere.points);
    cloud_rows("spiral, cloud", ahm::bench::even_sphere(n));
    cloud_rows("random, cloud", ahm::bench::random_sphere(n));
  }
}
