// Directions for the u axis: vectors of space, and principal curvatures; normals on the side of the source.
#include "ahm/surface/directions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/surface_triangles.hpp"
#include "ahm/util/vec.hpp"
#include "surfaces.hpp"

namespace ahm::test {
namespace {

Vec3 in_space(const Frame& frame, std::span<const double> v) { return v[0] * frame.x + v[1] * frame.y; }

TEST(DirectionInFrame, RotatesTheUAxisToAVectorOfSpace) {
  const auto plane = surface_of(sliver_square(120));
  const CsrGraph& graph = plane.graph();
  const LogMapSolver solver(graph);
  const Vec3 up{0.3, -0.5, 2};
  for (Index p : {0, 50, 110}) {
    const Frame frame = *graph.frame(p);
    const Vec3 along = normalized(up - dot(up, frame.normal) * frame.normal);
    const LogMap map = solver.solve(Source::at_vertex(Vertex(p), direction_in_frame(graph, Vertex{p}, up)));
    for (Index i = 0; i < graph.size(); ++i)
      EXPECT_NEAR(map.coordinates(Vertex(i))[0], dot(graph.frame(i)->origin - frame.origin, along), 1e-11);
  }
}

TEST(Directions, NeedFramesInSpaceAndATangentialPart) {
  const grid::GridGraph grid({.shape = {4, 4}, .spacing = {1, 1}}), space({.shape = {4, 4, 4}, .spacing = {1, 1, 1}});
  const CsrGraph abstract(planar_triangulation(4).data), sphere(sphere_graph(60));
  const LogMap map = LogMapSolver(sphere).solve(Source::at_vertex(Vertex{3}), {.frames = true});
  const std::pair<const char*, std::function<void()>> cases[] = {
      {"normal",
       [&] {
         direction_in_frame(grid, Vertex{0}, {0, 0, 1});
       }},
      {"zero",
       [&] {
         direction_in_frame(grid, Vertex{0}, {0, 0, 0});
       }},
      {"not finite",
       [&] {
         direction_in_frame(grid, Vertex{0}, {0, NAN, 1});
       }},
      {"out of range",
       [&] {
         direction_in_frame(grid, Vertex{16}, {0, 1, 0});
       }},
      {"volume",
       [&] {
         direction_in_frame(space, Vertex{0}, {0, 1, 0});
       }},
      {"no frames",
       [&] {
         direction_in_frame(abstract, Vertex{0}, {0, 1, 0});
       }},
      {"curvature of a volume", [&] { curvature_directions(space); }},
      {"curvature without frames", [&] { curvature_directions(abstract); }},
      {"normals without frames", [&] { source_side_normals(sphere, map); }},
  };
  for (const auto& [name, call] : cases) EXPECT_THROW(call(), InvalidArgument) << name;
}

// ------------------------------------------------------------------------------------------------ curvature

TEST(Curvature, OfThePlaneIsZero) {
  const auto surface = surface_of(holed_square(16));
  for (double kappa : curvature_directions(surface.graph()).values) EXPECT_NEAR(kappa, 0, 1e-9);
  for (double kappa : curvature_directions(grid::GridGraph({.shape = {5, 4}, .spacing = {1, 2}})).values)
    EXPECT_EQ(kappa, 0);
}

TEST(Curvature, IsNanWithoutEdges) {
  // The center of a block of 2 x 2 obstacles.
  std::vector<std::uint8_t> blocked(64, 0);
  for (int cell : {27, 28, 35, 36}) blocked[cell] = 1;
  const grid::GridGraph grid({.shape = {9, 9}, .spacing = {1, 1}, .origin = {}, .blocked = blocked});
  const PrincipalCurvatures curvatures = curvature_directions(grid);
  for (Index i = 0; i < 81; ++i) EXPECT_EQ(std::isnan(curvatures.values[2 * i]), i == 40) << "vertex " << i;
}

TEST(Curvature, OfACylinderIsThatOfItsCircles) {
  const double radius = 0.4;
  for (Index side : {20, 40, 80}) {
    const Mesh mesh = rolled_square(side, radius);
    const auto surface = surface_of(mesh);
    const PrincipalCurvatures curvatures = curvature_directions(surface.graph());
    // A circle differs from its parabola by a share of (x / R)^2 / 4. In the interior, the vertex lies in the middle of those
    // of the fit. At the boundary, the error of fourth order becomes one of third order.
    const double reach = 2 * surface.details().longest_edge / radius;
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const auto [x, y] = mesh.plane[i];
      const double tolerance = std::min({x, y, 1 - x, 1 - y}) < 2.5 / side ? reach : reach * reach / 4;
      const Vertex v = surface.vertex(Row(i));
      EXPECT_NEAR(std::abs(curvatures.values[2 * v.index]) * radius, 1, tolerance) << i;
      EXPECT_NEAR(curvatures.values[2 * v.index + 1] * radius, 0, tolerance) << i;
      EXPECT_NEAR(in_space(*surface.graph().frame(v.index), curvatures.direction(v))[0], 0, tolerance) << i;
    }
  }
}

// The shape operator of the ellipsoid sum (x / a)^2 = 1 with outward normals.
TEST(Curvature, OfAnEllipsoidIsThatOfItsEquation) {
  const Vec3 axes{1, 0.8, 0.6};
  const auto scaled = [&](const Vec3& p) { return Vec3{p[0] / axes[0], p[1] / axes[1], p[2] / axes[2]}; };
  for (Index parts : {10, 20, 40}) {
    Mesh mesh = icosphere(parts);
    for (Vec3& p : mesh.positions)
      for (int a = 0; a < 3; ++a) p[a] *= axes[a];
    const auto surface = surface_of(mesh);
    const auto cloud = pointcloud::PointCloudSurface::build(mesh.positions);
    for (const CsrGraph* graph : {&surface.graph(), &cloud.graph()}) {
      const PrincipalCurvatures curvatures = curvature_directions(*graph);
      double largest_error = 0, largest_mixed = 0;
      for (Index i = 0; i < graph->size(); ++i) {
        const Frame frame = *graph->frame(i);
        const auto d = curvatures.direction(Vertex(i));
        const Vec3 u = scaled(in_space(frame, d)), v = scaled(in_space(frame, std::array{-d[1], d[0]}));
        const double gradient = norm(scaled(scaled(frame.origin))),
                     outward = dot(frame.normal, frame.origin) > 0 ? 1 : -1;
        largest_error = std::max({largest_error, std::abs(outward * curvatures.values[2 * i] - dot(u, u) / gradient),
                                  std::abs(outward * curvatures.values[2 * i + 1] - dot(v, v) / gradient)});
        largest_mixed = std::max(largest_mixed, std::abs(dot(u, v) / gradient));
      }
      // First order; third derivatives of this ellipsoid are of order one.
      const double h = graph->mean_edge_length() * graph->length_unit();
      EXPECT_LT(largest_error, h) << parts << " parts";
      EXPECT_LT(largest_mixed, h) << parts << " parts";
    }
  }
}

TEST(Curvature, DoesNotDependOnTheSizeOfOtherComponents) {
  const Mesh sphere = icosphere(6);
  Mesh small = sphere;
  for (Vec3& p : small.positions) p = 1e-6 * p;
  const auto surface = surface_of(joined(sphere, small, {3, 0, 0}));
  const std::vector<double> values = curvature_directions(surface.graph()).values;
  for (Index i = 0; i < sphere.vertices(); ++i)
    for (int k : {0, 1})  // positions of the small sphere are rounded to 1e-10 of its radius
      EXPECT_NEAR(1e-6 * values[2 * surface.vertex(Row(i + sphere.vertices())).index + k],
                  values[2 * surface.vertex(Row(i)).index + k], 1e-7);
}

TEST(Curvature, ChangesSignWithTheNormalAndScalesWithLength) {
  Mesh mesh = icosphere(8);
  for (Vec3& p : mesh.positions) p[0] *= 1.3, p[2] *= 0.7;
  const auto surface = surface_of(mesh);
  for (Vec3& p : mesh.positions) p = 1e100 * p;
  for (auto& face : mesh.faces) std::swap(face[0], face[1]);
  const auto other = surface_of(mesh);
  const PrincipalCurvatures a = curvature_directions(surface.graph()), b = curvature_directions(other.graph());
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const Vertex v = surface.vertex(Row(i)), w = other.vertex(Row(i));
    for (int k : {0, 1}) EXPECT_NEAR(b.values[2 * w.index + k] * 1e100, -a.values[2 * v.index + k], 1e-9);
    if (std::abs(a.values[2 * v.index] - a.values[2 * v.index + 1]) < 0.1) continue;
    EXPECT_NEAR(std::abs(dot(in_space(*surface.graph().frame(v.index), a.direction(v)),
                             in_space(*other.graph().frame(w.index), b.direction(w)))),
                1, 1e-9);
  }
}

// ------------------------------------------------------------------------------------------------ normals

TEST(SourceSideNormals, OfAMoebiusBandChangeSideOnlyFarFromTheSource) {
  const auto band = surface_of(moebius_mesh(80, 6));
  const CsrGraph& graph = band.graph();
  const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex{0}), {.frames = true});
  const std::vector<Vec3> normals = source_side_normals(graph, map);
  const auto is_near = [](Index i) { return std::min(i / 7, 80 - i / 7) <= 20; };  // within a quarter of the turn
  EXPECT_GT(dot(normals[0], graph.frame(0)->normal), 0.9);
  int changes = 0;
  for (Index i = 0; i < graph.size(); ++i)
    for (Index j : graph.star(i).neighbors) {
      const bool same_side = dot(normals[i], normals[j]) > 0;
      if (is_near(i) && is_near(j))
        ASSERT_TRUE(same_side) << i << ", " << j;
      else
        changes += !same_side;
    }
  EXPECT_GT(changes, 0);  // both sides meet after half a turn
}

}  // namespace
}  // namespace ahm::test
