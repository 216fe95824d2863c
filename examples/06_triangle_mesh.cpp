// A map from a source inside a face, evaluated at another point of the surface. Both are points of the input mesh.
#include <ahm/ahm.hpp>
#include <cmath>
#include <cstdio>

int main() {
  // A long thin strip of needle triangles: two rows of vertices, folded in the middle.
  std::vector<ahm::Vec3> positions;
  std::vector<ahm::Triangle> faces;
  const int n = 40;
  for (int i = 0; i <= n; ++i)
    for (double x : {0.0, 5.0})
      positions.push_back(i <= n / 2 ? ahm::Vec3{x, 0.1 * i, 0} : ahm::Vec3{x, 2, 0.1 * (i - n / 2)});
  for (int i = 0; i < n; ++i) {
    faces.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    faces.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }

  const auto mesh = ahm::trimesh::TriangleMeshSurface::build(positions, faces);
  const ahm::SurfaceSolver solver(mesh);
  const ahm::FacePoint source{0, {0.5, 0.25, 0.25}}, target{2 * n - 1, {0.25, 0.25, 0.5}};
  const ahm::SurfaceLogMap map = solver.log_map(source, {.u_axis = ahm::Vec3{1, 0, 0}});  // u along the x axis of space
  const ahm::Sample sample = solver.at(map, target);
  std::printf("%ld flips; the target lies at u = %.6f, v = %.6f\n", static_cast<long>(mesh.details().flips), sample.u,
              sample.v);
  // Unfolded, source and target are (2.5, 0.025) and (1.25, 3.975).
  return std::hypot(sample.u + 1.25, sample.v - 3.95) < 1e-9 ? 0 : 1;
}
