#include "polyhedra.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::test {

Mesh nested_needles(unsigned seed, double farthest) {
  Mesh mesh = icosphere(1);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 400; ++k) {
    const std::size_t f = random() % mesh.faces.size();
    const auto [a, b, c] = mesh.faces[f];
    const double near = std::pow(10, -6 + (6 + std::log10(farthest)) * uniform(random)),
                 off = 0.3 * near * (uniform(random) - 0.5);
    Vec3 weights{near / 2, near / 2, near / 2};
    weights[random() % 3] = 1 - near;
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    const Vec3 normal = ahm::cross(q - p, r - p);
    const Vec3 inside = weights[0] * p + weights[1] * q + weights[2] * r + (off / std::sqrt(norm(normal))) * normal;
    const auto v = static_cast<Index>(mesh.positions.size());
    mesh.positions.push_back(inside);
    mesh.faces[f] = {a, b, v};
    mesh.faces.push_back({b, c, v});
    mesh.faces.push_back({c, a, v});
  }
  return mesh;
}

FlatTriangles flat_triangles(const Mesh& mesh) {
  return trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces).flat_triangles();
}

exact::PolyhedralSurface surface_of(const trimesh::TriangleMesh& mesh) {
  std::vector<exact::FaceSides> sides;
  for (Index f = 0; f < mesh.face_count(); ++f) sides.push_back(mesh.layout(f));
  return {mesh.topology().half_edges(), sides, mesh.corners()};
}

Polyhedron::Polyhedron(const Mesh& shape)
    : mesh(trimesh::TriangleMesh::from_positions(shape.positions, shape.faces)), surface(surface_of(mesh)) {}

Vec3 Polyhedron::position(const exact::MeshPoint& point) const {
  Vec3 sum{0, 0, 0};
  for (int s = 0; s < 3; ++s)
    for (int k = 0; k < 3; ++k)
      sum[k] += point.barycentric[s] * mesh.position(Vertex(surface.record(3 * point.face + s).tail))[k];
  return sum;
}

double Polyhedron::length(const std::vector<exact::MeshPoint>& points) const {
  double sum = 0;
  for (std::size_t k = 1; k < points.size(); ++k) sum += distance(position(points[k - 1]), position(points[k]));
  return sum;
}

exact::MeshPoint random_point(const exact::PolyhedralSurface& surface, std::mt19937_64& random) {
  std::exponential_distribution<double> share;
  exact::MeshPoint point{static_cast<Index>(random() % static_cast<unsigned>(surface.face_count())), {}};
  double sum = 0;
  for (double& b : point.barycentric) sum += b = share(random);
  for (double& b : point.barycentric) b /= sum;
  return point;
}

double distance(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

PolarCone::PolarCone(double angle, Index sectors, Index rings) : angle(angle), polar{{0, 0}} {
  auto vertex = [&](Index ring, Index sector) { return ring == 0 ? 0 : 1 + (ring - 1) * sectors + sector % sectors; };
  for (Index i = 1; i <= rings; ++i)
    for (Index j = 0; j < sectors; ++j) polar.push_back({static_cast<double>(i) / rings, angle * j / sectors});
  const double step = angle / sectors;
  auto place = [&](Index ring, Index side) {
    const double r = static_cast<double>(ring) / rings;
    return Vec2{r * std::cos(side * step), r * std::sin(side * step)};
  };
  auto add = [&](Index sector, std::array<std::array<Index, 2>, 3> corner) {
    Triangle face;
    std::array<double, 3> length;
    for (int s = 0; s < 3; ++s) {
      const auto &a = corner[s], &b = corner[(s + 1) % 3];
      const Vec2 p = place(a[0], a[1]), q = place(b[0], b[1]);
      face[s] = vertex(a[0], sector + a[1]);
      length[s] = std::hypot(p[0] - q[0], p[1] - q[1]);
    }
    faces.push_back(face);
    lengths.push_back(length);
  };
  for (Index j = 0; j < sectors; ++j) {
    add(j, {{{0, 0}, {1, 0}, {1, 1}}});
    for (Index i = 1; i < rings; ++i) {
      add(j, {{{i, 0}, {i + 1, 0}, {i + 1, 1}}});
      add(j, {{{i, 0}, {i + 1, 1}, {i, 1}}});
    }
  }
}

double PolarCone::distance(Index a, Index b) const {
  const double apart = std::abs(polar[a][1] - polar[b][1]), turn = std::min(apart, angle - apart);
  const double r = polar[a][0], s = polar[b][0];
  return turn >= std::numbers::pi ? r + s : std::sqrt(std::max(0.0, r * r + s * s - 2 * r * s * std::cos(turn)));
}

}  // namespace ahm::test
