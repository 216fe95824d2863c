// Distance and its gradient by the radial field.
#include "ahm/fields/distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/error.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

TEST(DistanceGradient, IsExactOnFlatGraphsOfAnyDimension) {
  for (const FlatGraph& flat :
       {planar_triangulation(14), planar_triangulation(14, TransportKind::block, true), lattice3(6), line_graph(40)}) {
    const CsrGraph graph(flat.data);
    const Index p = flat.size() / 2;
    const DistanceField field = distance_and_gradient(LogMapSolver(graph), Source::at_vertex(Vertex(p)));
    const int d = flat.dimension;
    for (Index i = 0; i < flat.size(); ++i) {
      const auto back = flat.exact(i, p);
      double r = 0;
      for (double z : back) r = std::hypot(r, z);
      EXPECT_NEAR(field.distance.values[i], r, 1e-11 * flat.diameter());
      for (int a = 0; a < d; ++a)
        EXPECT_NEAR(field.gradient.values[i * d + a], i == p ? 0 : -back[a] / r,
                    i == p ? 0 : 1e-11 * flat.diameter() / r);
    }
  }
}

TEST(DistanceGradient, AgreesWithDifferencesAlongEdgesToSecondOrder) {
  for (Index parts : {10, 20, 40}) {
    const Mesh mesh = icosphere(parts);
    const SolvedMesh sphere(mesh);
    const CsrGraph& graph = sphere.surface.graph();
    const double h = sphere.surface.details().longest_edge;
    for (Index p : {0, graph.size() / 3}) {
      const DistanceField field = distance_and_gradient(sphere.solver, Source::at_vertex(Vertex(p)));
      double worst = 0;
      for (Index i = 0; i < graph.size(); ++i) {
        const double r = std::acos(std::clamp(dot(graph.frame(i)->origin, graph.frame(p)->origin), -1.0, 1.0));
        if (r < 0.4 || r > std::numbers::pi / 2) continue;
        const double* g = &field.gradient.values[2 * i];
        EXPECT_NEAR(std::hypot(g[0], g[1]), 1, 1e-14);
        const Star star = graph.star(i);
        for (std::size_t e = 0; e < star.degree(); ++e) {
          const double along = (star.log(e)[0] * g[0] + star.log(e)[1] * g[1]) * graph.length_unit();
          const double step = field.distance.values[star.neighbors[e]] - field.distance.values[i];

          worst = std::max(worst, std::abs(step - along));
        }
      }
      // The Hessian of the distance is cot(d) across: at most h^2 / 2 cot(0.4) along an edge.
      EXPECT_LT(worst, 1.5 * h * h / 2 / std::tan(0.4)) << parts << " parts, source " << p;
    }
  }
}

TEST(DistanceGradient, PointsAwayFromTheSourceOnTheSphere) {
  for (Index parts : {10, 20, 40}) {
    const Mesh mesh = icosphere(parts);
    const SolvedMesh sphere(mesh);
    const CsrGraph& graph = sphere.surface.graph();
    const DistanceField field = distance_and_gradient(sphere.solver, Source::at_vertex(sphere.surface.vertex(Row(0))));
    double worst = 0;
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const double cosine = dot(mesh.positions[i], mesh.positions[0]);
      if (i == 0 || cosine < -0.7) continue;
      const Index v = sphere.surface.vertex(Row(i)).index;
      const Frame frame = *graph.frame(v);
      const double *g = &field.gradient.values[2 * v], sine = std::sqrt(1 - cosine * cosine);
      Vec3 difference;  // to the exact gradient, (cos d q - p) / sin d
      for (int a = 0; a < 3; ++a)
        difference[a] =
            g[0] * frame.x[a] + g[1] * frame.y[a] - (cosine * mesh.positions[i][a] - mesh.positions[0][a]) / sine;
      worst = std::max(worst, std::sqrt(dot(difference, difference)));
    }
    EXPECT_LT(worst, 0.2 * graph.mean_edge_length() * graph.length_unit()) << parts << " parts";
  }
}

TEST(DistanceGradient, OfASetIsThatOfItsNearestPoint) {
  const grid::GridGraph plane({.shape = {61, 31}, .spacing = {0.1, 0.1}});
  const std::array points{plane.vertex(std::array{8, 15}), plane.vertex(std::array{50, 11})};
  Source set(2);
  for (Vertex i : points) set.add(i, 1.0, std::array{0.0, 0.0}, std::array{1.0, 0.0, 0.0, 1.0});
  const DistanceField field = distance_and_gradient(LogMapSolver(plane), set);
  for (Index i = 0; i < plane.size(); ++i) {
    const Vec3 q = plane.position(Vertex(i));
    std::array<Vec3, 2> away;
    for (int k : {0, 1})
      for (int a = 0; a < 3; ++a) away[k][a] = q[a] - plane.position(points[k])[a];
    double r[] = {std::sqrt(dot(away[0], away[0])), std::sqrt(dot(away[1], away[1]))};
    if (std::abs(r[0] - r[1]) < 2) continue;  // heat of the farther one: below exp(-0.8 * 20)
    const int k = r[0] < r[1] ? 0 : 1;
    EXPECT_NEAR(field.distance.values[i], r[k], 1e-5);
    if (r[k] > 0)
      for (int a : {0, 1}) EXPECT_NEAR(field.gradient.values[2 * i + a], away[k][a] / r[k], 1e-4);
  }
}

TEST(DistanceGradient, IsMaskedWhereDistanceIs) {
  const FlatGraph flat = planar_triangulation(6);
  const CsrGraph two(doubled(flat.data));
  const DistanceField field = distance_and_gradient(LogMapSolver(two), Source::at_vertex(Vertex{0}));
  for (Index i = 0; i < two.size(); ++i) {
    const bool known = i < flat.size();
    EXPECT_EQ(field.distance.status[i], known ? Status::ok : Status::disconnected);
    EXPECT_EQ(field.gradient.status[i], field.distance.status[i]);
    EXPECT_EQ(std::isnan(field.distance.values[i]), !known);
    EXPECT_EQ(std::isnan(field.gradient.values[2 * i]), !known);
  }
  EXPECT_THROW(distance_and_gradient(LogMapSolver(two), Source::at_vertex(Vertex{72})), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
