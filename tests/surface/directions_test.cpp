// Directions for the u axis: of space, and of principal curvature.
#include "ahm/surface/directions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/error.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

using trimesh::TriangleMeshSurface;

Vec3 in_space(const Frame& frame, std::span<const double> v) {
  Vec3 result;
  for (int a = 0; a < 3; ++a) result[a] = v[0] * frame.x[a] + v[1] * frame.y[a];
  return result;
}

TEST(DirectionInFrame, TurnsTheUAxisAlongAVectorOfSpace) {
  const Mesh mesh = sliver_square(120);
  const SolvedMesh plane(mesh);
  const CsrGraph& graph = plane.surface.graph();
  const Vec3 up{0.3, -0.5, 2};
  for (Index p : {0, 50, 110}) {
    const Frame frame = *graph.frame(p);
    const double height = dot(up, frame.normal);
    Vec3 along;
    for (int a = 0; a < 3; ++a) along[a] = up[a] - height * frame.normal[a];
    const double r = std::sqrt(dot(along, along));
    const LogMap map = plane.solver.solve(Source::at_vertex(Vertex(p), direction_in_frame(graph, Vertex{p}, up)));
    for (Index i = 0; i < graph.size(); ++i) {
      Vec3 away;
      for (int a = 0; a < 3; ++a) away[a] = graph.frame(i)->origin[a] - frame.origin[a];
      EXPECT_NEAR(map.coordinates(Vertex(i))[0], dot(away, along) / r, 1e-11);
    }
  }
}

TEST(DirectionInFrame, RefusesWhatHasNoDirection) {
  const grid::GridGraph grid({.shape = {4, 4}, .spacing = {1, 1}}), space({.shape = {4, 4, 4}, .spacing = {1, 1, 1}});
  const CsrGraph abstract(planar_triangulation(4).data);
  EXPECT_THROW(direction_in_frame(grid, Vertex{0}, {0, 0, 1}), InvalidArgument);
  EXPECT_THROW(direction_in_frame(grid, Vertex{0}, {0, 0, 0}), InvalidArgument);
  EXPECT_THROW(direction_in_frame(grid, Vertex{0}, {0, NAN, 1}), InvalidArgument);
  EXPECT_THROW(direction_in_frame(grid, Vertex{16}, {0, 1, 0}), InvalidArgument);
  EXPECT_THROW(direction_in_frame(space, Vertex{0}, {0, 1, 0}), InvalidArgument);
  EXPECT_THROW(direction_in_frame(abstract, Vertex{0}, {0, 1, 0}), InvalidArgument);
  EXPECT_THROW(curvature_directions(space), InvalidArgument);
  EXPECT_THROW(curvature_directions(abstract), InvalidArgument);
}

TEST(Curvature, OfThePlaneIsZero) {
  const Mesh mesh = holed_square(16);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  for (double kappa : curvature_directions(surface.graph()).values) EXPECT_NEAR(kappa, 0, 1e-9);
  for (double kappa : curvature_directions(grid::GridGraph({.shape = {5, 4}, .spacing = {1, 2}})).values)
    EXPECT_EQ(kappa, 0);
}

TEST(Curvature, IsUnknownWithoutEdges) {
  // The middle of a block of 2 x 2 obstacles.
  std::vector<std::uint8_t> blocked(64, 0);
  for (int cell : {27, 28, 35, 36}) blocked[cell] = 1;
  const grid::GridGraph grid({.shape = {9, 9}, .spacing = {1, 1}, .origin = {}, .blocked = blocked});
  const PrincipalCurvatures bend = curvature_directions(grid);
  for (Index i = 0; i < 81; ++i) EXPECT_EQ(std::isnan(bend.values[2 * i]), i == 40) << "vertex " << i;
}

TEST(Curvature, OfACylinderRunsRoundIt) {
  const double radius = 0.4;
  for (Index side : {20, 40, 80}) {
    const Mesh mesh = rolled_square(side, radius);
    const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
    const CsrGraph& graph = surface.graph();
    const PrincipalCurvatures bend = curvature_directions(graph);
    // A circle leaves its parabola by (x / R)^2 / 4 of it. Off the border vertices lie amid those of the fit; on it the
    // difference of fourth order is one of third order.
    const double reach = 2 * surface.details().longest_edge / radius;
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const auto& p = mesh.plane[i];
      const bool border = std::min({p[0], p[1], 1 - p[0], 1 - p[1]}) < 2.5 / side;
      const double tolerance = border ? reach : reach * reach / 4;
      const Index v = surface.vertex(Row(i)).index;
      EXPECT_NEAR(std::abs(bend.values[2 * v]) * radius, 1, tolerance) << i;
      EXPECT_NEAR(bend.values[2 * v + 1] * radius, 0, tolerance) << i;
      EXPECT_NEAR(in_space(*graph.frame(v), bend.direction(Vertex(v)))[0], 0, tolerance) << i;
    }
  }
}

/// The shape operator of the ellipsoid sum (x / a)^2 = 1 with normals outwards, as a form on space.
double ellipsoid_curvature(const Vec3& axes, const Vec3& p, const Vec3& u, const Vec3& v) {
  double gradient = 0, form = 0;
  for (int a = 0; a < 3; ++a) {
    gradient += std::pow(p[a] / (axes[a] * axes[a]), 2);
    form += u[a] * v[a] / (axes[a] * axes[a]);
  }
  return form / std::sqrt(gradient);
}

TEST(Curvature, OfAnEllipsoidIsThatOfItsEquation) {
  const Vec3 axes{1, 0.8, 0.6};
  for (Index parts : {10, 20, 40}) {
    Mesh mesh = icosphere(parts);
    for (Vec3& p : mesh.positions)
      for (int a = 0; a < 3; ++a) p[a] *= axes[a];
    const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
    const auto cloud = pointcloud::PointCloudSurface::build(mesh.positions);
    for (const CsrGraph* graph : {&surface.graph(), &cloud.graph()}) {
      const PrincipalCurvatures bend = curvature_directions(*graph);
      double worst = 0, mixed = 0;
      for (Index i = 0; i < graph->size(); ++i) {
        const Frame frame = *graph->frame(i);
        const auto d = bend.direction(Vertex(i));
        const Vec3 u = in_space(frame, d), v = in_space(frame, std::array{-d[1], d[0]});
        const double outwards = dot(frame.normal, frame.origin) > 0 ? 1 : -1;
        const double uu = ellipsoid_curvature(axes, frame.origin, u, u),
                     vv = ellipsoid_curvature(axes, frame.origin, v, v),
                     uv = ellipsoid_curvature(axes, frame.origin, u, v);
        worst = std::max(
            {worst, std::abs(outwards * bend.values[2 * i] - uu), std::abs(outwards * bend.values[2 * i + 1] - vv)});
        mixed = std::max(mixed, std::abs(uv));
      }
      // First order; third derivatives of this ellipsoid are of order one.
      const double h = graph->mean_edge_length() * graph->length_unit();
      EXPECT_LT(worst, h) << parts << " parts";
      EXPECT_LT(mixed, h) << parts << " parts";
    }
  }
}

TEST(Curvature, DoesNotDependOnTheSizeOfOtherPieces) {
  const Mesh sphere = icosphere(6);
  Mesh both = sphere;
  for (const Vec3& p : sphere.positions) both.positions.push_back({1e-6 * p[0] + 3, 1e-6 * p[1], 1e-6 * p[2]});
  for (const auto& f : sphere.faces)
    both.faces.push_back({f[0] + sphere.vertices(), f[1] + sphere.vertices(), f[2] + sphere.vertices()});
  const auto surface = TriangleMeshSurface::build(both.positions, both.faces);
  const PrincipalCurvatures bend = curvature_directions(surface.graph());
  for (Index i = 0; i < sphere.vertices(); ++i)
    for (int k : {0, 1})  // positions of the small one are rounded to 1e-10 of it
      EXPECT_NEAR(1e-6 * bend.values[2 * surface.vertex(Row(i + sphere.vertices())).index + k],
                  bend.values[2 * surface.vertex(Row(i)).index + k], 1e-7);
}

TEST(Curvature, ChangesSignWithTheNormalAndScalesWithLength) {
  Mesh mesh = icosphere(8);
  for (Vec3& p : mesh.positions) p[0] *= 1.3, p[2] *= 0.7;
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  for (Vec3& p : mesh.positions)
    for (double& x : p) x *= 1e100;
  for (auto& face : mesh.faces) std::swap(face[0], face[1]);
  const auto other = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const PrincipalCurvatures a = curvature_directions(surface.graph()), b = curvature_directions(other.graph());
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const Index v = surface.vertex(Row(i)).index, w = other.vertex(Row(i)).index;
    for (int k : {0, 1}) EXPECT_NEAR(b.values[2 * w + k] * 1e100, -a.values[2 * v + k], 1e-9);
    if (std::abs(a.values[2 * v] - a.values[2 * v + 1]) < 0.1) continue;
    const Vec3 along = in_space(*surface.graph().frame(v), a.direction(Vertex(v))),
               same = in_space(*other.graph().frame(w), b.direction(Vertex(w)));
    EXPECT_NEAR(std::abs(dot(along, same)), 1, 1e-9);
  }
}

}  // namespace
}  // namespace ahm::test
