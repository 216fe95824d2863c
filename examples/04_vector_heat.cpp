// The factors of log maps also extend scalars and vectors from a few vertices to all.
#include <ahm/fields/vector_heat.hpp>
#include <ahm/pointcloud/point_cloud_surface.hpp>
#include <array>
#include <cmath>
#include <cstdio>

int main() {
  std::vector<ahm::Vec3> grid;
  for (int x = 0; x < 50; ++x)
    for (int y = 0; y < 50; ++y) grid.push_back({0.02 * x, 0.02 * y, 0.0});
  const auto cloud = ahm::pointcloud::PointCloudSurface::build(grid);
  const ahm::LogMapSolver solver(cloud.graph());

  const ahm::Vertex corner = cloud.vertex(ahm::Row{0}), opposite = cloud.vertex(ahm::Row{2499});
  const std::array known{corner, opposite};

  // One number at each of two corners: every point gets that of the nearer corner.
  const ahm::VertexField label = ahm::extend_scalar(solver, known, std::array{1.0, 2.0});
  std::printf("label near the second corner: %.3f\n", label.values[cloud.vertex(ahm::Row{2448}).index]);

  // One vector, transported along shortest paths to the opposite corner.
  const ahm::VertexField field = ahm::transport_vectors(solver, std::span(known).first(1), std::array{0.6, 0.8});
  const double* there = field.values.data() + 2 * opposite.index;
  std::printf("at the opposite corner: (%.3f, %.3f), length %.3f\n", there[0], there[1],
              std::hypot(there[0], there[1]));
}
