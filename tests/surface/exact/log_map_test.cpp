// Exact maps beside those of heat: one result, whichever way it was made.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

using polymesh::Discretization;
using polymesh::PolygonMeshSurface;
using trimesh::TriangleMeshSurface;
using Sources = std::vector<SurfacePoint>;

/// Every third face turned over.
Mesh with_reversed_faces(Mesh mesh) {
  for (std::size_t f = 0; f < mesh.faces.size(); f += 3) std::swap(mesh.faces[f][0], mesh.faces[f][1]);
  return mesh;
}

Sources sources_in(const Surface& surface) {
  Sources result{Row(0), Row(static_cast<Index>(surface.positions().size() / 2))};
  for (Index face : {3, 10, 33}) {
    const auto corners = surface.faces()[face];
    FacePoint inside{face, std::vector<double>(corners.size(), 0.5 / static_cast<double>(corners.size() - 1))};
    inside.barycentric[1] = 0.5;
    FacePoint corner{face, std::vector<double>(corners.size(), 0.0)};
    corner.barycentric[2] = 1;
    result.insert(result.end(), {inside, corner, EdgePoint{Row(corners[0]), Row(corners[1]), 0.3},
                                 EdgePoint{Row(corners[2]), Row(corners[1]), 0.7}});
  }
  return result;
}

double largest_difference(std::span<const double> a, std::span<const double> b) {
  EXPECT_EQ(a.size(), b.size());
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    worst = std::max(worst, std::isnan(a[k] - b[k]) ? HUGE_VAL : std::abs(a[k] - b[k]));
  return worst;
}

void expect_heat_and_exact_agree(const Surface& surface, const Sources& sources, const std::optional<Vec3>& u_axis) {
  const LogMapSolver solver(surface.graph());
  const ExactGeodesics geodesics(surface);
  for (const SurfacePoint& source : sources) {
    const LogMap heat = solver.solve(surface.source(source, u_axis).source, {.frames = true});
    const LogMap exact = geodesics.log_map(source, u_axis, {.frames = true});
    EXPECT_LT(largest_difference(exact.coordinates(), heat.coordinates()), 1e-9);
    std::vector<double> lengths;
    for (Index v = 0; v < heat.size(); ++v)
      lengths.push_back(std::hypot(heat.coordinates(Vertex(v))[0], heat.coordinates(Vertex(v))[1]));
    EXPECT_LT(largest_difference(exact.distances(), lengths), 1e-9);
    EXPECT_LT(largest_difference(exact.distances(), heat.distances()), 1e-8);  // slivers cost unfolding some digits
    EXPECT_LT(largest_difference(exact.frames(), heat.frames()), 1e-7);
    for (Index v = 0; v < exact.size(); ++v) EXPECT_EQ(exact.status(Vertex(v)), Status::ok);
  }
}

TEST(ExactLogMap, IsThatOfHeatOnPlanes) {
  for (const Mesh& mesh : {flat_square(11), with_reversed_faces(flat_square(11)), sliver_square(60)}) {
    const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
    expect_heat_and_exact_agree(surface, sources_in(surface), std::nullopt);
    expect_heat_and_exact_agree(surface, sources_in(surface), Vec3{0.3, 0.9, -0.2});
  }
}

TEST(ExactLogMap, IsThatOfHeatOnPlanarPolygons) {
  for (Polygons mesh : {voronoi_square(80), quad_grid(10)}) {
    for (Index f = 0; f < mesh.faces(); f += 3) mesh.reverse(f);
    const auto surface = PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners,
                                                   {.discretization = Discretization::refined});
    expect_heat_and_exact_agree(surface, sources_in(surface), std::nullopt);
    expect_heat_and_exact_agree(surface, sources_in(surface), Vec3{0.3, 0.9, -0.2});
  }
}

TEST(ExactLogMap, NeedsNoPositions) {
  const Mesh mesh = with_reversed_faces(flat_square(9));
  std::vector<std::array<double, 3>> lengths;
  for (const Triangle& t : mesh.faces) {
    auto& face = lengths.emplace_back();
    for (int s = 0; s < 3; ++s) {
      const Vec2 &a = mesh.plane[t[s]], &b = mesh.plane[t[(s + 1) % 3]];
      face[s] = std::hypot(a[0] - b[0], a[1] - b[1]);
    }
  }
  const auto surface =
      TriangleMeshSurface::build(trimesh::TriangleMesh::from_edge_lengths(mesh.vertices(), mesh.faces, lengths));
  const auto& t = mesh.faces[30];
  const Sources sources{Row(0), Row(40), FacePoint{30, {0.2, 0.3, 0.5}}, FacePoint{33, {0, 1, 0}},
                        EdgePoint{Row(t[2]), Row(t[0]), 0.25}};
  expect_heat_and_exact_agree(surface, sources, std::nullopt);
}

/// Least cosine between the directions of two maps at vertices near the source.
double least_cosine(const LogMap& a, const LogMap& b, double low, double high) {
  double least = 1;
  for (Index v = 0; v < a.size(); ++v) {
    if (!(a.distance(Vertex(v)) > low && a.distance(Vertex(v)) < high)) continue;
    const auto p = a.coordinates(Vertex(v)), q = b.coordinates(Vertex(v));
    least = std::min(least, (p[0] * q[0] + p[1] * q[1]) / std::hypot(p[0], p[1]) / std::hypot(q[0], q[1]));
  }
  return least;
}

void expect_axes_of_heat(const Surface& surface, double low, double high) {
  const LogMapSolver solver(surface.graph());
  const ExactGeodesics geodesics(surface);
  for (const SurfacePoint& source : sources_in(surface)) {
    const LogMap heat = solver.solve(surface.source(source).source);
    EXPECT_GT(least_cosine(geodesics.log_map(source), heat, low, high), 0.99);
  }
}

TEST(ExactLogMap, HasTheAxesOfHeatOnCurvedSurfaces) {
  const Mesh sphere = with_reversed_faces(icosphere(20)), moebius = moebius_mesh(120, 20);
  expect_axes_of_heat(TriangleMeshSurface::build(sphere.positions, sphere.faces), 0.1, 0.6);
  expect_axes_of_heat(TriangleMeshSurface::build(moebius.positions, moebius.faces), 0.05, 0.25);
  const Polygons cube = cube_sphere(20);
  expect_axes_of_heat(PolygonMeshSurface::build(cube.positions, cube.begin, cube.corners), 0.1, 0.6);
}

TEST(ExactLogMap, HasGradientsAlongGreatCircles) {
  const Mesh sphere = icosphere(16);
  const auto surface = TriangleMeshSurface::build(sphere.positions, sphere.faces);
  const LogMap map = exact_log_map(surface, Row(100), std::nullopt, {.frames = true});
  const RowLogMap rows = surface.to_rows(map);
  const std::vector<Vec3> away = distance_gradients(surface, map, rows);
  const Vec3& p = sphere.positions[100];
  for (std::size_t r = 0; r < away.size(); ++r) {
    if (rows.distance[r] < 0.05 || rows.distance[r] > 2.9) continue;
    const Vec3& q = sphere.positions[r];
    const double c = p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    double along = 0;  // away from p: c q - p, of length sqrt(1 - c^2)
    for (std::size_t k = 0; k < 3; ++k) along += away[r][k] * (c * q[k] - p[k]);
    EXPECT_GT(along / std::sqrt(1 - c * c), 0.99);
  }
}

TEST(ExactLogMap, IsTrustedButAtItsCutLocus) {
  const Mesh sphere = icosphere(12);
  const auto surface = TriangleMeshSurface::build(sphere.positions, sphere.faces);
  const ExactGeodesics geodesics(surface);
  const LogMap near = geodesics.log_map(Row(100), std::nullopt, {.radius = 2});
  const std::vector<double> inside = map_quality(surface.graph(), near);
  for (Index v = 0; v < near.size(); ++v) {
    EXPECT_EQ(std::isnan(inside[v]), near.status(Vertex(v)) != Status::ok);
    if (near.status(Vertex(v)) == Status::ok) EXPECT_GT(inside[v], 0.97);
  }
  // The antipode is the cut locus.
  const LogMap whole = geodesics.log_map(Row(100));
  const std::vector<double> quality = map_quality(surface.graph(), whole);
  Index doubted = 0;
  for (Index v = 0; v < whole.size(); ++v) {
    if (whole.distance(Vertex(v)) < 2.5) EXPECT_GT(quality[v], trusted_quality);
    doubted += quality[v] < trusted_quality;
  }
  EXPECT_GT(doubted, 2);
  const auto farthest =
      std::max_element(whole.distances().begin(), whole.distances().end()) - whole.distances().begin();
  EXPECT_LT(quality[farthest], trusted_quality);
}

TEST(ExactLogMap, IsTrustedEverywhereOnPlanes) {
  const Mesh mesh = flat_square(15);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  for (double q : map_quality(surface.graph(), exact_log_map(surface, Row(40)))) EXPECT_EQ(q, 1);
}

TEST(ExactLogMap, OfSeveralSourcesIsThatOfTheNearest) {
  const Mesh mesh = icosphere(9);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const ExactGeodesics geodesics(surface);
  std::vector<ExactSource> sources;
  // None in the middle of anything: two ways of one length would be a tie.
  for (Index face : {3, 50, 133, 390}) sources.push_back({FacePoint{face, {0.21, 0.33, 0.46}}, Vec3{0.2, -0.3, 0.4}});
  sources.push_back({EdgePoint{Row(mesh.faces[77][0]), Row(mesh.faces[77][1]), 0.37}, Vec3{0.2, -0.3, 0.4}});
  std::vector<LogMap> single;
  for (const ExactSource& s : sources) single.push_back(geodesics.log_map(s.point, s.u_axis));
  // Moved in the plane of coordinates, which changes neither labels nor distances.
  for (std::size_t k = 0; k < sources.size(); ++k) {
    sources[k].position = {static_cast<double>(k), 0.5};
    sources[k].angle = 0.4 * static_cast<double>(k);
    sources[k].mirrored = k % 3 == 1;
  }
  const auto [map, labels] = geodesics.log_map(sources, {.radius = 9, .frames = true, .progress = {}});
  for (Index v = 0; v < map.size(); ++v) {
    const Vertex vertex(v);
    double least = HUGE_VAL, next = HUGE_VAL;
    for (const LogMap& one : single) {
      next = std::min(next, std::max(least, one.distance(vertex)));
      least = std::min(least, one.distance(vertex));
    }
    EXPECT_NEAR(map.distance(vertex), least, 1e-12);
    if (next - least < 1e-9) continue;  // either may be the nearest
    const ExactSource& s = sources[labels[v]];
    const auto phi = single[labels[v]].coordinates(vertex);
    const double side = s.mirrored ? -phi[1] : phi[1], c = std::cos(s.angle), t = std::sin(s.angle);
    EXPECT_NEAR(map.coordinates(vertex)[0], s.position[0] + c * phi[0] - t * side, 1e-9);
    EXPECT_NEAR(map.coordinates(vertex)[1], s.position[1] + t * phi[0] + c * side, 1e-9);
  }
  EXPECT_EQ(map.source().is_curve(), true);
}

TEST(ExactLogMap, OfRowsIsNoCurve) {
  const Mesh mesh = icosphere(9);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const ExactGeodesics geodesics(surface);
  const std::vector<ExactSource> sources{{Row(3)}, {Row(70)}, {Row(200)}};
  const auto [map, labels] = geodesics.log_map(sources);
  EXPECT_FALSE(map.source().is_curve());
  const std::vector<double> quality = map_quality(surface.graph(), map);
  // Borders between sources are no cut locus.
  for (Index v = 0; v < map.size(); ++v) EXPECT_GT(quality[v], trusted_quality);
  EXPECT_THROW(geodesics.log_map(std::span<const ExactSource>{}), InvalidArgument);
}

TEST(ExactLogMap, SaysWhyAVertexHasNoCoordinates) {
  Mesh two = icosphere(6);
  const Index n = two.vertices();
  const Mesh one = two;
  for (const Vec3& p : one.positions) two.positions.push_back({p[0] + 5, p[1], p[2]});
  for (const Triangle& t : one.faces) two.faces.push_back({t[0] + n, t[1] + n, t[2] + n});
  two.positions.push_back({9, 9, 9});  // of no face
  const auto surface = TriangleMeshSurface::build(two.positions, two.faces);
  const ExactGeodesics geodesics(surface);
  const RowLogMap whole = surface.to_rows(geodesics.log_map(Row(7)));
  const LogMap near = geodesics.log_map(Row(7), std::nullopt, {.radius = 1.0});
  const RowLogMap part = surface.to_rows(near);
  EXPECT_EQ(near.method(), Method::exact);
  for (Index r = 0; r < 2 * n; ++r) {
    EXPECT_EQ(whole.status[r], r < n ? Status::ok : Status::disconnected);
    if (r >= n) {
      EXPECT_EQ(part.status[r], Status::disconnected);
    } else if (whole.distance[r] <= 1) {
      EXPECT_EQ(part.u[r], whole.u[r]);
      EXPECT_EQ(part.v[r], whole.v[r]);
    } else {
      EXPECT_EQ(part.status[r], Status::beyond_radius);
      EXPECT_TRUE(std::isnan(part.distance[r]) && std::isnan(part.u[r]));
    }
  }
  EXPECT_EQ(whole.status[2 * n], Status::removed);
  EXPECT_THROW(geodesics.log_map(Row(2 * n)), InvalidArgument);
}

TEST(ExactLogMap, ScalesWithTheSurface) {
  const double scale = std::ldexp(1.0, -700);
  Mesh small = icosphere(5);
  const auto large_surface = TriangleMeshSurface::build(small.positions, small.faces);
  for (Vec3& p : small.positions)
    for (double& x : p) x *= scale;
  const auto surface = TriangleMeshSurface::build(small.positions, small.faces);
  for (const SurfacePoint& source : {SurfacePoint{Row(3)}, SurfacePoint{FacePoint{8, {0.2, 0.3, 0.5}}}}) {
    const LogMap a = exact_log_map(large_surface, source),
                 b = exact_log_map(surface, source, {}, {.radius = 9 * scale});
    for (Index v = 0; v < a.size(); ++v) {
      EXPECT_NEAR(b.distance(Vertex(v)) / scale, a.distance(Vertex(v)), 1e-13);
      EXPECT_NEAR(b.coordinates(Vertex(v))[0] / scale, a.coordinates(Vertex(v))[0], 1e-12);
    }
  }
}

TEST(ExactLogMap, IsRefusedWithoutFlatTriangles) {
  const Mesh sphere = icosphere(8);
  const auto fault_of = [](const Surface& surface) {
    try {
      ExactGeodesics{surface};
    } catch (const InvalidArgument& e) {
      return std::string(e.fault());
    }
    return std::string();
  };
  EXPECT_EQ(fault_of(pointcloud::PointCloudSurface::build(sphere.positions)), "no_flat_triangles");
  const Polygons cube = cube_sphere(6);
  EXPECT_EQ(fault_of(PolygonMeshSurface::build(cube.positions, cube.begin, cube.corners,
                                               {.discretization = Discretization::polygons})),
            "polygons_not_refined");
}

TEST(ExactLogMap, IsCancelled) {
  const Mesh sphere = icosphere(8);
  const auto surface = TriangleMeshSurface::build(sphere.positions, sphere.faces);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(exact_log_map(surface, Row(0), {}, {.progress = {{}, stop.get_token()}}), Cancelled);
}

TEST(ExactLogMap, TellsHowFarItIs) {
  const Mesh sphere = icosphere(8);
  const auto surface = TriangleMeshSurface::build(sphere.positions, sphere.faces);
  std::vector<double> told;
  std::stop_source stop;
  ExactMapOptions options;
  options.progress = {[&](std::string_view, double fraction) { told.push_back(fraction); }, {}};
  exact_log_map(surface, Row(0), {}, options);
  ASSERT_GT(told.size(), 10U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1);
  options.progress = {[&](std::string_view, double fraction) {
                        if (fraction > 0.5) stop.request_stop();
                      },
                      stop.get_token()};
  EXPECT_THROW(exact_log_map(surface, Row(0), {}, options), Cancelled);
}

TEST(ExactGeodesics, PathsAndTracesAreStraightOnPlanes) {
  const Mesh mesh = with_reversed_faces(flat_square(15));
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const ExactGeodesics geodesics(surface);
  std::mt19937_64 random(3);
  for (int k = 0; k < 20; ++k) {
    const auto some_face = [&] { return static_cast<Index>(random() % mesh.faces.size()); };
    const std::array<SurfacePoint, 2> ends{FacePoint{some_face(), {0.2, 0.3, 0.5}},
                                           FacePoint{some_face(), {0.6, 0.3, 0.1}}};
    const Vec3 a = surface.position(ends[0]), b = surface.position(ends[1]);
    const exact::GeodesicPath path = geodesics.path(ends);
    const double length = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    EXPECT_NEAR(path.length, length, 1e-12);
    if (!(length > 0)) continue;
    const auto ray = geodesics.trace(ends[0], {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, length);
    EXPECT_EQ(ray.end, exact::TraceEnd::complete);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(geodesics.position(path.points.front())[c], a[c], 1e-12);
      EXPECT_NEAR(geodesics.position(path.points.back())[c], b[c], 1e-12);
      EXPECT_NEAR(geodesics.position(ray.points.back())[c], b[c], 1e-9);
    }
  }
}

}  // namespace
}  // namespace ahm::test
