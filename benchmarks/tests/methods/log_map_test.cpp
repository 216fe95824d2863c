// DEM, VHM_log, SEM and the reference operator: planar limits and known artifacts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/error.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "flat_maps.hpp"
#include "methods/signed_heat.hpp"

namespace ahm::test {
namespace {

using methods::Method;
using methods::Result;
using std::numbers::pi;
using trimesh::TriangleMeshSurface;

struct PlanarErrors {
  double angle, distance;  ///< root mean square errors
};

/// Errors of a map from the center of a jittered square.
PlanarErrors planar_errors(const std::function<Method(const TangentGraph&)>& make) {
  const Mesh mesh = flat_square(61);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const Index source = nearest(mesh, {0.5, 0.5});
  const Result result = make(surface.graph())->solve(source);
  PlanarErrors errors{0, 0};
  for (Index i = 0; i < mesh.vertices(); ++i)
    if (i != source) {
      errors.angle += std::pow(angle_error(mesh, surface.graph(), result, source, i), 2);
      errors.distance += std::pow(result.distance[i] - plane_distance(mesh, source, i), 2);
    }
  return {std::sqrt(errors.angle / mesh.vertices()), std::sqrt(errors.distance / mesh.vertices())};
}

// DEM.

TEST(DiscreteExponential, IsExactOnEveryFlatGraph) {
  for (const FlatGraph& g : {planar_triangulation(20), planar_triangulation(20, TransportKind::block, true),
                             lattice3(7), line_graph(30), strip(2000)}) {
    const CsrGraph graph(g.data);
    const auto d = static_cast<std::size_t>(g.dimension);
    for (bool average : {false, true}) {
      const Result result = methods::discrete_exponential(graph, {.upwind_average = average})->solve(3);
      for (Index i = 0; i < g.size(); ++i) {
        const auto exact = g.exact(3, i);
        for (std::size_t a = 0; a < d; ++a)
          ASSERT_NEAR(result.coordinates[static_cast<std::size_t>(i) * d + a], exact[a], 1e-12 * g.diameter())
              << "d = " << d;
      }
    }
  }
}

TEST(DiscreteExponential, IsExactAlongAStraightLineOfEdges) {
  // Edges at a vertex of the icosahedron are great circles, which Dijkstra's path follows.
  const Index parts = 16;
  const Mesh mesh = icosphere(parts);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const double edge = std::acos(1 / std::sqrt(5.0));  // between neighboring vertices of the icosahedron
  for (auto turn : {methods::FrameTurn::along_path, methods::FrameTurn::in_space}) {
    const Result result = methods::discrete_exponential(surface.graph(), {.turn = turn})->solve(0);
    Index corners = 0;
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const double angle = std::acos(std::clamp(dot(mesh.positions[0], mesh.positions[i]), -1.0, 1.0));
      if (std::abs(angle - edge) > 1e-9) continue;
      EXPECT_NEAR(result.distance[i], angle, angle / (parts * parts)) << i;
      ++corners;
    }
    EXPECT_EQ(corners, 5);
  }
}

TEST(DiscreteExponential, TurnsInSpaceAsAlongThePathWhereNormalsAgree) {
  const Mesh mesh = flat_square(31);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const Result result =
      methods::discrete_exponential(surface.graph(), {.turn = methods::FrameTurn::in_space})->solve(50);
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const auto exact = exact_log(mesh, surface.graph(), 50, i);
    ASSERT_NEAR(result.coordinates[2 * i], exact[0], 1e-12);
    ASSERT_NEAR(result.coordinates[2 * i + 1], exact[1], 1e-12);
  }
}

TEST(DiscreteExponential, TurnsInSpaceOnlyWhereFramesAreKnown) {
  const CsrGraph graph(sphere_graph(300));
  EXPECT_THROW(methods::discrete_exponential(graph, {.turn = methods::FrameTurn::in_space}), InvalidArgument);
}

/// Root mean square distance between a map of a rolled square and the plane.
double rolled_error(Index side, methods::FrameTurn turn) {
  const Mesh mesh = rolled_square(side, 0.3);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const Index source = nearest(mesh, {0.5, 0.5});
  const Result result = methods::discrete_exponential(surface.graph(), {.turn = turn})->solve(source);
  double c = 0, s = 0, sum = 0;  // the rotation of the frame is fitted
  auto each = [&](auto use) {
    for (Index i = 0; i < mesh.vertices(); ++i)
      use(mesh.plane[i][0] - mesh.plane[source][0], mesh.plane[i][1] - mesh.plane[source][1], result.coordinates[2 * i],
          result.coordinates[2 * i + 1]);
  };
  each([&](double x, double y, double u, double v) { c += x * u + y * v, s += x * v - y * u; });
  const double r = std::hypot(c, s);
  each([&](double x, double y, double u, double v) {
    sum += std::pow((c * u + s * v) / r - x, 2) + std::pow((c * v - s * u) / r - y, 2);
  });
  return std::sqrt(sum / mesh.vertices());
}

TEST(DiscreteExponential, ConvergesOnACylinderWhicheverWayItTurns) {
  for (auto turn : {methods::FrameTurn::along_path, methods::FrameTurn::in_space}) {
    const double coarse = rolled_error(21, turn), fine = rolled_error(81, turn);
    EXPECT_GT(std::log2(coarse / fine) / 2, 0.8) << coarse << ", " << fine;
  }
}

/// Root mean square vector error on the unit sphere within `reach`, from vertex 0.
double sphere_error(Index parts, double reach, const std::function<Method(const TangentGraph&)>& make) {
  const Mesh mesh = icosphere(parts);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const Frame frame = *surface.graph().frame(0);
  const Result result = make(surface.graph())->solve(0);
  double sum = 0;
  Index count = 0;
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const auto exact = sphere_log(mesh.positions[0], frame.x, frame.y, mesh.positions[i]);
    if (std::hypot(exact[0], exact[1]) > reach) continue;
    sum += std::pow(result.coordinates[2 * i] - exact[0], 2) + std::pow(result.coordinates[2 * i + 1] - exact[1], 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

TEST(DiscreteExponential, DoesNotConvergeOnTheSphere) {
  // An edge path encloses an area with the geodesic that does not decrease with h, and it turns the frame by that area.
  auto make = [](const TangentGraph& g) { return methods::discrete_exponential(g); };
  EXPECT_GT(sphere_error(32, pi / 2, make), 0.7 * sphere_error(16, pi / 2, make));
}

TEST(DiscreteExponential, DistortsMoreWithDistance) {
  auto make = [](const TangentGraph& g) { return methods::discrete_exponential(g); };
  EXPECT_GT(sphere_error(16, pi / 2, make), 2 * sphere_error(16, pi / 4, make));
}

// VHM_log.

/// Largest sine of the angle between a map and the identity, up to halfway from the center of a lattice to its border.
double lattice_error(const grid::GridGraph& lattice, const std::function<Method(const TangentGraph&)>& make) {
  const int d = lattice.dimension();
  std::vector<Index> middle;
  double reach = HUGE_VAL;
  for (int a = 0; a < d; ++a) {
    middle.push_back(lattice.grid().shape[a] / 2);
    reach = std::min(reach, 0.5 * middle[a] * lattice.grid().spacing[a]);
  }
  const Vertex source = lattice.vertex(middle);
  const Vec3 p = lattice.position(source);
  const Result result = make(lattice)->solve(source.index);
  double worst = 0;
  for (Index i = 0; i < lattice.size(); ++i) {
    const Vec3 q = lattice.position(Vertex(i)), exact{q[0] - p[0], q[1] - p[1], q[2] - p[2]};
    const double length = std::sqrt(dot(exact, exact)), found = result.distance[i];
    if (Vertex(i) == source || length > reach) continue;
    double square = 0;
    for (int a = 0; a < d; ++a) square += std::pow(result.coordinates[i * d + a] / found - exact[a] / length, 2);
    worst = std::max(worst, std::sqrt(square));
  }
  return worst;
}

std::vector<grid::GridGraph> lattices() {
  std::vector<grid::GridGraph> result;
  result.emplace_back(grid::Grid{.shape = {61, 61}, .spacing = {1, 1}, .origin = {}, .blocked = {}});
  result.emplace_back(grid::Grid{.shape = {81, 61}, .spacing = {1, 1.5}, .origin = {}, .blocked = {}});
  result.emplace_back(grid::Grid{.shape = {21, 21, 21}, .spacing = {1, 1, 1}, .origin = {}, .blocked = {}});
  return result;
}

TEST(VectorHeatLog, HasTheDirectionsOfALatticeExactly) {
  // On a lattice sum_j w e_j k(j, x) is, up to a factor, the inverse transform of the gradient of log A: x times a number.
  // At this diffusion time heat falls by at least e^2 per edge, so little of it returns from the border.
  for (const auto& lattice : lattices())
    EXPECT_LT(
        lattice_error(lattice, [](const TangentGraph& g) { return methods::vector_heat_log(g, {.t_coef = 0.1}); }),
        1e-8)
        << "d = " << lattice.dimension();
}

TEST(VectorHeatLog, DistortsEvenThePlane) {
  // Fig. 6 and 26: off lattices the star of the source weights directions unevenly, equally for all vertices.
  const PlanarErrors vhm = planar_errors([](const TangentGraph& g) { return methods::vector_heat_log(g); });
  EXPECT_GT(vhm.angle, 1e-3);
}

TEST(VectorHeatLog, IsHalfAnEdgeShortAsPublished) {
  const Mesh mesh = hexagon(20);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const Result published = methods::vector_heat_log(surface.graph())->solve(0),
               radial = methods::vector_heat_log(surface.graph(), {.radial_at_source = true})->solve(0);
  // On six equal edges the two results differ only by half an edge at the source.
  for (Index i = 1; i < mesh.vertices(); ++i) ASSERT_NEAR(radial.distance[i] - published.distance[i], 0.5, 1e-9) << i;
}

TEST(VectorHeatLog, ConvergesOnTheSphere) {
  auto make = [](const TangentGraph& g) { return methods::vector_heat_log(g, {.radial_at_source = true}); };
  const double coarse = sphere_error(8, pi / 2, make), fine = sphere_error(16, pi / 2, make);
  EXPECT_GT(std::log2(coarse / fine), 0.8) << coarse << ", " << fine;
}

TEST(VectorHeatLog, HasTheDistanceOfTheSignedHeatMethod) {
  // Near a point the two methods differ only at the edges of the source.
  const CsrGraph graph(sphere_graph(300));
  const Result vhm = methods::vector_heat_log(graph, {.radial_at_source = true})->solve(3),
               shm = methods::SignedHeat(graph).solve(3);
  for (std::size_t i = 0; i < vhm.distance.size(); ++i) ASSERT_NEAR(vhm.distance[i], shm.distance[i], 1e-10);
}

// SEM.

TEST(SmoothedExponential, HasTheDirectionsOfALatticeExactly) {
  // As for VHM_log: the gradient over the star is the same sum.
  for (const auto& lattice : lattices())
    EXPECT_LT(lattice_error(lattice, [](const TangentGraph& g) { return methods::smoothed_exponential(g, 0.1); }), 1e-8)
        << "d = " << lattice.dimension();
}

TEST(SmoothedExponential, DistortsEvenThePlane) {
  const PlanarErrors sem = planar_errors([](const TangentGraph&g) { return methods::smoothed_exponential(g); }),
                     ahm =
                         planar_errors([](const TangentGraph&g) { return methods::affine_heat(g, Variant::adaptive); });
  EXPECT_GT(sem.angle, 1e-3);
  EXPECT_LT(ahm.angle, 1e-11);
  EXPECT_LT(ahm.distance, 1e-11);
}

TEST(SmoothedExponential, FindsDirectionsBetterWithMoreHeat) {
  auto error = [](double t_coef) {
    return planar_errors([&](const TangentGraph& g) { return methods::smoothed_exponential(g, t_coef); }).angle;
  };
  EXPECT_LT(error(50), error(1));
}

// The reference operator.

TEST(ReferenceOperator, AgreesWithTheElimination) {
  for (const CsrGraphData& data : {sphere_graph(300), bent_lattice(5)}) {
    const CsrGraph graph(data);
    for (Variant variant : all_variants) {
      const Result direct = methods::reference_operator(graph, variant)->solve(5),
                   eliminated = methods::affine_heat(graph, variant)->solve(5);
      double largest = 0;
      for (double d : direct.distance) largest = std::max(largest, d);
      // At the source the vector is 0. The paper has the mean of the heat that returns there.
      const auto d = static_cast<std::size_t>(graph.dimension());
      for (std::size_t i = 0; i < direct.coordinates.size(); ++i)
        ASSERT_NEAR(eliminated.coordinates[i], i / d == 5 ? 0 : direct.coordinates[i], 1e-11 * largest)
            << to_string(variant);
    }
  }
}

}  // namespace
}  // namespace ahm::test
