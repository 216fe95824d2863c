// From coordinates back to the surface.
#include "ahm/applications/inverse_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/error.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "mapped_surfaces.hpp"

namespace ahm::test {
namespace {

TEST(InverseMap, IsTheIdentityOnThePlaneAndNothingBeyond) {
  const Patch plane = patch(20, 1, flat);
  const InverseMap inverse(plane.surface());
  EXPECT_EQ(inverse.triangles().size(), plane.triangles.size());
  for (const auto& [u, v] : points_in_disc(1.4, 2000)) {
    const auto point = inverse.at(u, v);
    ASSERT_EQ(point.has_value(), std::max(std::abs(u), std::abs(v)) <= 1) << u << ' ' << v;
    if (!point) continue;
    EXPECT_LT(distance(point->position, {u, v, 0}), 1e-14);
    EXPECT_LT(distance(point->normal, {0, 0, 1}), 1e-14);
    EXPECT_LT(distance(point->frame().x, {1, 0, 0}) + distance(point->frame().y, {0, 1, 0}), 1e-12);
    EXPECT_LT(distance(point->du, {1, 0, 0}) + distance(point->dv, {0, 1, 0}), 1e-12);
  }
  EXPECT_FALSE(inverse.at(std::nan(""), 0));
}

TEST(InverseMap, AnswersAtVerticesAndOnEdges) {
  const Patch plane = patch(15, 1, flat);
  const InverseMap inverse(plane.surface());
  for (const Triangle& t : plane.triangles)
    for (int c = 0; c < 3; ++c) {
      const Vec3 &a = plane.positions[t[c]], &b = plane.positions[t[(c + 1) % 3]];
      for (double s : {0.0, 0.3, 0.5}) EXPECT_TRUE(inverse.at(a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])));
    }
}

TEST(InverseMap, MapsBackToItsQuery) {
  const Patch cap = patch(25, 1.2, on_sphere);
  const InverseMap inverse(cap.surface());
  for (const auto& [u, v] : points_in_disc(1.2, 2000)) {
    const auto point = inverse.at(u, v);
    ASSERT_TRUE(point);
    double back[] = {0, 0}, sum = 0;
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(point->vertices[c]);
      for (int a : {0, 1}) back[a] += point->weights[c] * cap.coordinates[2 * i + a];
      sum += point->weights[c];
      EXPECT_GE(point->weights[c], -1e-10);
    }
    EXPECT_LT(std::hypot(back[0] - u, back[1] - v), 1e-13);
    EXPECT_NEAR(sum, 1, 1e-13);
  }
}

TEST(InverseMap, LiesOnASphereToSecondOrder) {
  std::vector<double> errors;
  for (int side : {21, 41, 81}) {
    const Patch cap = patch(side, 1.2, on_sphere);
    const InverseMap inverse(cap.surface());
    const double h = cap.longest_edge;
    errors.push_back(0);
    for (const auto& [u, v] : points_in_disc(1.2, 3000)) {
      const auto point = inverse.at(u, v);
      ASSERT_TRUE(point);
      // A point of a triangle is at most h / sqrt(3) from a corner; the sphere rises above a chord by half the square.
      EXPECT_LE(1 - std::sqrt(dot(point->position, point->position)), h * h / 6 * 1.01);
      EXPECT_LE(dot(point->position, point->position), 1 + 1e-14);
      errors.back() = std::max(errors.back(), distance(point->position, on_sphere(u, v)[0]));
      // du by central differences of the exact map.
      const double e = 1e-6;
      const Vec3 ahead = on_sphere(u + e, v)[0], behind = on_sphere(u - e, v)[0];
      Vec3 du;
      for (int c = 0; c < 3; ++c) du[c] = (ahead[c] - behind[c]) / (2 * e);
      EXPECT_LT(distance(point->du, du), 2 * h);
      const Frame frame = point->frame();
      EXPECT_LT(std::abs(dot(frame.x, frame.normal)) + std::abs(dot(frame.y, frame.normal)), 1e-12);
      EXPECT_NEAR(dot(frame.x, frame.x), 1, 1e-12);
      EXPECT_GT(dot(frame.x, du), 0);
    }
  }
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.8);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.8);
}

TEST(InverseMap, InAFoldTheSheetNearestToTheSourceAnswers) {
  Patch strip = pleat();
  for (const bool reversed : {false, true}) {
    if (reversed) std::reverse(strip.triangles.begin(), strip.triangles.end());
    const InverseMap inverse(strip.surface());
    EXPECT_EQ(inverse.triangles().size(), 80U);  // not those turned over
    for (double u = 0.013; u < 1.5; u += 0.02) {
      const auto point = inverse.at(u, 0.02);
      ASSERT_TRUE(point);
      EXPECT_NEAR(point->position[0], u <= 1 ? u : u + 1, 1e-12);
    }
  }
  // Seen from the other end of the strip the other sheet is the nearer one.
  MappedSurface surface = strip.surface();
  const std::array<Index, 1> end{50};
  surface.sources = end;
  EXPECT_NEAR(InverseMap(surface).at(0.75, 0.02)->position[0], 1.75, 1e-12);
}

TEST(InverseMap, AnswersFromValidTrianglesOnly) {
  Patch plane = patch(31, 1, flat);
  for (std::size_t i = 0; i < plane.valid.size(); ++i) plane.valid[i] = plane.coordinates[2 * i] < 0.3;
  const double hole[] = {plane.coordinates[2 * 480], plane.coordinates[2 * 480 + 1]};  // near the middle
  plane.coordinates[2 * 480] = std::nan("");
  const InverseMap inverse(plane.surface());
  EXPECT_FALSE(inverse.at(hole[0], hole[1]));
  for (const auto& [u, v] : points_in_disc(1, 1000)) {
    const auto point = inverse.at(u, v);
    if (u >= 0.3) EXPECT_FALSE(point);
    if (u < 0.3 - plane.longest_edge && std::hypot(u - hole[0], v - hole[1]) > plane.longest_edge) EXPECT_TRUE(point);
    if (point)
      for (Index corner : point->vertices) EXPECT_TRUE(plane.valid[corner]);
  }
}

TEST(InverseMap, LeavesOutWhatIsStretchedBeyondBounds) {
  // Space is three times as long in u for u > 0.
  const Patch plane = patch(21, 1, [](double u, double v) { return flat(u > 0 ? 3 * u : u, v); });
  EXPECT_TRUE(InverseMap(plane.surface()).at(0.5, 0.1));
  const InverseMap strict(plane.surface(), {.max_stretch = 1.5});
  EXPECT_FALSE(strict.at(0.5, 0.1));
  EXPECT_TRUE(strict.at(-0.5, 0.1));
}

TEST(InverseMap, ScalesWithThePowersOfTwo) {
  const Patch cap = patch(15, 1, on_sphere);
  const InverseMap inverse(cap.surface());
  for (int exponent : {-900, -40, 40, 900}) {
    Patch scaled = cap;
    for (double& x : scaled.coordinates) x = std::ldexp(x, exponent);
    for (Vec3& p : scaled.positions)
      for (double& x : p) x = std::ldexp(x, exponent);
    const InverseMap other(scaled.surface());
    for (const auto& [u, v] : points_in_disc(1, 200)) {
      const auto a = inverse.at(u, v), b = other.at(std::ldexp(u, exponent), std::ldexp(v, exponent));
      ASSERT_TRUE(a && b);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(std::ldexp(a->position[c], exponent), b->position[c]);
      EXPECT_EQ(a->du, b->du);
      EXPECT_EQ(a->normal, b->normal);
    }
  }
}

/// Frames in space for a flat graph: the plane z = 0, seen from below where a frame is mirrored.
CsrGraphData with_frames(const FlatGraph& flat) {
  CsrGraphData data = flat.data;
  for (std::size_t i = 0; i < static_cast<std::size_t>(flat.size()); ++i) {
    const double* F = flat.frames.data() + 4 * i;
    data.frames.push_back({{flat.positions[2 * i], flat.positions[2 * i + 1], 0},
                           {F[0], F[1], 0},
                           {F[2], F[3], 0},
                           {0, 0, F[0] * F[3] - F[1] * F[2]}});
  }
  return data;
}

TEST(InverseMap, OfAnyFlatGraphIsThePlaneOnTheSourcesSide) {
  for (const bool reflections : {false, true})
    for (const Index source : {Index{210}, Index{211}}) {
      const FlatGraph flat_graph =
          planar_triangulation(20, reflections ? TransportKind::block : TransportKind::rotation2, reflections);
      const CsrGraph graph(with_frames(flat_graph));
      const Frame from = *graph.frame(source);
      const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex(source)), {.frames = true});
      const InverseMap inverse = inverse_map(graph, map);
      int answered = 0;
      for (const auto& [u, v] : points_in_disc(0.4, 500)) {
        const auto point = inverse.at(u, v);
        Vec3 exact;
        for (int c = 0; c < 3; ++c) exact[c] = from.origin[c] + u * from.x[c] + v * from.y[c];
        const bool inside = std::min({exact[0], exact[1], 1 - exact[0], 1 - exact[1]}) > 0.05;
        if (inside) ASSERT_TRUE(point) << u << ' ' << v;
        if (!point) continue;
        ++answered;
        EXPECT_LT(distance(point->position, exact), 1e-10);
        EXPECT_LT(distance(point->normal, from.normal), 1e-12);
        EXPECT_LT(distance(point->frame().x, from.x), 1e-8);
      }
      EXPECT_GT(answered, 100);
    }
}

TEST(StarTriangles, OfATriangulationAreItsTriangles) {
  // A triangulated square: the area of its triangles is its own, and no triangle bridges a dent of the border.
  const FlatGraph flat_graph = planar_triangulation(25);
  const CsrGraph graph(flat_graph.data);
  const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex{0}), {.frames = true});
  const auto triangles = star_triangles(graph, map);
  EXPECT_EQ(triangles.size(), 2U * 24 * 24);
  for (const Triangle& t : triangles) {
    const auto position = [&](int c, int axis) {
      return flat_graph.positions[2 * static_cast<std::size_t>(t[c]) + axis];
    };
    EXPECT_GT((position(1, 0) - position(0, 0)) * (position(2, 1) - position(0, 1)) -
                  (position(1, 1) - position(0, 1)) * (position(2, 0) - position(0, 0)),
              0);
  }
}

TEST(StarTriangles, CoverTheCellsOfAGridAndSpareItsHoles) {
  grid::Grid shape{.shape = {21, 21}, .spacing = {0.1, 0.1}, .origin = {-1, -1}};
  shape.blocked.assign(400, 0);
  for (int y = 4; y < 8; ++y)
    for (int x = 4; x < 8; ++x) shape.blocked[20 * y + x] = 1;
  const grid::GridGraph graph(shape);
  const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex{220}), {.frames = true});
  const InverseMap inverse = inverse_map(graph, map, {.min_quality = 0});
  for (const auto& [u, v] : points_in_disc(0.99, 1000)) {
    const bool hole = u > -0.6 && u < -0.2 && v > -0.6 && v < -0.2;
    const auto point = inverse.at(u, v);
    ASSERT_EQ(point.has_value(), !hole) << u << ' ' << v;
    if (point) EXPECT_LT(distance(point->position, {u, v, 0}), 1e-12);
  }
}

TEST(InverseMap, OnASphereOfPointsGoesTheGeodesicWay) {
  const int n = 4000;
  const auto points = even_sphere(n).points;
  const auto cloud = pointcloud::PointCloudSurface::build(points);
  const Index source = n / 3;
  const auto& graph = cloud.graph();
  const Frame from = *graph.frame(cloud.vertex(Row(source)).index);
  const LogMap map = LogMapSolver(graph).solve(cloud.source(Row(source)).source, {.frames = true});
  const InverseMap inverse = inverse_map(graph, map);
  const double h = graph.mean_edge_length() * graph.length_unit();
  const double outwards = dot(from.normal, points[source]);
  for (const auto& [u, v] : points_in_disc(1.5, 1000)) {
    const auto point = inverse.at(u, v);
    ASSERT_TRUE(point) << u << ' ' << v;
    EXPECT_NEAR(std::sqrt(dot(point->position, point->position)), 1, h * h);
    EXPECT_GT(dot(point->normal, point->position) * outwards, 0.9);
    Vec3 exact;  // cos r p + sin r (the direction)
    const double r = std::hypot(u, v);
    for (int c = 0; c < 3; ++c)
      exact[c] = std::cos(r) * points[source][c] + std::sin(r) / r * (u * from.x[c] + v * from.y[c]);
    EXPECT_LT(distance(point->position, exact), h) << u << ' ' << v;
  }
}

TEST(InverseMap, OnAMeshHasNoHoles) {
  const Patch cap = patch(41, 1.1, on_sphere);
  const auto mesh = trimesh::TriangleMeshSurface::build(cap.positions, cap.triangles);
  const Index source = 20 * 41 + 20;
  const LogMap map = LogMapSolver(mesh.graph()).solve(mesh.source(Row(source), Vec3{1, 0, 0}).source, {.frames = true});
  const InverseMap inverse = inverse_map(mesh.graph(), map);
  for (const auto& [u, v] : points_in_disc(1, 1000)) {
    const auto point = inverse.at(u, v);
    ASSERT_TRUE(point) << u << ' ' << v;
    EXPECT_LT(distance(point->position, on_sphere(u, v)[0]), cap.longest_edge) << u << ' ' << v;
  }
}

TEST(InverseMap, OfASurfaceIsThatOfItsGraphByRows) {
  std::vector<Vec3> points = even_sphere(1500).points;
  points.push_back(points[3]);  // two rows of one vertex
  const auto cloud = pointcloud::PointCloudSurface::build(points);
  const LogMap map = LogMapSolver(cloud.graph()).solve(cloud.source(Row(700)).source, {.frames = true});
  const InverseMap by_rows = inverse_map(cloud, map), by_vertices = inverse_map(cloud.graph(), map);
  EXPECT_EQ(by_rows.positions().size(), points.size());
  int answered = 0;
  for (const auto& [u, v] : points_in_disc(2, 500)) {
    const auto a = by_rows.at(u, v), b = by_vertices.at(u, v);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    ++answered;
    EXPECT_EQ(a->position, b->position);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(cloud.vertex(Row(a->vertices[k])), Vertex(b->vertices[k]));
  }
  EXPECT_GT(answered, 450);
}

TEST(InverseMap, OfAMeshAnswersOnItsFaces) {
  Patch cap = patch(31, 1.1, on_sphere);
  for (std::size_t t = 0; t < cap.triangles.size(); t += 4) std::swap(cap.triangles[t][1], cap.triangles[t][2]);
  const auto mesh = trimesh::TriangleMeshSurface::build(cap.positions, cap.triangles);
  const LogMap map = LogMapSolver(mesh.graph()).solve(mesh.source(Row(15 * 31 + 15)).source, {.frames = true});
  const InverseMap inverse = inverse_map(mesh, map);
  for (const auto& [u, v] : points_in_disc(1, 300)) {
    const auto point = inverse.at(u, v);
    ASSERT_TRUE(point) << u << ' ' << v;
    EXPECT_LT(mesh.closest_point(point->position).distance, 1e-12);
    const Vec2 corner = inverse.corners(point->vertices)[0];
    EXPECT_LT(std::hypot(corner[0] - u, corner[1] - v), 2 * cap.longest_edge);
  }
}

// The source lies at (0, 0) by definition, also where no triangle beside it is to be trusted.
TEST(InverseMap, HasTheSourceAtTheOrigin) {
  const Cloud sphere = random_sphere(400);
  const auto surface = pointcloud::PointCloudSurface::build(sphere.points);
  const LogMapSolver solver(surface.graph());
  for (const double trusted : {0.0, 1.0}) {
    const LogMap map = solver.solve(surface.source(Row(7)).source, {.frames = true});
    const std::vector<double> quality(static_cast<std::size_t>(surface.graph().size()), trusted);
    const InverseMap inverse = inverse_map(surface, map, {.quality = quality});
    EXPECT_EQ(inverse.triangles().empty(), trusted == 0);
    const auto point = inverse.at(0, 0);
    ASSERT_TRUE(point);
    EXPECT_LT(distance(point->position, sphere.points[7]), 1e-12);
    EXPECT_LT(distance(point->normal, sphere.points[7]), 0.1);
    const Vec3 axis = surface.graph().frame(surface.vertex(Row(7)).index)->x;
    EXPECT_LT(distance(point->frame().x, axis), 0.1);
    EXPECT_EQ(inverse.at(1e-3, 0).has_value(), trusted > 0);
  }
}

TEST(InverseMap, RefusesBadArguments) {
  const Patch plane = patch(5, 1, flat);
  Patch broken = plane;
  broken.normals.pop_back();
  EXPECT_THROW(InverseMap(broken.surface()), InvalidArgument);
  broken = plane, broken.triangles[3][1] = 25;
  EXPECT_THROW(InverseMap(broken.surface()), InvalidArgument);
  EXPECT_THROW(InverseMap(plane.surface(), {.max_stretch = 1}), InvalidArgument);
  const CsrGraph graph(planar_triangulation(5).data);  // knows no frames in space
  const LogMapSolver solver(graph);
  EXPECT_THROW(inverse_map(graph, solver.solve(Source::at_vertex(Vertex{0}), {.frames = true})), InvalidArgument);
  EXPECT_THROW(star_triangles(graph, solver.solve(Source::at_vertex(Vertex{0}))), InvalidArgument);
  EXPECT_FALSE(InverseMap(MappedSurface{}).at(0, 0));
}

}  // namespace
}  // namespace ahm::test
