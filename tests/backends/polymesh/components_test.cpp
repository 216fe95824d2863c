// What else is in a file changes no number of a component.
#include <gtest/gtest.h>

#include <cmath>

#include "polygon_graphs.hpp"

namespace ahm::test {
namespace {

using polymesh::Discretization;
using polymesh::PolygonMeshSurface;

Polygons beside(const Polygons& a, const Polygons& b, double scale) {
  Polygons both{a.positions, a.begin, a.corners, {}};
  for (const Vec3& p : b.positions) both.positions.push_back({scale * p[0] + 3 + scale, scale * p[1], scale * p[2]});
  for (Index f = 0; f < b.faces(); ++f) {
    std::vector<Index> face = b.face(f);
    for (Index& v : face) v += a.vertices();
    both.add(face);
  }
  return both;
}

TEST(Components, HaveTheSameNumbersAloneAndBesideOthers) {
  const Polygons quads = cube_sphere(7), cells = voronoi_sphere(100), triangles = quad_grid(12, true);
  for (Discretization how : {Discretization::polygons, Discretization::refined})
    for (const auto& [a, b] : {std::pair{quads, cells}, {cells, quads}, {cells, triangles}, {triangles, cells}})
      for (double scale : {0.03, 30.0, 1e6}) {
        const Polygons both = beside(a, b, scale);
        auto mapped = [&](const Polygons& mesh) {
          const auto surface =
              PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners, {.discretization = how});
          const LogMapSolver solver(surface.graph());
          return surface.to_rows(solver.solve(surface.source(Row(5)).source));
        };
        const RowLogMap alone = mapped(a), together = mapped(both);
        for (Index i = 0; i < a.vertices(); ++i) {
          ASSERT_NEAR(together.u[i], alone.u[i], 1e-10) << scale;
          ASSERT_NEAR(together.v[i], alone.v[i], 1e-10) << scale;
          ASSERT_NEAR(together.distance[i], alone.distance[i], 1e-10) << scale;
          ASSERT_NEAR(together.spread[i], alone.spread[i], 1e-5) << scale;
        }
      }
}

}  // namespace
}  // namespace ahm::test
