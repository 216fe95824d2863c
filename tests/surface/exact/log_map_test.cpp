// Exact log maps compared with heat maps: axes, frames, statuses, quality.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/util/vec.hpp"
#include "surface/surfaces.hpp"

namespace ahm::test {
namespace {

using Sources = std::vector<SurfacePoint>;

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
  double largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    largest = std::max(largest, std::isnan(a[k] - b[k]) ? HUGE_VAL : std::abs(a[k] - b[k]));
  return largest;
}

void expect_heat_map(const Surface& surface, const Sources& sources, const std::optional<Vec3>& u_axis) {
  const LogMapSolver solver(surface.graph());
  const ExactGeodesics geodesics(surface);
  for (const SurfacePoint& source : sources) {
    const LogMap heat = solver.solve(surface.source(source, u_axis).source, {.frames = true});
    const LogMap exact = geodesics.log_map(source, u_axis, {.frames = true});
    EXPECT_LT(largest_difference(exact.coordinates(), heat.coordinates()), 1e-9);
    std::vector<double> lengths;
    for (Index v = 0; v < heat.size(); ++v) lengths.push_back(norm(vector_at(heat, v)));
    EXPECT_LT(largest_difference(exact.distances(), lengths), 1e-9);
    EXPECT_LT(largest_difference(exact.distances(), heat.distances()), 1e-8);  // unfolding slivers loses some digits
    EXPECT_LT(largest_difference(exact.frames(), heat.frames()), 1e-7);
    EXPECT_EQ(exact.count(Status::ok), exact.size());
  }
}

TEST(ExactLogMap, IsTheHeatMapOnPlanes) {
  const auto expect_heat_maps = [](const Surface& surface) {
    for (const std::optional<Vec3>& u_axis : {std::optional<Vec3>(), std::optional(Vec3{0.3, 0.9, -0.2})})
      expect_heat_map(surface, sources_in(surface), u_axis);
  };
  for (const Mesh& mesh : {flat_square(11), with_reversed_faces(flat_square(11)), sliver_square(60)})
    expect_heat_maps(surface_of(mesh));
  for (Polygons mesh : {voronoi_square(80), quad_grid(10)}) {
    for (Index f = 0; f < mesh.faces(); f += 3) mesh.reverse(f);
    expect_heat_maps(surface_of(mesh, polymesh::Discretization::refined));
  }
}

TEST(ExactLogMap, DoesNotNeedPositions) {
  const Mesh mesh = with_reversed_faces(flat_square(9));
  std::vector<std::array<double, 3>> lengths;
  for (const Triangle& t : mesh.faces) {
    const Vec2 &a = mesh.plane[t[0]], &b = mesh.plane[t[1]], &c = mesh.plane[t[2]];
    lengths.push_back({norm(b - a), norm(c - b), norm(a - c)});
  }
  const auto surface = trimesh::TriangleMeshSurface::build(
      trimesh::TriangleMesh::from_edge_lengths(mesh.vertices(), mesh.faces, lengths));
  const auto& t = mesh.faces[30];
  const Sources sources{Row(0), Row(40), FacePoint{30, {0.2, 0.3, 0.5}}, FacePoint{33, {0, 1, 0}},
                        EdgePoint{Row(t[2]), Row(t[0]), 0.25}};
  expect_heat_map(surface, sources, std::nullopt);
}

TEST(ExactLogMap, HasTheAxesOfHeatMapsOnCurvedSurfaces) {
  const auto expect_heat_axes = [](const Surface& surface, double low, double high) {
    const LogMapSolver solver(surface.graph());
    const ExactGeodesics geodesics(surface);
    for (const SurfacePoint& source : sources_in(surface)) {
      const LogMap heat = solver.solve(surface.source(source).source), exact = geodesics.log_map(source);
      for (Index v = 0; v < heat.size(); ++v)
        if (const double d = exact.distance(Vertex(v)); d > low && d < high)
          EXPECT_GT(dot(normalized(vector_at(heat, v)), normalized(vector_at(exact, v))), 0.99);
    }
  };
  expect_heat_axes(surface_of(with_reversed_faces(icosphere(20))), 0.1, 0.6);
  expect_heat_axes(surface_of(moebius_mesh(120, 20)), 0.05, 0.25);
  expect_heat_axes(surface_of(cube_sphere(20)), 0.1, 0.6);
}

TEST(ExactLogMap, HasGradientsAlongGreatCircles) {
  const Mesh sphere = icosphere(16);
  const auto surface = surface_of(sphere);
  const LogMap map = exact_log_map(surface, Row(100), std::nullopt, {.frames = true});
  const RowLogMap rows = surface.to_rows(map);
  const std::vector<Vec3> gradients = distance_gradients(surface, map, rows);
  const Vec3& p = sphere.positions[100];
  for (std::size_t r = 0; r < gradients.size(); ++r) {
    if (rows.distance[r] < 0.05 || rows.distance[r] > 2.9) continue;
    const Vec3& q = sphere.positions[r];
    EXPECT_GT(dot(gradients[r], normalized(dot(p, q) * q - p)), 0.99);
  }
}

TEST(ExactLogMap, OfSeveralSourcesIsThatOfTheNearest) {
  const Mesh mesh = icosphere(9);
  const auto surface = surface_of(mesh);
  const ExactGeodesics geodesics(surface);
  std::vector<ExactSource> sources;
  // No source is in the middle of a face or an edge: two paths of the same length would be a tie.
  for (Index face : {3, 50, 133, 390}) sources.push_back({FacePoint{face, {0.21, 0.33, 0.46}}, Vec3{0.2, -0.3, 0.4}});
  sources.push_back({EdgePoint{Row(mesh.faces[77][0]), Row(mesh.faces[77][1]), 0.37}, Vec3{0.2, -0.3, 0.4}});
  std::vector<LogMap> single;
  for (const ExactSource& s : sources) single.push_back(geodesics.log_map(s.point, s.u_axis));
  // Motions of the plane of coordinates change neither labels nor distances.
  for (std::size_t k = 0; k < sources.size(); ++k) {
    sources[k].position = {static_cast<double>(k), 0.5};
    sources[k].angle = 0.4 * static_cast<double>(k);
    sources[k].mirrored = k % 3 == 1;
  }
  const auto [map, labels] = geodesics.log_map(sources, {.radius = 9, .frames = true, .progress = {}});
  for (Index v = 0; v < map.size(); ++v) {
    std::vector<double> distances;
    for (const LogMap& one : single) distances.push_back(one.distance(Vertex(v)));
    std::ranges::sort(distances);
    EXPECT_NEAR(map.distance(Vertex(v)), distances[0], 1e-12);
    if (distances[1] - distances[0] < 1e-9) continue;  // either may be the nearest
    const ExactSource& s = sources[labels[v]];
    const auto [x, y] = vector_at(single[labels[v]], v);
    const double left = s.mirrored ? -y : y, c = std::cos(s.angle), t = std::sin(s.angle);
    EXPECT_NEAR(vector_at(map, v)[0], s.position[0] + c * x - t * left, 1e-9);
    EXPECT_NEAR(vector_at(map, v)[1], s.position[1] + t * x + c * left, 1e-9);
  }
  EXPECT_TRUE(map.source().is_curve());
}

TEST(ExactLogMap, OfSeveralRowsIsNoCurve) {
  const auto surface = surface_of(icosphere(9));
  const ExactGeodesics geodesics(surface);
  const std::vector<ExactSource> sources{{Row(3)}, {Row(70)}, {Row(200)}};
  const auto [map, labels] = geodesics.log_map(sources);
  EXPECT_FALSE(map.source().is_curve());
  // The cut locus does not contain the boundaries between sources.
  for (double quality : map_quality(surface.graph(), map)) EXPECT_GT(quality, reliable_quality);
  EXPECT_THROW(geodesics.log_map(std::span<const ExactSource>{}), InvalidArgument);
}

TEST(ExactLogMap, HasAStatusWhereItHasNoCoordinates) {
  const Mesh one = icosphere(6);
  const Index n = one.vertices();
  Mesh two = joined(one, one, {5, 0, 0});
  two.positions.push_back({9, 9, 9});  // of no face
  const auto surface = surface_of(two);
  const ExactGeodesics geodesics(surface);
  const RowLogMap whole = surface.to_rows(geodesics.log_map(Row(7)));
  const LogMap near = geodesics.log_map(Row(7), std::nullopt, {.radius = 1.0});
  const RowLogMap part = surface.to_rows(near);
  EXPECT_EQ(near.method(), Method::exact);
  for (Index r = 0; r < 2 * n; ++r) {
    const Status expected = r < n ? Status::ok : Status::disconnected;
    EXPECT_EQ(whole.status[r], expected);
    EXPECT_EQ(part.status[r], whole.distance[r] > 1 ? Status::beyond_radius : expected);
    if (part.status[r] == Status::ok)
      EXPECT_TRUE(part.u[r] == whole.u[r] && part.v[r] == whole.v[r]);
    else
      EXPECT_TRUE(std::isnan(part.distance[r]) && std::isnan(part.u[r]));
  }
  EXPECT_EQ(whole.status[2 * n], Status::removed);
  EXPECT_THROW(geodesics.log_map(Row(2 * n)), InvalidArgument);
}

TEST(ExactLogMap, ScalesWithTheSurface) {
  const double scale = std::ldexp(1.0, -700);
  Mesh mesh = icosphere(5);
  const auto large = surface_of(mesh);
  for (Vec3& p : mesh.positions) p = scale * p;
  const auto small = surface_of(mesh);
  for (const SurfacePoint& source : {SurfacePoint{Row(3)}, SurfacePoint{FacePoint{8, {0.2, 0.3, 0.5}}}}) {
    const LogMap a = exact_log_map(large, source), b = exact_log_map(small, source, {}, {.radius = 9 * scale});
    for (Index v = 0; v < a.size(); ++v) {
      EXPECT_NEAR(b.distance(Vertex(v)) / scale, a.distance(Vertex(v)), 1e-13);
      EXPECT_NEAR(vector_at(b, v)[0] / scale, vector_at(a, v)[0], 1e-12);
    }
  }
}

TEST(ExactLogMap, NeedsFlatTriangles) {
  const auto cloud = pointcloud::PointCloudSurface::build(icosphere(8).positions);
  EXPECT_EQ(fault_of([&] { ExactGeodesics{cloud}; }), "no_flat_triangles");
  const auto polygons = surface_of(cube_sphere(6), polymesh::Discretization::polygons);
  EXPECT_EQ(fault_of([&] { ExactGeodesics{polygons}; }), "polygons_not_refined");
}

TEST(ExactLogMap, ReportsProgressAndStops) {
  const auto surface = surface_of(icosphere(8));
  std::vector<double> fractions;
  std::stop_source stop;
  ExactMapOptions options;
  options.progress = {[&](std::string_view, double fraction) { fractions.push_back(fraction); }, {}};
  exact_log_map(surface, Row(0), {}, options);
  ASSERT_GT(fractions.size(), 10U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1);
  options.progress = {[&](std::string_view, double fraction) {
                        if (fraction > 0.5) stop.request_stop();
                      },
                      stop.get_token()};
  EXPECT_THROW(exact_log_map(surface, Row(0), {}, options), Cancelled);
  EXPECT_THROW(exact_log_map(surface, Row(0), {}, {.progress = {{}, stop.get_token()}}), Cancelled);
}

TEST(ExactGeodesics, PathsAndTracesAreStraightOnPlanes) {
  const Mesh mesh = with_reversed_faces(flat_square(15));
  const auto surface = surface_of(mesh);
  const ExactGeodesics geodesics(surface);
  std::mt19937_64 random(3);
  const auto random_face = [&] { return static_cast<Index>(random() % mesh.faces.size()); };
  for (int k = 0; k < 20; ++k) {
    const std::array<SurfacePoint, 2> ends{FacePoint{random_face(), {0.2, 0.3, 0.5}},
                                           FacePoint{random_face(), {0.6, 0.3, 0.1}}};
    const Vec3 a = surface.position(ends[0]), b = surface.position(ends[1]);
    const exact::GeodesicPath path = geodesics.path(ends);
    EXPECT_NEAR(path.length, distance(a, b), 1e-12);
    if (a == b) continue;
    const auto ray = geodesics.trace(ends[0], b - a, distance(a, b));
    EXPECT_EQ(ray.end, exact::TraceEnd::complete);
    EXPECT_LT(distance(geodesics.position(path.points.front()), a), 1e-12);
    EXPECT_LT(distance(geodesics.position(path.points.back()), b), 1e-12);
    EXPECT_LT(distance(geodesics.position(ray.points.back()), b), 1e-9);
  }
}

// ------------------------------------------------------------------------------------------------ quality

TEST(MapQuality, OfExactMapsIsLowOnlyAtTheCutLocus) {
  const auto plane = surface_of(flat_square(15));
  for (double q : map_quality(plane.graph(), exact_log_map(plane, Row(40)))) EXPECT_EQ(q, 1);

  const auto sphere = surface_of(icosphere(12));
  const ExactGeodesics geodesics(sphere);
  const LogMap near = geodesics.log_map(Row(100), std::nullopt, {.radius = 2});
  const std::vector<double> inside = map_quality(sphere.graph(), near);
  for (Index v = 0; v < near.size(); ++v) {
    EXPECT_EQ(std::isnan(inside[v]), near.status(Vertex(v)) != Status::ok);
    if (near.status(Vertex(v)) == Status::ok) EXPECT_GT(inside[v], 0.97);
  }
  // The antipode is the cut locus.
  const LogMap whole = geodesics.log_map(Row(100));
  const std::vector<double> quality = map_quality(sphere.graph(), whole);
  for (Index v = 0; v < whole.size(); ++v)
    if (whole.distance(Vertex(v)) < 2.5) EXPECT_GT(quality[v], reliable_quality);
  EXPECT_GT(std::ranges::count_if(quality, [](double q) { return q < reliable_quality; }), 2);
  EXPECT_LT(quality[std::ranges::max_element(whole.distances()) - whole.distances().begin()], reliable_quality);
}

// Shortest paths bend around a hole. Heat maps have wrong directions behind it, also on a flat sheet.
TEST(MapQuality, IsLowBehindHoles) {
  for (const double depth : {0.0, 0.5}) {
    const Index side = 41;
    Mesh mesh = triangles(quads(side, side, Columns::open, [&](Index i, Index j) {
      const double x = j / 20.0 - 1, y = i / 20.0 - 1;
      return Vec3{x, y, depth * (x * x + y * y)};
    }));
    std::erase_if(mesh.faces,
                  [&](const Triangle& t) { return std::hypot(t[0] % side - 19.5, t[0] / side - 12.5) < 5; });
    const auto surface = surface_of(mesh);
    const SurfacePoint source = Row(2 * side + side / 2);
    const LogMap heat = LogMapSolver(surface.graph()).solve(surface.source(source).source);
    const LogMap exact = ExactGeodesics(surface).log_map(source);
    const std::vector<double> quality = map_quality(surface.graph(), heat);
    double trusted = 0, right = 0, turned = 0;  // turned: the length is right, the direction is wrong
    for (Index v = 0; v < heat.size(); ++v) {
      const double d = exact.distance(Vertex(v));
      const bool is_right = norm(vector_at(heat, v) - vector_at(exact, v)) <= 0.1 * d;
      turned += !is_right && std::abs(norm(vector_at(heat, v)) - d) < 0.1 * d;
      trusted += quality[v] >= reliable_quality;
      right += is_right && quality[v] >= reliable_quality;
    }
    EXPECT_GT(turned, 0.15 * heat.size());
    EXPECT_GT(right / trusted, 0.97);
    EXPECT_GT(trusted, 0.4 * heat.size());
  }
}

// Where edges are much shorter than the mean edge, the quality compares short vectors with the edges there.
TEST(MapQuality, IsLowAtRoughPlacesOfFineEdges) {
  constexpr Index side = 24;
  const auto along = [](Index k) { return std::pow(k / (side - 1.0), 4); };
  const auto surface = surface_of(triangles(quads(side, side, Columns::open, [&](Index j, Index i) {
    const Index least = std::max<Index>(std::min(i, j), 1);
    const double edge = along(least) - along(least - 1);
    return Vec3{along(i), along(j), 0.7 * edge * std::sin(12.9898 * i + 78.233 * j)};
  })));
  const Row source(3 * side + 3);
  const LogMap exact = ExactGeodesics(surface).log_map(source);
  const double edge = surface.graph().mean_edge_length() * surface.graph().length_unit();
  for (Variant variant : all_variants) {
    const LogMap heat = LogMapSolver(surface.graph(), {.variant = variant}).solve(surface.source(source).source);
    const std::vector<double> quality = map_quality(surface.graph(), heat);
    Index near = 0, wrong = 0;
    for (Index v = 0; v < heat.size(); ++v) {
      const double d = exact.distance(Vertex(v));
      if (!(d > 0 && d < edge)) continue;
      ++near;
      wrong += quality[v] >= reliable_quality && norm(vector_at(heat, v) - vector_at(exact, v)) > 0.1 * d;
    }
    EXPECT_GT(near, 50);
    EXPECT_LT(wrong, 0.05 * near) << to_string(variant);
  }
}

}  // namespace
}  // namespace ahm::test
