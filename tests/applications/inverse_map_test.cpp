// The inverse of a map, from coordinates to points of the surface, and decals.
#include "ahm/applications/inverse_map.hpp"

#include "ahm/applications/decal.hpp"
#include "ahm/conformance/clouds.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "mapped_surfaces.hpp"

namespace ahm::test {
namespace {

TEST(InverseMap, IsTheIdentityOnThePlaneAndEndsAtItsBoundary) {
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
  EXPECT_FALSE(inverse.at(NAN, 0));
  for (const Triangle& t : plane.triangles)
    for (int c = 0; c < 3; ++c)
      for (double s : {0.0, 0.3, 0.5}) {  // at vertices and on edges
        const Vec2 p =
            plane.plane(to_size(t[c])) + s * (plane.plane(to_size(t[(c + 1) % 3])) - plane.plane(to_size(t[c])));
        EXPECT_TRUE(inverse.at(p[0], p[1]));
      }
}

TEST(InverseMap, OnASphereIsOfSecondOrderAndMapsBackToItsQuery) {
  std::vector<double> errors;
  for (int side : {21, 41, 81}) {
    const Patch cap = patch(side, 1.2, on_sphere);
    const InverseMap inverse(cap.surface());
    const double h = cap.longest_edge;
    errors.push_back(0);
    for (const auto& [u, v] : points_in_disc(1.2, 3000)) {
      const auto point = inverse.at(u, v);
      ASSERT_TRUE(point);
      // A point of a triangle is at most h / sqrt(3) from a corner. The sphere rises above a chord by half of the square.
      EXPECT_LE(1 - norm(point->position), h * h / 6 * 1.01);
      EXPECT_LE(dot(point->position, point->position), 1 + 1e-14);
      errors.back() = std::max(errors.back(), distance(point->position, on_sphere(u, v)[0]));
      const double e = 1e-6;  // central difference of the exact map
      const Vec3 du = 1 / (2 * e) * (on_sphere(u + e, v)[0] - on_sphere(u - e, v)[0]);
      EXPECT_LT(distance(point->du, du), 2 * h);
      const Frame frame = point->frame();
      EXPECT_LT(std::abs(dot(frame.x, frame.normal)) + std::abs(dot(frame.y, frame.normal)), 1e-12);
      EXPECT_NEAR(dot(frame.x, frame.x), 1, 1e-12);
      EXPECT_GT(dot(frame.x, du), 0);
      Vec2 query{};
      for (std::size_t c = 0; c < 3; ++c) {
        query = query + point->weights[c] * cap.plane(to_size(point->vertices[c]));
        EXPECT_GE(point->weights[c], -1e-10);
      }
      EXPECT_LT(length(query - Vec2{u, v}), 1e-13);
      EXPECT_NEAR(point->weights[0] + point->weights[1] + point->weights[2], 1, 1e-13);
    }
  }
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.8);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.8);
}

TEST(InverseMap, OfAFoldIsOnTheSheetNearestToTheSource) {
  Patch strip = pleat();
  for (const bool reversed : {false, true}) {
    if (reversed) std::ranges::reverse(strip.triangles);
    const InverseMap inverse(strip.surface());
    EXPECT_EQ(inverse.triangles().size(), 80U);  // without the flipped ones
    for (double u = 0.013; u < 1.5; u += 0.02) {
      const auto point = inverse.at(u, 0.02);
      ASSERT_TRUE(point);
      EXPECT_NEAR(point->position[0], u <= 1 ? u : u + 1, 1e-12);
    }
  }
  // For a source at the other end of the strip the other sheet is nearer.
  MappedSurface surface = strip.surface();
  const std::array<Index, 1> end{50};
  surface.sources = end;
  EXPECT_NEAR(InverseMap(surface).at(0.75, 0.02)->position[0], 1.75, 1e-12);
}

TEST(InverseMap, UsesValidTrianglesOnly) {
  Patch plane = patch(31, 1, flat);
  for (std::size_t i = 0; i < plane.valid.size(); ++i) plane.valid[i] = plane.coordinates[2 * i] < 0.3;
  const Vec2 hole = plane.plane(480);  // near the center
  plane.coordinates[2 * 480] = NAN;
  const InverseMap inverse(plane.surface());
  EXPECT_FALSE(inverse.at(hole[0], hole[1]));
  for (const auto& [u, v] : points_in_disc(1, 1000)) {
    const auto point = inverse.at(u, v);
    if (u >= 0.3) EXPECT_FALSE(point);
    if (u < 0.3 - plane.longest_edge && length(Vec2{u, v} - hole) > plane.longest_edge) EXPECT_TRUE(point);
    if (point)
      for (Index corner : point->vertices) EXPECT_TRUE(plane.valid[corner]);
  }
}

TEST(InverseMap, OmitsTrianglesThatAreStretchedTooMuch) {
  // Positions are stretched three times in u for u > 0.
  const Patch plane = patch(21, 1, [](double u, double v) { return flat(u > 0 ? 3 * u : u, v); });
  EXPECT_TRUE(InverseMap(plane.surface()).at(0.5, 0.1));
  const InverseMap strict(plane.surface(), {.max_stretch = 1.5});
  EXPECT_FALSE(strict.at(0.5, 0.1));
  EXPECT_TRUE(strict.at(-0.5, 0.1));
}

TEST(InverseMap, ScalesWithPowersOfTwo) {
  const Patch cap = patch(15, 1, on_sphere);
  const InverseMap inverse(cap.surface());
  for (int exponent : {-900, -40, 40, 900}) {
    const Patch scaled = cap.scaled(exponent);
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

/// A flat graph with frames in space: the plane z = 0, seen from below where a frame is mirrored.
CsrGraphData with_frames(const FlatGraph& flat) {
  CsrGraphData data = flat.data;
  for (std::size_t i = 0; i < to_size(flat.size()); ++i) {
    const double* F = flat.frames.data() + 4 * i;
    data.frames.push_back({{flat.positions[2 * i], flat.positions[2 * i + 1], 0},
                           {F[0], F[1], 0},
                           {F[2], F[3], 0},
                           {0, 0, F[0] * F[3] - F[1] * F[2]}});
  }
  return data;
}

TEST(InverseMap, OfFlatGraphsIsThePlaneOnTheSideOfTheSource) {
  for (const FlatGraph& flat_graph : {planar_triangulation(20), planar_triangulation(20, TransportKind::block, true)})
    for (const Index source : {210, 211}) {
      const CsrGraph graph(with_frames(flat_graph));
      const Frame from = *graph.frame(source);
      const InverseMap inverse = inverse_map(
          graph, LogMapSolver(graph).solve(Source::at_vertex(Vertex(source)), {.frames = true}), {.min_quality = 0});
      EXPECT_EQ(inverse.triangles().size(), 2u * 19 * 19);  // none bridges a dent of the boundary
      int found = 0;
      for (const auto& [u, v] : points_in_disc(0.4, 500)) {
        const auto point = inverse.at(u, v);
        const Vec3 exact = from.origin + u * from.x + v * from.y;
        if (std::min({exact[0], exact[1], 1 - exact[0], 1 - exact[1]}) > 0.05) ASSERT_TRUE(point) << u << ' ' << v;
        if (!point) continue;
        ++found;
        EXPECT_LT(distance(point->position, exact), 1e-10);
        EXPECT_LT(distance(point->normal, from.normal), 1e-12);
        EXPECT_LT(distance(point->frame().x, from.x), 1e-8);
      }
      EXPECT_GT(found, 100);
    }
}

TEST(StarTriangles, CoverTheCellsOfAGridWithoutItsHoles) {
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

LogMap map_from(const Surface& surface, Row source) {
  return LogMapSolver(surface.graph()).solve(surface.source(source).source, {.frames = true});
}

TEST(InverseMap, OfACloudLiesOnGeodesicPathsOfTheSphere) {
  const auto points = even_sphere(4000).points;
  const auto cloud = pointcloud::PointCloudSurface::build(points);
  const Row source(4000 / 3);
  const Vec3 p = points[source.index];
  const Frame from = *cloud.graph().frame(cloud.vertex(source).index);
  const InverseMap inverse = inverse_map(cloud.graph(), map_from(cloud, source));
  const double h = edge_length(cloud.graph());
  for (const auto& [u, v] : points_in_disc(1.5, 1000)) {
    const auto point = inverse.at(u, v);
    ASSERT_TRUE(point) << u << ' ' << v;
    EXPECT_NEAR(norm(point->position), 1, h * h);
    EXPECT_GT(dot(point->normal, point->position) * dot(from.normal, p), 0.9);
    const double r = std::hypot(u, v);
    const Vec3 exact = std::cos(r) * p + std::sin(r) / r * (u * from.x + v * from.y);
    EXPECT_LT(distance(point->position, exact), h) << u << ' ' << v;
  }
}

TEST(InverseMap, OfAMeshHasNoHolesAndLiesOnItsFaces) {
  Patch cap = patch(41, 1.1, on_sphere);
  for (const bool some_faces_reversed : {false, true}) {
    for (std::size_t t = 0; some_faces_reversed && t < cap.triangles.size(); t += 4)
      std::swap(cap.triangles[t][1], cap.triangles[t][2]);
    const auto mesh = trimesh::TriangleMeshSurface::build(cap.positions, cap.triangles);
    const Source source = mesh.source(Row(20 * 41 + 20), Vec3{1, 0, 0}).source;
    const LogMap map = LogMapSolver(mesh.graph()).solve(source, {.frames = true});
    const InverseMap by_vertices = inverse_map(mesh.graph(), map), by_faces = inverse_map(mesh, map);
    for (const auto& [u, v] : points_in_disc(1, 1000)) {
      const auto a = by_vertices.at(u, v), b = by_faces.at(u, v);
      ASSERT_TRUE(a && b) << u << ' ' << v;
      EXPECT_LT(distance(a->position, on_sphere(u, v)[0]), cap.longest_edge) << u << ' ' << v;
      EXPECT_LT(mesh.closest_point(b->position).distance, 1e-12);
      EXPECT_LT(length(by_faces.corners(b->vertices)[0] - Vec2{u, v}), 2 * cap.longest_edge);
    }
  }
}

TEST(InverseMap, OfASurfaceIsThatOfItsGraphByRows) {
  std::vector<Vec3> points = even_sphere(1500).points;
  points.push_back(points[3]);  // two rows of one vertex
  const auto cloud = pointcloud::PointCloudSurface::build(points);
  const LogMap map = map_from(cloud, Row(700));
  const InverseMap by_rows = inverse_map(cloud, map), by_vertices = inverse_map(cloud.graph(), map);
  EXPECT_EQ(by_rows.positions().size(), points.size());
  int found = 0;
  for (const auto& [u, v] : points_in_disc(2, 500)) {
    const auto a = by_rows.at(u, v), b = by_vertices.at(u, v);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    ++found;
    EXPECT_EQ(a->position, b->position);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(cloud.vertex(Row(a->vertices[k])), Vertex(b->vertices[k]));
  }
  EXPECT_GT(found, 450);
}

// By definition the source is at (0, 0), also where the quality of all triangles around it is too low.
TEST(InverseMap, HasTheSourceAtTheOrigin) {
  const Cloud sphere = random_sphere(400);
  const auto surface = pointcloud::PointCloudSurface::build(sphere.points);
  for (const double value : {0.0, 1.0}) {
    const std::vector<double> quality(to_size(surface.graph().size()), value);
    const InverseMap inverse = inverse_map(surface, map_from(surface, Row(7)), {.quality = quality});
    EXPECT_EQ(inverse.triangles().empty(), value == 0);
    const auto point = inverse.at(0, 0);
    ASSERT_TRUE(point);
    EXPECT_LT(distance(point->position, sphere.points[7]), 1e-12);
    EXPECT_LT(distance(point->normal, sphere.points[7]), 0.1);
    EXPECT_LT(distance(point->frame().x, surface.graph().frame(surface.vertex(Row(7)).index)->x), 0.1);
    EXPECT_EQ(inverse.at(1e-3, 0).has_value(), value > 0);
  }
}

TEST(InverseMap, RefusesInvalidArguments) {
  const Patch plane = patch(5, 1, flat);
  Patch short_array = plane, outside = plane;
  short_array.normals.pop_back();
  outside.triangles[3][1] = 25;
  EXPECT_THROW(InverseMap(short_array.surface()), InvalidArgument);
  EXPECT_THROW(InverseMap(outside.surface()), InvalidArgument);
  EXPECT_THROW(InverseMap(plane.surface(), {.max_stretch = 1}), InvalidArgument);
  const CsrGraph graph(planar_triangulation(5).data);  // without frames in space
  const LogMapSolver solver(graph);
  EXPECT_THROW(inverse_map(graph, solver.solve(Source::at_vertex(Vertex{0}), {.frames = true})), InvalidArgument);
  EXPECT_THROW(star_triangles(graph, solver.solve(Source::at_vertex(Vertex{0}))), InvalidArgument);
  EXPECT_FALSE(InverseMap(MappedSurface{}).at(0, 0));
}

constexpr Vec2 image_corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

/// The point of the decal at a place of the image, which must be unique.
Vec3 point_at(const Decal& decal, const Vec2& place) {
  Vec3 found{1e9, 1e9, 1e9};
  for (std::size_t i = 0; i < decal.points.size(); ++i)
    if (length(Vec2{decal.image_coordinates[2 * i], decal.image_coordinates[2 * i + 1]} - place) < 1e-12)
      found = decal.points[i];
  return found;
}

double area_of(const Decal& decal) {
  double area = 0;
  for (std::size_t f = 0; f + 1 < decal.face_begin.size(); ++f)
    for (Offset c = decal.face_begin[f] + 1; c + 1 < decal.face_begin[f + 1]; ++c) {
      const auto corner = [&](Offset k) { return decal.points[decal.face_vertices[k]]; };
      const Vec3 o = corner(decal.face_begin[f]);
      area += norm(cross(corner(c) - o, corner(c + 1) - o)) / 2;
    }
  return area;
}

TEST(Decal, IsAnUndistortedImageOnAPlane) {
  // A tilted plane through (1, 2, 3).
  const auto tilted = [](double u, double v) {
    return std::array{Vec3{1 + 0.6 * u, 2 + v, 3 + 0.8 * u}, Vec3{-0.8, 0, 0.6}};
  };
  const Patch plane = patch(23, 1, tilted);
  const InverseMap inverse(plane.surface());
  for (double angle : {0.0, 0.4, -2.0}) {
    const Decal decal = make_decal(inverse, {.width = 0.8, .height = 0.5, .angle = angle});
    const double c = std::cos(angle), s = std::sin(angle);
    const auto exact = [&](double x, double y) {
      const double across = 0.8 * (x - 0.5), up = 0.5 * (y - 0.5);
      return tilted(c * across - s * up, s * across + c * up)[0];
    };
    for (const Vec2& place : image_corners)
      EXPECT_LT(distance(point_at(decal, place), exact(place[0], place[1])), 1e-9);
    for (std::size_t i = 0; i < decal.points.size(); ++i) {
      EXPECT_LT(distance(decal.points[i], exact(decal.image_coordinates[2 * i], decal.image_coordinates[2 * i + 1])),
                1e-9);
      EXPECT_LT(distance(decal.normals[i], {-0.8, 0, 0.6}), 1e-12);
    }
    EXPECT_NEAR(area_of(decal), 0.4, 1e-9);  // neither gaps nor overlaps
    EXPECT_EQ(decal.hidden, 0);
  }
}

TEST(Decal, MayBeMirroredCutAtARadiusAndLifted) {
  const InverseMap inverse(patch(31, 1, flat).surface());
  const Decal plain = make_decal(inverse, {.width = 1, .height = 0.5}),
              mirrored = make_decal(inverse, {.width = 1, .height = 0.5, .mirrored = true});
  EXPECT_LT(distance(point_at(plain, {0, 1}), point_at(mirrored, {1, 1})), 1e-12);
  const double r = 0.4;
  const Decal cut = make_decal(inverse, {.width = 1, .height = 1, .radius = r, .lift = 0.25});
  double farthest = 0;
  for (const Vec3& p : cut.points) {
    farthest = std::max(farthest, std::hypot(p[0], p[1]));
    EXPECT_NEAR(p[2], 0.25, 1e-12);
  }
  EXPECT_NEAR(farthest, r, 1e-9);
  EXPECT_NEAR(area_of(cut), 32 * r * r * std::sin(2 * pi / 64), 1e-9);  // a polygon of 64 corners
}

TEST(Decal, IsOnOneSheetOfAFold) {
  const Patch strip = pleat();
  const InverseMap inverse(strip.surface());
  const Decal decal = make_decal(inverse, {.width = 4, .height = 1});
  EXPECT_EQ(decal.hidden, 40);  // of the third sheet
  EXPECT_NEAR(area_of(decal), 0.05 * 1, 1e-9);
  for (const Vec3& p : decal.points) EXPECT_LE(p[0], 1 + 1e-9);
  const auto places = image_coordinates_of_vertices(inverse, {.width = 4, .height = 1});
  for (std::size_t i = 0; i < strip.positions.size(); ++i)
    EXPECT_EQ(std::isfinite(places[2 * i]), strip.positions[i][0] <= 1 + 1e-9) << strip.positions[i][0];
}

TEST(Decal, AtVerticesAgreesWithTheMesh) {
  const Patch cap = patch(25, 1.2, on_sphere);
  const InverseMap inverse(cap.surface());
  const DecalOptions options{.width = 1, .height = 0.7, .angle = 1, .radius = 0.45};
  const auto places = image_coordinates_of_vertices(inverse, options);
  const Decal decal = make_decal(inverse, options);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < cap.positions.size(); ++i) {
    if (std::isnan(places[2 * i])) continue;
    ++inside;
    EXPECT_LT(distance(point_at(decal, {places[2 * i], places[2 * i + 1]}), cap.positions[i]), 1e-12);
  }
  EXPECT_GT(inside, 20U);
}

TEST(Decal, RefusesInvalidArguments) {
  const InverseMap inverse(patch(5, 1, flat).surface());
  for (double bad : {0.0, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    EXPECT_THROW(make_decal(inverse, {.width = bad, .height = 1}), InvalidArgument);
    EXPECT_THROW(image_coordinates_of_vertices(inverse, {.width = 1, .height = bad}), InvalidArgument);
  }
  EXPECT_THROW(make_decal(inverse, {.width = 1, .height = 1, .angle = NAN}), InvalidArgument);
  EXPECT_THROW(make_decal(inverse, {.width = 1, .height = 1, .radius = 0}), InvalidArgument);
  EXPECT_THROW(make_decal(inverse, {.width = 1, .height = 1, .lift = NAN}), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
