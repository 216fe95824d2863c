#include "flat_meshes.hpp"

#include <random>

namespace ahm::test {
namespace {

void lift(Mesh& mesh) {
  for (const auto& p : mesh.plane) mesh.positions.push_back({p[0], p[1], 0.0});
}

}  // namespace

Mesh flat_square(Index side, double jitter, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-jitter, jitter);
  Mesh mesh;
  auto inside = [&](Index i) { return i > 0 && i + 1 < side; };
  for (Index j = 0; j < side; ++j)
    for (Index i = 0; i < side; ++i) {
      const double a = uniform(random), b = uniform(random);
      mesh.plane.push_back(
          {(i + (inside(i) ? a : 0)) / (side - 1), (j + (inside(j) && j != side / 2 ? b : 0)) / (side - 1)});
    }
  for (Index j = 0; j + 1 < side; ++j)
    for (Index i = 0; i + 1 < side; ++i) {
      const Index a = j * side + i, b = a + 1, c = b + side, d = a + side;
      if (random() % 2) {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
      } else {
        mesh.faces.push_back({a, b, d});
        mesh.faces.push_back({b, c, d});
      }
    }
  lift(mesh);
  return mesh;
}

Mesh hexagon(Index rings) {
  Mesh mesh;
  const Index width = 2 * rings + 1;
  std::vector<Index> number(static_cast<std::size_t>(width) * static_cast<std::size_t>(width), -1);
  auto at = [&](Index i, Index j) -> Index& { return number[(j + rings) * width + i + rings]; };
  auto exists = [&](Index i, Index j) { return std::max({std::abs(i), std::abs(j), std::abs(i + j)}) <= rings; };
  auto add = [&](Index i, Index j) {
    at(i, j) = static_cast<Index>(mesh.plane.size());
    mesh.plane.push_back({i + 0.5 * j, std::sqrt(0.75) * j});
  };
  add(0, 0);
  for (Index j = -rings; j <= rings; ++j)
    for (Index i = -rings; i <= rings; ++i)
      if (exists(i, j) && at(i, j) < 0) add(i, j);
  for (Index j = -rings; j < rings; ++j)
    for (Index i = -rings; i < rings; ++i) {
      if (exists(i + 1, j) && exists(i, j + 1)) {
        if (exists(i, j)) mesh.faces.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (exists(i + 1, j + 1)) mesh.faces.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  lift(mesh);
  return mesh;
}

Index nearest(const Mesh& mesh, double x, double y) {
  Index best = 0;
  auto distance = [&](Index i) { return std::hypot(mesh.plane[i][0] - x, mesh.plane[i][1] - y); };
  for (Index i = 1; i < mesh.vertices(); ++i)
    if (distance(i) < distance(best)) best = i;
  return best;
}

std::array<double, 2> exact_log(const Mesh& mesh, const TangentGraph& graph, Index source, Index vertex) {
  const Frame frame = *graph.frame(source);
  const Vec3 &p = mesh.positions[source], &q = mesh.positions[vertex];
  const Vec3 offset{q[0] - p[0], q[1] - p[1], q[2] - p[2]};
  return {dot(frame.x, offset), dot(frame.y, offset)};
}

double angle_error(const Mesh& mesh, const TangentGraph& graph, const baselines::Result& result, Index source,
                   Index vertex) {
  const auto exact = exact_log(mesh, graph, source, vertex);
  const double u = result.coordinates[2 * vertex], v = result.coordinates[2 * vertex + 1];
  return std::abs(std::atan2(v * exact[0] - u * exact[1], u * exact[0] + v * exact[1]));
}

}  // namespace ahm::test
