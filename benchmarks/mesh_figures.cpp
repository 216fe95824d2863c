// Figures 4, 12, 13, 14, 21 and 23 of the paper as numbers, on generated meshes with known answers: bench_mesh_figures
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "ahm/log_map_solver.hpp"
#include "ahm/trimesh/triangle_mesh_graph.hpp"
#include "ahm/vector_heat.hpp"
#include "shapes.hpp"
#include "sphere_error.hpp"

namespace {

using ahm::Index;
using ahm::Variant;
using ahm::Vec3;
using ahm::bench::Mesh;
using ahm::bench::SphereError;
using ahm::trimesh::TriangleMeshGraph;
using std::numbers::pi;

constexpr Variant variants[] = {Variant::adaptive, Variant::localized};

Vec3 on_sphere(double polar, double turn) {
  return {std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)};
}

/// Sphere by meridians and parallels; few parallels make long thin triangles. `last` < pi leaves it open at the bottom.
Mesh parallels_and_meridians(int parallels, int meridians, double last = pi) {
  Mesh mesh;
  mesh.points.push_back(on_sphere(0, 0));
  const bool closed = last >= pi;
  const int rings = closed ? parallels - 1 : parallels;
  for (int r = 1; r <= rings; ++r)
    for (int m = 0; m < meridians; ++m) mesh.points.push_back(on_sphere(last * r / parallels, 2 * pi * m / meridians));
  auto at = [&](int r, int m) { return 1 + (r - 1) * meridians + m % meridians; };
  for (int m = 0; m < meridians; ++m) {
    mesh.faces.push_back({0, at(1, m), at(1, m + 1)});
    for (int r = 1; r < rings; ++r) {
      mesh.faces.push_back({at(r, m), at(r + 1, m), at(r + 1, m + 1)});
      mesh.faces.push_back({at(r, m), at(r + 1, m + 1), at(r, m + 1)});
    }
  }
  if (!closed) return mesh;
  mesh.points.push_back(on_sphere(pi, 0));
  for (int m = 0; m < meridians; ++m)
    mesh.faces.push_back({static_cast<Index>(mesh.points.size() - 1), at(rings, m + 1), at(rings, m)});
  return mesh;
}

/// Icosphere whose faces got one more vertex each, close to a side: caps and needles.
Mesh with_needles(Index n) {
  Mesh mesh = ahm::bench::icosphere(n);
  std::mt19937_64 random(1);
  std::vector<std::array<Index, 3>> faces;
  for (const auto& [a, b, c] : mesh.faces) {
    const double weight[3] = {0.5, 0.49, 0.01};
    Vec3 p{0, 0, 0};
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = weight[0] * mesh.points[a][axis] + weight[1] * mesh.points[b][axis] + weight[2] * mesh.points[c][axis];
    const double r = std::hypot(p[0], p[1], p[2]);
    const auto middle = static_cast<Index>(mesh.points.size());
    mesh.points.push_back({p[0] / r, p[1] / r, p[2] / r});
    faces.insert(faces.end(), {{a, b, middle}, {b, c, middle}, {c, a, middle}});
  }
  mesh.faces = faces;
  return mesh;
}

SphereError error(const Mesh& mesh, const TriangleMeshGraph& surface, const ahm::LogMapSolver& solver, Index source,
                  Variant variant) {
  const auto map = surface.on_vertices(solver.solve(surface.source_at_vertex(source), {.variant = variant}));
  return ahm::bench::sphere_error(mesh.points, map.u, map.v, source, *surface.graph().frame(surface.vertex(source)));
}

/// Fig. 14 and 23: bad triangles, with and without intrinsic Delaunay flips.
void bad_triangles() {
  std::printf("## Bad triangles (Fig. 14, 23): unit sphere, rms / max over the hemisphere\n\n");
  std::printf("| mesh | vertices | variant | flipped | as given |\n|---|---|---|---|---|\n");
  const std::pair<const char*, Mesh> meshes[] = {{"icosphere", ahm::bench::icosphere(10000)},
                                                 {"50 parallels x 200 meridians", parallels_and_meridians(50, 200)},
                                                 {"400 parallels x 25 meridians", parallels_and_meridians(400, 25)},
                                                 {"icosphere with needles", with_needles(2500)}};
  for (const auto& [name, mesh] : meshes)
    for (Variant variant : variants) {
      std::printf("| %s | %zu | %s |", name, mesh.points.size(), std::string(ahm::to_string(variant)).c_str());
      for (bool flips : {true, false}) try {
          const auto surface = TriangleMeshGraph::build(mesh.points, mesh.faces, {.intrinsic_delaunay = flips});
          const ahm::LogMapSolver solver(surface.graph());
          const SphereError e = error(mesh, surface, solver, static_cast<Index>(mesh.points.size() / 3), variant);
          std::printf(" %.4f / %.4f |", e.rms, e.hemisphere);
        } catch (const ahm::Error&) {
          std::printf(" not positive definite |");
        }
      std::printf("\n");
    }
}

/// Fig. 13: four orders of magnitude of diffusion time.
void times() {
  std::printf(
      "\n## Diffusion time (Fig. 13): icosphere of 10,242 vertices, max over the hemisphere\n\n| t_coef | adaptive | "
      "localized |\n|---|---|---|\n");
  const Mesh mesh = ahm::bench::icosphere(10000);
  const auto surface = TriangleMeshGraph::build(mesh.points, mesh.faces);
  for (double t_coef : {0.01, 0.1, 1.0, 10.0, 100.0}) {
    const ahm::LogMapSolver solver(surface.graph(), {.t_coef = t_coef});
    std::printf("| %g |", t_coef);
    for (Variant variant : variants) std::printf(" %.4f |", error(mesh, surface, solver, 3000, variant).hemisphere);
    std::printf("\n");
  }
}

/// Fig. 4: a cap cut off at 60 degrees; geodesics from its pole do not know of the boundary.
void boundary() {
  std::printf(
      "\n## Boundary (Fig. 4): spherical cap of 60 degrees, source at its pole, relative error of the distance\n\n| "
      "variant | interior, largest | boundary, largest |\n|---|---|---|\n");
  const Mesh mesh = parallels_and_meridians(60, 120, pi / 3);
  const auto surface = TriangleMeshGraph::build(mesh.points, mesh.faces);
  const ahm::LogMapSolver solver(surface.graph());
  for (Variant variant : variants) {
    const auto map = surface.on_vertices(solver.solve(surface.source_at_vertex(0), {.variant = variant}));
    double largest[2] = {0, 0};
    for (std::size_t i = 1 + 120 * 5; i < mesh.points.size(); ++i) {
      const double exact = std::acos(mesh.points[i][2]);
      double& worst = largest[i + 120 >= mesh.points.size()];
      worst = std::max(worst, std::abs(map.distance[i] / exact - 1));
    }
    std::printf("| %s | %.4f | %.4f |\n", std::string(ahm::to_string(variant)).c_str(), largest[0], largest[1]);
  }
}

/// Fig. 12: a closed tube, where geodesics around both sides meet on a line.
void colliding_geodesics() {
  std::printf(
      "\n## Colliding geodesics (Fig. 12): tube of radius 0.2, length 2; edges that the map stretches more than "
      "twice\n\n| variant | share of edges | longest coordinate step, in edge lengths |\n|---|---|---|\n");
  Mesh mesh;
  const int rings = 200, around = 126;
  for (int r = 0; r < rings; ++r)
    for (int m = 0; m < around; ++m)
      mesh.points.push_back(
          {2.0 * r / (rings - 1), 0.2 * std::cos(2 * pi * m / around), 0.2 * std::sin(2 * pi * m / around)});
  for (int r = 0; r + 1 < rings; ++r)
    for (int m = 0; m < around; ++m) {
      const Index a = r * around + m, b = r * around + (m + 1) % around;
      mesh.faces.push_back({a, a + around, b});
      mesh.faces.push_back({b, a + around, b + around});
    }
  const auto surface = TriangleMeshGraph::build(mesh.points, mesh.faces);
  const ahm::LogMapSolver solver(surface.graph());
  for (Variant variant : variants) {
    const ahm::LogMap map = solver.solve(surface.source_at_vertex(10 * around), {.variant = variant});
    long edges = 0, torn = 0;
    double longest = 0;
    for (Index i = 0; i < map.size(); ++i) {
      const ahm::Star star = surface.graph().star(i);
      for (std::size_t e = 0; e < star.degree(); ++e) {
        const auto from = map.coordinates(i), to = map.coordinates(star.neighbors[e]);
        const double step = std::hypot(to[0] - from[0], to[1] - from[1]) /
                            (std::hypot(star.log(e)[0], star.log(e)[1]) * surface.graph().length_unit());
        ++edges;
        torn += step > 2;
        longest = std::max(longest, step);
      }
    }
    std::printf("| %s | %.2f %% | %.1f |\n", std::string(ahm::to_string(variant)).c_str(), 100.0 * torn / edges,
                longest);
  }
}

/// Fig. 21: direction of the radial field on stretched triangles, against the sphere's.
void radial_field() {
  std::printf(
      "\n## Radial field on anisotropic meshes (Fig. 21): unit sphere, mean angle to the exact field, radians, 0.1 < d "
      "< 0.8 pi\n\n| mesh | flipped | as given |\n|---|---|---|\n");
  const std::pair<int, int> shapes[] = {{100, 100}, {50, 200}, {25, 400}};
  for (const auto& [parallels, meridians] : shapes) {
    const Mesh mesh = parallels_and_meridians(parallels, meridians);
    std::printf("| %d parallels x %d meridians |", parallels, meridians);
    for (bool flips : {true, false}) {
      const auto surface = TriangleMeshGraph::build(mesh.points, mesh.faces, {.intrinsic_delaunay = flips});
      const ahm::LogMapSolver solver(surface.graph());
      const auto source = static_cast<Index>(1 + parallels / 2 * meridians);
      const ahm::VertexField field = ahm::radial_field(solver, surface.source_at_vertex(source));
      double sum = 0;
      int count = 0;
      for (Index i = 0; i < surface.graph().size(); ++i) {
        const Vec3 &p = mesh.points[i], &s = mesh.points[source];
        const double c = ahm::bench::dot(p, s), d = std::acos(std::clamp(c, -1.0, 1.0));
        if (d < 0.1 || d > 0.8 * pi) continue;
        const ahm::Frame frame = *surface.graph().frame(i);
        const double* y = field.values.data() + 2 * i;
        Vec3 Y, exact;
        for (int a = 0; a < 3; ++a) {
          Y[a] = y[0] * frame.x[a] + y[1] * frame.y[a];
          exact[a] = c * p[a] - s[a];  // away from the source
        }
        const double cosine =
            ahm::bench::dot(Y, exact) / std::sqrt(ahm::bench::dot(Y, Y) * ahm::bench::dot(exact, exact));
        sum += std::acos(std::clamp(cosine, -1.0, 1.0));
        ++count;
      }
      std::printf(" %.4f |", sum / count);
    }
    std::printf("\n");
  }
}

}  // namespace

int main() {
  bad_triangles();
  times();
  boundary();
  colliding_geodesics();
  radial_field();
}
