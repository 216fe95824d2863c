// Polar maps: the laws of a log map, on every backend.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::test {
namespace {

using pointcloud::PointCloudSurface;
using polymesh::PolygonMeshSurface;
using trimesh::TriangleMeshSurface;

TriangleMeshSurface built(const Mesh& mesh) { return TriangleMeshSurface::build(mesh.positions, mesh.faces); }

/// Largest difference of two maps at the vertices that both have, relative to the largest distance; infinite where one has a vertex
/// more.
double difference(const LogMap& a, const LogMap& b) {
  double largest = 0, farthest = 0;
  for (Index i = 0; i < a.size(); ++i) {
    const Vertex v(i);
    if (a.status(v) != b.status(v)) return INFINITY;
    if (a.status(v) != Status::ok) continue;
    const auto p = a.coordinates(v), q = b.coordinates(v);
    largest = std::max({largest, std::hypot(p[0] - q[0], p[1] - q[1]), std::abs(a.distance(v) - b.distance(v))});
    farthest = std::max(farthest, a.distance(v));
  }
  return largest / farthest;
}

// ---------------------------------------------------------------------------------------------- planes

/// The map in the axes of the source's frame in space, against positions in space.
double plane_error(const Surface& surface, const SurfacePoint& source) {
  const Vec3 axis{0.3, 0.8, 0.1};
  const SurfaceSource placed = surface.source(source, axis);
  const RowLogMap rows = surface.to_rows(PolarMapSolver(surface).log_map(source, axis));
  double error = 0, diameter = 0;
  for (std::size_t r = 0; r < rows.u.size(); ++r) {
    if (rows.status[r] == Status::removed) continue;
    const Vec3 way = surface.positions()[r] - placed.position;
    error = std::max(error, std::hypot(dot(way, placed.frame->x) - rows.u[r], dot(way, placed.frame->y) - rows.v[r]));
    diameter = std::max(diameter, std::sqrt(dot(way, way)));
  }
  return error / diameter;
}

TEST(PolarMap, IsExactOnPlanesOfTriangles) {
  for (const Mesh& mesh : {flat_square(21), sliver_square(300), hexagon(9)}) {
    const auto surface = built(mesh);
    for (const SurfacePoint& source : {SurfacePoint{Row(7)}, SurfacePoint{FacePoint{40, {0.2, 0.3, 0.5}}}})
      EXPECT_LT(plane_error(surface, source), 1e-12);
  }
}

TEST(PolarMap, IsExactOnPlanesOfPolygons) {
  for (Polygons mesh : {voronoi_square(200), quad_grid(15), brick_wall(8)}) {
    tilt(mesh);
    const auto surface = PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners);
    EXPECT_LT(plane_error(surface, Row(11)), 1e-12);
  }
}

/// A square whose boundary is straight, so that no shortest path bends.
TEST(PolarMap, IsExactOnPlanesOfPoints) {
  for (const Row source : {Row(5), Row(200)})
    EXPECT_LT(plane_error(PointCloudSurface::build(flat_square(21).positions), source), 1e-12);
}

TEST(PolarMap, IsExactOnPlanesOfGrids) {
  const grid::GridGraph graph({.shape = {17, 13}, .spacing = {0.5, 0.5}});
  const LogMap map = PolarMapSolver(graph).log_map(Vertex(30));
  const auto at = [](Index i) { return std::array{0.5 * (i % 17), 0.5 * (i / 17)}; };
  for (Index i = 0; i < map.size(); ++i) {
    EXPECT_NEAR(map.coordinates(Vertex(i))[0], at(i)[0] - at(30)[0], 1e-11);
    EXPECT_NEAR(map.coordinates(Vertex(i))[1], at(i)[1] - at(30)[1], 1e-11);
  }
}

// ---------------------------------------------------------------------------------------------- symmetry

TEST(PolarMap, TurnsWithTheSourceAxes) {
  const auto surface = built(torus(900));
  const PolarMapSolver solver(surface, {.windows = 2000});
  const Vec3 x{0, 0, 1}, y{0, 1, 0.2};
  const LogMap a = solver.log_map(Row(10), x), b = solver.log_map(Row(10), y);
  const Frame u = *surface.source(Row(10), x).frame, w = *surface.source(Row(10), y).frame;
  const double c = dot(u.x, w.x), s = dot(u.y, w.x);
  for (Index i = 0; i < a.size(); ++i) {
    const auto p = a.coordinates(Vertex(i)), q = b.coordinates(Vertex(i));
    EXPECT_NEAR(q[0], c * p[0] + s * p[1], 1e-11);
    EXPECT_NEAR(q[1], c * p[1] - s * p[0], 1e-11);
  }
}

TEST(PolarMap, DoesNotDependOnTheOrderOfRows) {
  const Mesh mesh = torus(900);
  std::vector<Index> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  Mesh other = mesh;
  for (std::size_t i = 0; i < order.size(); ++i) other.positions[order[i]] = mesh.positions[i];
  for (Triangle& t : other.faces)
    for (Index& corner : t) corner = order[corner];
  std::shuffle(other.faces.begin(), other.faces.end(), std::mt19937(6));
  const Vec3 axis{0, 0, 1};
  const auto one = built(mesh), two = built(other);
  const RowLogMap a = one.to_rows(PolarMapSolver(one, {.windows = 3000}).log_map(Row(4), axis)),
                  b = two.to_rows(PolarMapSolver(two, {.windows = 3000}).log_map(Row(order[4]), axis));
  // Of equally long paths another one may count, and what follows from it.
  double off = 0, turned = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Index j = order[i];
    off = std::max(off, std::abs(a.distance[i] - b.distance[j]));
    turned += std::hypot(a.u[i] - b.u[j], a.v[i] - b.v[j]) > 0.01;
  }
  EXPECT_LT(off, 0.01);
  EXPECT_LT(turned, 0.02 * static_cast<double>(order.size()));
}

TEST(PolarMap, MirrorsWithTheSurface) {
  const Mesh mesh = torus(900);
  Mesh other = mesh;
  for (Vec3& p : other.positions) p[0] = -p[0];
  for (Triangle& t : other.faces) std::swap(t[1], t[2]);
  const Vec3 axis{0, 0, 1};
  const auto one = built(mesh), two = built(other);
  const RowLogMap a = one.to_rows(PolarMapSolver(one, {.windows = 0}).log_map(Row(4), axis)),
                  b = two.to_rows(PolarMapSolver(two, {.windows = 0}).log_map(Row(4), axis));
  for (std::size_t i = 0; i < a.u.size(); ++i) {
    EXPECT_NEAR(a.u[i], b.u[i], 0.01);
    EXPECT_NEAR(a.v[i], -b.v[i], 0.01);
  }
}

TEST(PolarMap, DoesNotDependOnTheNumberOfThreads) {
  const auto surface = built(torus(6000));
  const LogMap a = PolarMapSolver(surface, {.threads = 1}).log_map(Row(4)),
               b = PolarMapSolver(surface, {.threads = 4}).log_map(Row(4));
  EXPECT_EQ(difference(a, b), 0);
}

// ---------------------------------------------------------------------------------------------- exact maps

TEST(PolarMap, IsTheExactMapWhereWindowsReach) {
  for (const Mesh& mesh : {torus(900), folded_strip(15), holed_square(21)}) {
    const auto surface = built(mesh);
    const ExactGeodesics geodesics(surface);
    const Vec3 axis{0.1, 0.2, 0.9};
    for (const SurfacePoint& source : {SurfacePoint{Row(10)}, SurfacePoint{FacePoint{33, {0.2, 0.3, 0.5}}},
                                       SurfacePoint{FacePoint{50, {0.5, 0, 0.5}}}}) {
      const LogMap polar = PolarMapSolver(surface).log_map(source, axis, {.frames = true}),
                   exact = geodesics.log_map(source, axis, {.frames = true});
      EXPECT_LT(difference(exact, polar), 1e-12);
      for (std::size_t i = 0; i < exact.frames().size(); ++i)
        EXPECT_NEAR(polar.frames()[i], exact.frames()[i], 1e-9) << i / 4;
    }
    // And as far as some of them reach.
    constexpr Offset some = 4000;
    const LogMap polar = PolarMapSolver(surface, {.windows = some}).log_map(Row(10)),
                 exact = geodesics.log_map(Row(10), {}, {.max_windows = some}), whole = geodesics.log_map(Row(10));
    for (Index i = 0; i < exact.size(); ++i)
      if (exact.status(Vertex(i)) == Status::ok) {
        EXPECT_NEAR(polar.coordinates(Vertex(i))[0], whole.coordinates(Vertex(i))[0], 1e-12);
        EXPECT_NEAR(polar.coordinates(Vertex(i))[1], whole.coordinates(Vertex(i))[1], 1e-12);
      }
    EXPECT_GT(exact.count(Status::ok), 50);
    EXPECT_EQ(polar.count(Status::ok), polar.size());
  }
}

TEST(PolarMap, ExpectsTheErrorsThatItMakes) {
  const auto surface = built(torus(6000));
  const LogMap polar = PolarMapSolver(surface, {.windows = 0}).log_map(Row(100)),
               exact = ExactGeodesics(surface).log_map(Row(100));
  Index trusted = 0, right = 0;
  for (Index i = 0; i < polar.size(); ++i) {
    const Vertex v(i);
    const double d = exact.distance(v);
    if (!(d > 0.1) || polar.error_estimate()[i] > 0.1 * polar.distance(v)) continue;
    ++trusted;
    const auto p = polar.coordinates(v), q = exact.coordinates(v);
    right += std::hypot(p[0] - q[0], p[1] - q[1]) < 0.1 * d;
  }
  EXPECT_GT(trusted, 0.7 * polar.size());
  EXPECT_GT(right, 0.97 * trusted);
}

// ---------------------------------------------------------------------------------------------- smooth surfaces

/// Root mean square of the vector error on the unit sphere within 0.8 pi.
double error_on_sphere(Index parts, Offset windows) {
  const Mesh mesh = icosphere(parts);
  const auto surface = built(mesh);
  const Row source(17);
  const Vec3 axis{0.3, 0.4, 0.5};
  const Vec3 p = mesh.positions[17], x = normalized(axis - dot(axis, p) * p), y = cross(p, x);
  const RowLogMap rows = surface.to_rows(PolarMapSolver(surface, {.windows = windows}).log_map(source, axis));
  return sphere_error(mesh.positions, rows.u, rows.v, 17, x, y, 0.8 * std::numbers::pi).rms;
}

TEST(PolarMap, ConvergesOnTheSphere) {
  EXPECT_LT(error_on_sphere(48, 0), error_on_sphere(12, 0) / 5);
  EXPECT_LT(error_on_sphere(48, 0), 1e-3);
  // Windows see the triangles and not the sphere, whose log map that of the polyhedron approaches more slowly.
  EXPECT_LT(error_on_sphere(48, 20000), error_on_sphere(12, 20000) / 2);
}

// ---------------------------------------------------------------------------------------------- frames

/// With frames, the direction of the map carried to a vertex is the gradient of the distance.
TEST(PolarMap, CarriesDirectionsToTheGradientOfTheDistance) {
  const Mesh mesh = icosphere(24);
  const auto surface = built(mesh);
  const auto cloud = PointCloudSurface::build(mesh.positions);
  for (const ahm::Surface* on : {static_cast<const ahm::Surface*>(&surface), static_cast<const ahm::Surface*>(&cloud)})
    for (const Offset windows : {Offset{0}, Offset{3000}}) {
      const LogMap map = PolarMapSolver(*on, {.windows = windows}).log_map(Row(17), {}, {.frames = true});
      const RowLogMap rows = on->to_rows(map);
      const std::vector<Vec3> away = distance_gradients(*on, map, rows);
      const Vec3& p = mesh.positions[17];
      for (std::size_t r = 0; r < away.size(); ++r) {
        const Vec3& q = mesh.positions[r];
        const double c = dot(p, q);
        if (r == 17 || c < -0.9) continue;
        const Vec3 gradient = normalized(c * q - p);
        EXPECT_GT(dot(away[r], gradient), 0.99) << r << " at " << rows.distance[r];
      }
    }
}

// ---------------------------------------------------------------------------------------------- statuses

TEST(PolarMap, MasksOtherPartsAndWhatIsBeyondTheRadius) {
  const Mesh one = icosphere(6);
  const auto surface = built(joined(one, one, {5, 0, 0}));
  const PolarMapSolver solver(surface);
  const LogMap whole = solver.log_map(Row(7)), near = solver.log_map(Row(7), {}, {.radius = 1});
  for (Index i = 0; i < whole.size(); ++i) {
    const Vertex v(i);
    const bool here = i < one.vertices();
    EXPECT_EQ(whole.status(v), here ? Status::ok : Status::disconnected);
    EXPECT_EQ(near.status(v), !here                    ? Status::disconnected
                              : whole.distance(v) <= 1 ? Status::ok
                                                       : Status::beyond_radius);
    EXPECT_EQ(std::isnan(near.coordinates(v)[0]), near.status(v) != Status::ok);
    EXPECT_EQ(std::isnan(near.error_estimate()[i]), near.status(v) != Status::ok);
  }
}

TEST(PolarMap, OfAMoebiusBandIsMirroredOnTheWayAround) {
  const auto surface = built(moebius_mesh(60, 9));
  const LogMap polar = PolarMapSolver(surface, {.windows = 0}).log_map(Row(30)),
               exact = ExactGeodesics(surface).log_map(Row(30));
  Index right = 0;
  for (Index i = 0; i < polar.size(); ++i) {
    const auto p = polar.coordinates(Vertex(i)), q = exact.coordinates(Vertex(i));
    right += std::hypot(p[0] - q[0], p[1] - q[1]) <= 0.1 * exact.distance(Vertex(i));
  }
  EXPECT_GT(right, 0.9 * polar.size());
}

TEST(PolarMap, OfSeveralPointsIsThatOfTheNearest) {
  const auto surface = built(icosphere(9));
  const std::vector<Vertex> sources{Vertex(3), Vertex(70), Vertex(200)};
  const LogMap map = PolarMapSolver(surface).log_map(Source::at_vertices(sources));
  for (Index i = 0; i < map.size(); ++i) {
    const auto phi = map.coordinates(Vertex(i));
    EXPECT_NEAR(std::hypot(phi[0], phi[1]), map.distance(Vertex(i)), 1e-12);
    EXPECT_TRUE(map.nearest()[i] >= 0 && map.nearest()[i] < 3);
  }
}

TEST(PolarMap, RefusesWhatItCannotMap) {
  const CsrGraph volume(lattice3(4).data);
  EXPECT_THROW(PolarMapSolver{volume}, InvalidArgument);
  const auto surface = built(icosphere(3));
  const PolarMapSolver solver(surface);
  EXPECT_THROW(solver.log_map(Row(0), {}, {.radius = 0}), InvalidArgument);
  EXPECT_THROW(solver.log_map(Row(9999)), InvalidArgument);
  const PolarMapSolver of_graph(surface.graph());
  EXPECT_THROW(of_graph.log_map(Row(0)), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
