#include "ahm/conformance/parts.hpp"

#include <cmath>
#include <numbers>

namespace ahm::test {

Mesh box(const Vec3& size) {
  Mesh mesh;
  for (const double x : {0.0, size[0]})
    for (const double y : {0.0, size[1]})
      for (const double z : {0.0, size[2]}) mesh.positions.push_back({x, y, z});
  mesh.faces = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return mesh;
}

Mesh cylinder(double height, bool closed) {
  constexpr Index n = 48;
  Mesh mesh;
  for (const double z : {0.0, height})
    for (Index i = 0; i < n; ++i)
      mesh.positions.push_back({std::cos(2 * std::numbers::pi * i / n), std::sin(2 * std::numbers::pi * i / n), z});
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    mesh.faces.push_back({i, j, n + j});
    mesh.faces.push_back({i, n + j, n + i});
    if (!closed) continue;
    mesh.faces.push_back({2 * n, j, i});
    mesh.faces.push_back({2 * n + 1, n + i, n + j});
  }
  if (closed) mesh.positions.push_back({0, 0, 0}), mesh.positions.push_back({0, 0, height});
  return mesh;
}

Mesh holed_plate() {
  constexpr Index nx = 61, ny = 41;
  constexpr double h = 0.1;
  Mesh mesh;
  for (Index j = 0; j < ny; ++j)
    for (Index i = 0; i < nx; ++i) mesh.positions.push_back({h * i, h * j, 0});
  const auto is_hole = [](double x, double y) {
    return std::hypot(x - 1.5, y - 2) < 0.6 || std::hypot(x - 4.2, y - 1.4) < 0.75 ||
           std::hypot(x - 4.4, y - 3.2) < 0.3;
  };
  for (Index j = 0; j + 1 < ny; ++j)
    for (Index i = 0; i + 1 < nx; ++i) {
      if (is_hole(h * (i + 0.5), h * (j + 0.5))) continue;
      const Index a = j * nx + i;
      mesh.faces.push_back({a, a + 1, a + nx + 1});
      mesh.faces.push_back({a, a + nx + 1, a + nx});
    }
  return mesh;
}

}  // namespace ahm::test
