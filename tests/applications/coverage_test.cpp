// Tool paths that cover a surface, by interpolated maps and on the faces of a mesh.
#include "ahm/applications/coverage.hpp"

#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "mapped_surfaces.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

InverseMap plane_inverse() { return InverseMap(patch(31, 1.5, flat).surface()); }

/// Whether point k of a path is the first one of its piece.
bool is_first(const CoveragePath& path, std::size_t k) {
  return k == 0 || path.points[k - 1].piece != path.points[k].piece;
}

TEST(Coverage, RasterOnThePlaneHasEqualSpacingAndAlternates) {
  const CoverageOptions options{.radius = 1, .spacing = 0.15, .step = 0.04};
  const CoveragePath path = coverage_path(plane_inverse(), options);
  EXPECT_EQ(path.pieces, 13);
  EXPECT_EQ(path.planned, static_cast<Offset>(path.points.size()));
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const CoveragePoint& p = path.points[i];
    EXPECT_NEAR(p.position[1], (p.line - 6) * 0.15, 1e-14);
    EXPECT_LE(std::hypot(p.position[0], p.position[1]), 1 + 1e-12);
    EXPECT_EQ(p.piece, p.line);
    EXPECT_LT(distance(p.heading, {p.line % 2 == 0 ? 1.0 : -1.0, 0, 0}), 1e-10);
    EXPECT_LT(distance(p.normal, {0, 0, 1}), 1e-14);
    EXPECT_NEAR(p.spacing, 0.15, 1e-12);
    EXPECT_LT(distance(p.position, {p.coordinates[0], p.coordinates[1], 0}), 1e-14);
    const double step = is_first(path, i) ? 0 : distance(p.position, path.points[i - 1].position);
    EXPECT_LE(step, options.step * (1 + 1e-9));
    EXPECT_NEAR(p.arclength - (is_first(path, i) ? 0 : path.points[i - 1].arclength), step, 1e-13);
  }
}

TEST(Coverage, TurnsWithItsAngle) {
  const InverseMap inverse = plane_inverse();
  const double c = std::cos(0.7), s = std::sin(0.7);
  const auto turn = [&](const Vec3& p) { return Vec3{c * p[0] - s * p[1], s * p[0] + c * p[1], 0}; };
  for (const auto pattern : {CoveragePattern::raster, CoveragePattern::spiral}) {
    const CoveragePath straight = coverage_path(inverse, {.radius = 1, .spacing = 0.2, .pattern = pattern});
    const CoveragePath turned = coverage_path(inverse, {.radius = 1, .spacing = 0.2, .pattern = pattern, .angle = 0.7});
    ASSERT_EQ(straight.points.size(), turned.points.size());
    for (std::size_t i = 0; i < straight.points.size(); ++i) {
      EXPECT_LT(distance(turned.points[i].position, turn(straight.points[i].position)), 1e-13);
      EXPECT_LT(distance(turned.points[i].heading, turn(straight.points[i].heading)), 1e-9);
    }
  }
}

TEST(Coverage, SpiralHasConstantPitchOnThePlaneAndOnTheSphere) {
  const Patch plane = patch(31, 1.5, flat), cap = patch(81, 1.3, on_sphere);
  for (const Patch* surface : {&plane, &cap}) {
    const CoverageOptions options{
        .radius = surface == &plane ? 1 : 1.2, .spacing = 0.11, .pattern = CoveragePattern::spiral, .step = 0.02};
    const CoveragePath path = coverage_path(InverseMap(surface->surface()), options);
    EXPECT_EQ(path.pieces, 1);
    double angle = 0, before = 0;
    for (std::size_t i = 1; i < path.points.size(); ++i) {
      const Vec3& p = path.points[i].position;
      const Vec2 q = path.points[i].coordinates;
      angle += i == 1 ? std::atan2(q[1], q[0]) : std::remainder(std::atan2(q[1], q[0]) - before, 2 * pi);
      before = std::atan2(q[1], q[0]);
      const double pitch = options.spacing * angle / (2 * pi);
      EXPECT_NEAR(length(q), pitch, 1e-12);
      EXPECT_LE(distance(p, path.points[i - 1].position), options.step * (surface == &plane ? 1 : 1.01));
      // The error of linear interpolation is h^2 / 8 times the second derivative of the map, which is at most 1 on the sphere.
      if (surface == &cap)
        EXPECT_NEAR(std::atan2(std::hypot(p[0], p[1]), p[2]), pitch,
                    cap.longest_edge * cap.longest_edge / 2 + options.spacing * 1e-2);
    }
    if (surface == &cap) continue;
    EXPECT_NEAR(length(path.points.back().position), 1, 1e-12);
    // Arclength of r = b angle: b/2 (angle sqrt(1 + angle^2) + asinh angle). Chords are shorter than arcs by at most step^2 / 24 times
    // the squared curvature, which is at most 2 / b.
    const double b = options.spacing / (2 * pi), last = 1 / b,
                 exact = b / 2 * (last * std::hypot(1, last) + std::asinh(last));
    EXPECT_LE(path.points.back().arclength, exact);
    EXPECT_GE(path.points.back().arclength, exact - options.step);
  }
}

TEST(Coverage, LeavesNoPointOfTheDiscFartherThanHalfTheSpacing) {
  const InverseMap inverse = plane_inverse();
  const double spacing = 0.13, step = 0.03;
  for (const auto pattern : {CoveragePattern::raster, CoveragePattern::spiral}) {
    const CoveragePath path =
        coverage_path(inverse, {.radius = 1, .spacing = spacing, .pattern = pattern, .step = step, .angle = 0.3});
    for (const auto& [u, v] : points_in_disc(1 - spacing, 1000)) {
      double nearest = INFINITY;
      for (const CoveragePoint& p : path.points) nearest = std::min(nearest, distance(p.position, {u, v, 0}));
      EXPECT_LE(nearest, std::hypot(spacing / 2, step / 2) + 1e-12);
    }
  }
}

TEST(Coverage, IsCutIntoPiecesWhereTheMapIsNotValid) {
  Patch plane = patch(61, 1.5, flat);
  const auto in_slot = [](double u) { return std::abs(u - 0.3) < 0.1; };
  for (std::size_t i = 0; i < plane.valid.size(); ++i) plane.valid[i] = !in_slot(plane.coordinates[2 * i]);
  const double step = 0.09;  // the slot is crossed in four of these
  const CoveragePath path = coverage_path(InverseMap(plane.surface()), {.radius = 1, .spacing = 0.1, .step = step});
  EXPECT_LT(std::ssize(path.points), path.planned);
  std::vector<Index> pieces_of_line(21, 0);
  Index piece = -1;
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const CoveragePoint& p = path.points[i];
    EXPECT_FALSE(in_slot(p.coordinates[0]));
    if (is_first(path, i))
      ++piece, ++pieces_of_line[p.line];
    else
      EXPECT_LE(distance(p.position, path.points[i - 1].position), step + 1e-12);
    EXPECT_EQ(p.piece, piece);
  }
  EXPECT_EQ(piece + 1, path.pieces);
  for (int line = 5; line <= 15; ++line) EXPECT_EQ(pieces_of_line[line], 2) << line;
}

TEST(Coverage, DoesNotCrossACliff) {
  // The triangles across u = 0 are stretched too much, and steps are longer than the gap that they leave.
  const Patch cliff = patch(61, 1, [](double u, double v) {
    return std::array{Vec3{u, v, u > 0 ? 3.0 : 0.0}, Vec3{0, 0, 1}};
  });
  const CoveragePath path = coverage_path(InverseMap(cliff.surface()), {.radius = 0.9, .spacing = 0.1, .step = 0.2});
  EXPECT_GT(path.pieces, 20);
  for (std::size_t i = 1; i < path.points.size(); ++i)
    if (!is_first(path, i)) EXPECT_EQ(path.points[i].position[2], path.points[i - 1].position[2]);
}

TEST(Coverage, HasTheSpacingInSpace) {
  const double spacing = 0.1;
  const Patch cap = patch(161, 1.4, on_sphere);
  for (const CoveragePoint& p : coverage_path(InverseMap(cap.surface()), {.radius = 1.2, .spacing = spacing}).points) {
    const double u = p.coordinates[0], v = p.coordinates[1], r = std::hypot(u, v);
    EXPECT_LT(std::abs(dot(p.heading, p.normal)), 1e-12);
    EXPECT_NEAR(dot(p.heading, p.heading), 1, 1e-12);
    if (r < 0.2) continue;
    // Jacobi fields on the sphere: 1 along the radius, sin r / r across it. Over the width of a line they change by at most half of it.
    // The error of derivatives is of the order of the edge length.
    const double s = std::sin(r) / r, along = std::hypot(u / r, v / r * s);
    EXPECT_NEAR(p.spacing, spacing * s / along, spacing * (spacing / 2 + cap.longest_edge));
  }
}

TEST(Coverage, HasNoSpacingWithoutANeighborAndNoPointsWithoutAMap) {
  Patch strip = patch(41, 1, flat);
  for (std::size_t i = 0; i < strip.valid.size(); ++i) strip.valid[i] = std::abs(strip.coordinates[2 * i + 1]) < 0.3;
  const CoveragePath path = coverage_path(InverseMap(strip.surface()), {.radius = 0.9, .spacing = 0.5});
  ASSERT_FALSE(path.points.empty());
  for (const CoveragePoint& p : path.points) EXPECT_TRUE(std::isnan(p.spacing));
  std::ranges::fill(strip.valid, std::uint8_t{0});
  const CoveragePath empty = coverage_path(InverseMap(strip.surface()), {.radius = 0.9, .spacing = 0.1});
  EXPECT_TRUE(empty.points.empty());
  EXPECT_EQ(empty.pieces, 0);
  EXPECT_GT(empty.planned, 0);
}

TEST(Coverage, RefusesInvalidArguments) {
  const InverseMap inverse = plane_inverse();
  for (const CoverageOptions& options : {CoverageOptions{.radius = 0, .spacing = 0.1},
                                         {.radius = 1, .spacing = -1},
                                         {.radius = 1, .spacing = 1e-9},
                                         {.radius = 1, .spacing = 0.1, .step = NAN},
                                         {.radius = 1, .spacing = 0.1, .angle = NAN}})
    EXPECT_THROW(coverage_path(inverse, options), InvalidArgument);
  expect_error<InvalidArgument>([&] { coverage_path(inverse, {.radius = 1, .spacing = 1e-7}); }, "6.28319e+14 points");
}

/// Expects points, and the middles of the lines between them, on a surface, and arclengths that are sums of distances.
void expect_on(const Surface& surface, const CoveragePath& path) {
  for (std::size_t k = 0; k < path.points.size(); ++k) {
    const CoveragePoint& p = path.points[k];
    ASSERT_LT(surface.closest_point(p.position).distance, 1e-12) << k;
    if (is_first(path, k)) {
      EXPECT_EQ(p.arclength, 0);
      EXPECT_FALSE(p.between);
      continue;
    }
    const CoveragePoint& last = path.points[k - 1];
    ASSERT_LT(surface.closest_point(0.5 * (last.position + p.position)).distance, 1e-12) << k;
    ASSERT_NEAR(p.arclength - last.arclength, distance(last.position, p.position), 1e-12);
  }
}

InverseMap exact_inverse(const ExactGeodesics& geodesics, const Surface& surface, Row source) {
  return inverse_map(surface, geodesics.log_map(source, {}, {.frames = true, .progress = {}}));
}

TEST(CoverageOfMeshes, IsShortestBetweenPointsOfThePattern) {
  const auto surface = mesh_surface(split_icosphere(640));
  const ExactGeodesics geodesics(surface);
  const InverseMap inverse = exact_inverse(geodesics, surface, Row{5});
  for (const double step : {0.05, 0.5}) {  // a third of an edge, three edges
    const CoverageOptions options{.radius = 1.4, .spacing = 0.3, .step = step};
    const CoveragePath path = coverage_path(surface, inverse, options), chords = coverage_path(inverse, options);
    expect_on(surface, path);
    EXPECT_EQ(std::ranges::count(path.points, false, &CoveragePoint::between), std::ssize(chords.points));
    EXPECT_GT(path.points.size(), chords.points.size());
    EXPECT_EQ(path.pieces, chords.pieces);
    const CoveragePoint* last = nullptr;
    for (const CoveragePoint& p : path.points) {
      EXPECT_NEAR(dot(p.heading, p.normal), 0, 1e-12);
      EXPECT_NEAR(dot(p.heading, p.heading), 1, 1e-12);
      if (p.between) continue;
      if (last != nullptr && last->piece == p.piece) {
        const SurfacePoint ends[] = {surface.closest_point(last->position).point,
                                     surface.closest_point(p.position).point};
        EXPECT_NEAR(p.arclength - last->arclength, geodesics.path(ends).length, 1e-11);
      }
      last = &p;
    }
  }
}

TEST(CoverageOfMeshes, LiesOnTheFlatTrianglesOfCurvedPolygons) {
  Polygons mesh = cube_sphere(7);
  for (Vec3& p : mesh.positions) p[2] += 0.2 * p[0] * p[1];
  const auto surface = polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners);
  const ExactGeodesics geodesics(surface);
  const FlatTriangles& triangles = geodesics.triangles();
  std::vector<Triangle> faces;
  for (Index f = 0; f < triangles.surface.face_count(); ++f) {
    const auto corner = [&](Index c) { return triangles.surface.record(3 * f + c).tail; };
    faces.push_back({corner(0), corner(1), corner(2)});
  }
  const CoveragePath path =
      coverage_path(surface, exact_inverse(geodesics, surface, Row{5}), {.radius = 1, .spacing = 0.2});
  EXPECT_GT(path.points.size(), 100u);
  EXPECT_EQ(path.straight_reason, "");
  expect_on(trimesh::TriangleMeshSurface::build(triangles.positions, faces), path);
}

TEST(CoverageOfMeshes, IsTheSameAsByInterpolationOnPlanes) {
  const auto surface = mesh_surface(flat_square(20));
  const InverseMap inverse = exact_inverse(ExactGeodesics(surface), surface, Row{190});
  for (const auto pattern : {CoveragePattern::raster, CoveragePattern::spiral}) {
    const CoverageOptions options{.radius = 0.4, .spacing = 0.07, .pattern = pattern, .angle = 0.3};
    const CoveragePath path = coverage_path(surface, inverse, options), chords = coverage_path(inverse, options);
    ASSERT_EQ(path.points.size(), chords.points.size());
    for (std::size_t k = 0; k < path.points.size(); ++k) {
      const CoveragePoint &a = path.points[k], &b = chords.points[k];
      EXPECT_EQ(a.position, b.position);
      EXPECT_EQ(a.heading, b.heading);
      EXPECT_EQ(a.piece, b.piece);
      EXPECT_EQ(a.arclength, b.arclength);
      EXPECT_FALSE(a.between);
    }
  }
}

TEST(CoverageOfMeshes, GoesAroundTheEndsOfASlit) {
  // A square of side 2 about the origin without a slit of one cell's width, |y| < 0.8.
  constexpr Index cells = 41;
  Mesh mesh;
  for (Index y = 0; y <= cells; ++y)
    for (Index x = 0; x <= cells; ++x) {
      mesh.positions.push_back({2.0 * x / cells - 1, 2.0 * y / cells - 1, 0});
      const Index a = y * (cells + 1) + x, c = a + cells + 1;
      if (x == cells || y == cells || (x == cells / 2 && std::abs(y - cells / 2) < 17)) continue;
      mesh.faces.insert(mesh.faces.end(), {{a, a + 1, c + 1}, {a, c + 1, c}});
    }
  const auto surface = mesh_surface(mesh);
  // By heat, because its coordinates extend beyond the slit.
  const Vertex source = surface.vertex(surface.nearest_row({-0.4, 0, 0}));
  const LogMap map = LogMapSolver(surface.graph()).solve(Source::at_vertex(source), {.frames = true});
  const InverseMap inverse = inverse_map(surface, map, {.min_quality = 0});
  const CoverageOptions options{.radius = 1.2, .spacing = 0.15, .step = 0.12};
  const CoveragePath path = coverage_path(surface, inverse, options);
  expect_on(surface, path);
  EXPECT_GT(path.pieces, coverage_path(inverse, options).pieces);
  EXPECT_GT(std::ranges::count(path.points, true, &CoveragePoint::between), 0);  // at the ends of the slit
}

}  // namespace
}  // namespace ahm::test
