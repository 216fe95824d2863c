// The five most common tasks: one map, many maps, distances, a path, a graph of your own.
#include <ahm/ahm.hpp>
#include <cmath>
#include <cstdio>

int main() {
  // A flat sheet of 20 x 20 unit squares.
  std::vector<ahm::Vec3> positions;
  std::vector<ahm::Triangle> faces;
  const int n = 21;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) positions.push_back({1.0 * x, 1.0 * y, 0});
  for (int y = 0; y + 1 < n; ++y)
    for (int x = 0; x + 1 < n; ++x) {
      const int a = n * y + x;
      faces.push_back({a, a + 1, a + n + 1});
      faces.push_back({a, a + n + 1, a + n});
    }

  // One map from arrays.
  const auto mesh = ahm::trimesh::TriangleMeshSurface::build(positions, faces);  // or PointCloudSurface::build(points)
  const ahm::SurfaceLogMap map = ahm::log_map(mesh, 0);                          // from row 0
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (map.status[i] == ahm::Status::ok) std::printf("%g %g %g\n", map.u[i], map.v[i], map.distance[i]);

  // Many maps.
  const ahm::SurfaceSolver solver(mesh);  // prepares once
  const std::vector<ahm::SurfaceLogMap> maps = solver.log_maps({0, 17, 333}, {.radius = 5});

  // Distances from the nearest of several sources, and a path.
  const std::vector<double> distance = solver.distance({0, 90});
  const ahm::SurfacePath path = solver.path(7, 90);  // path.points, path.length
  std::printf("%zu maps, distance %.3f, path %.3f\n", maps.size(), distance[5], path.length);

  // A graph of your own: points on a line.
  ahm::CsrGraphData line{.dimension = 1, .kind = ahm::TransportKind::block};
  line.row_begin = {0, 1, 3, 4};
  line.neighbors = {1, 0, 2, 1};
  line.weights = {1, 1, 1, 1};
  line.logs = {1, -1, 1, -1};
  line.transports = {1, 1, 1, 1};
  line.masses = {0.5, 1, 0.5};
  const ahm::CsrGraph graph(std::move(line));  // ahm::CsrGraphData: arrays
  const ahm::LogMap on_line = ahm::LogMapSolver(graph).solve(ahm::Source::at_vertex(ahm::Vertex{0}));
  std::printf("on the line: %.3f\n", on_line.coordinates()[2]);

  const bool ok = std::abs(map.distance.back() - 20 * std::sqrt(2.0)) < 1e-9 && std::abs(distance[5] - 4.0) < 1.0 &&
                  std::abs(on_line.coordinates()[2] - 2) < 1e-9;
  return ok ? 0 : 1;
}
