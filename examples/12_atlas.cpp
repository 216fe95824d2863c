// A texture atlas: cells around farthest points, each flattened by its own log map, and their distortion.
#include <ahm/applications/atlas.hpp>
#include <ahm/applications/cells.hpp>
#include <ahm/maps/log_map_solver.hpp>
#include <ahm/trimesh/triangle_mesh_surface.hpp>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

int main() {
  // A torus of radii 1 and 0.4.
  constexpr int around = 80, across = 32;
  std::vector<ahm::Vec3> points;
  std::vector<ahm::Triangle> triangles;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across;
      const double r = 1 + 0.4 * std::cos(b);
      points.push_back({r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b)});
      const int next = (i + 1) % around * across, up = (j + 1) % across;
      triangles.push_back({i * across + j, next + j, next + up});
      triangles.push_back({i * across + j, next + up, i * across + up});
    }
  const auto mesh = ahm::trimesh::TriangleMeshSurface::build(points, triangles);
  const ahm::LogMapSolver solver(mesh.graph());

  std::vector<ahm::Offset> begin;
  std::vector<ahm::Index> vertices;
  for (const auto& t : triangles) {
    begin.push_back(static_cast<ahm::Offset>(vertices.size()));
    vertices.insert(vertices.end(), t.begin(), t.end());
  }
  begin.push_back(static_cast<ahm::Offset>(vertices.size()));
  const ahm::FaceList faces{begin, vertices};

  const auto print = [&](const char* what, const ahm::Atlas& atlas) {
    const ahm::DistortionSummary d = ahm::distortion(atlas, faces, points).all;
    std::printf("%-20s %3zu charts, distortion: mean %.3f, 95 %% below %.3f, flipped %.2f %%\n", what,
                atlas.charts.size(), d.mean, d.percentile_95, 100 * d.flipped);
    return d;
  };
  const auto one =
      print("one source", ahm::make_atlas(solver, ahm::farthest_points(solver.graph(), ahm::Vertex{0}, 1), faces));
  const auto sources = ahm::farthest_points(solver.graph(), ahm::Vertex{0}, 4);
  print("4 spread sources", ahm::make_atlas(solver, sources, faces));
  const auto good = print("refined", ahm::make_atlas(solver, sources, faces, points, {.max_distortion = 1.5}));
  return good.flipped == 0 && good.percentile_95 < 1.5 && good.mean < one.mean ? 0 : 1;
}
