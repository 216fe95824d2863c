#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "ahm/conformance/paper_band.hpp"
#include "polyhedra.hpp"

namespace ahm::test {
namespace {

using exact::ExactMap;
using exact::MeshPoint;
using exact::PolyhedralSurface;

TEST(ExactMap, UnrollsConesAboutSharpAndSaddleApexes) {
  for (double angle : {2.5, 5.0, 7.0, 9.5}) {
    const PolarCone cone(angle, 24, 6);
    const auto mesh =
        trimesh::TriangleMesh::from_edge_lengths(static_cast<Index>(cone.polar.size()), cone.faces, cone.lengths);
    const PolyhedralSurface surface = surface_of(mesh);
    for (Index source : {0, 30, 100}) {
      const ExactMap map = exact::exact_map(surface, surface.vertex_point(Vertex(source)));
      for (Index v = 0; v < map.size(); ++v)
        EXPECT_NEAR(map.distance(Vertex(v)) * mesh.length_unit(), cone.distance(source, v), 1e-12)
            << angle << ' ' << source;
    }
  }
}

TEST(ExactMap, ScalesTheDirectionsAboutAnApexToAFullTurn) {
  const PolarCone cone(5.0, 24, 6);
  const auto mesh =
      trimesh::TriangleMesh::from_edge_lengths(static_cast<Index>(cone.polar.size()), cone.faces, cone.lengths);
  const PolyhedralSurface surface = surface_of(mesh);
  const ExactMap map = exact::exact_map(surface, surface.vertex_point(Vertex(0)));
  const double first = map.direction(Vertex(1));
  for (Index v = 1; v < map.size(); ++v) {
    const double turn = 2 * 3.14159265358979323846, expected = first + cone.polar[v][1] * turn / cone.angle;
    EXPECT_NEAR(std::remainder(map.direction(Vertex(v)) - expected, turn), 0, 1e-12);
  }
}

// Far along a tube the rays beside a row of vertices miss the next one by what rounding makes of their angles, many times over.
TEST(ExactMap, GoesFarAlongTubes) {
  const Index around = 40, rings = 900;
  const double radius = around / (2 * std::numbers::pi), side = 2 * radius * std::sin(std::numbers::pi / around);
  Mesh tube;
  for (Index j = 0; j < rings; ++j)
    for (Index i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      tube.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), static_cast<double>(j)});
      if (j + 1 == rings) continue;
      const Index a = j * around + i, b = j * around + (i + 1) % around;
      tube.faces.push_back({a, b, b + around});
      tube.faces.push_back({a, b + around, a + around});
    }
  const Polyhedron polyhedron(tube);
  const double unit = polyhedron.mesh.length_unit();
  for (const Index source : {12, 20}) {
    const ExactMap map = exact::exact_map(polyhedron.surface, polyhedron.surface.vertex_point(Vertex(source)));
    for (Index v = 0; v < map.size(); ++v) {
      const Index apart = std::abs(v % around - source % around);
      const double across = side * std::min(apart, around - apart), along = v / around - source / around;
      ASSERT_NEAR(map.distance(Vertex(v)) * unit, std::hypot(across, along), 1e-9) << source << ' ' << v;
    }
  }
}

/// The nearest of the images of q in the strip that the band was glued from, as seen from p.
Vec2 seen_in_band(const Vec2& p, const Vec2& q) {
  Vec2 nearest{q[0] - p[0], q[1] - p[1]};
  for (double turn : {-1.0, 1.0}) {
    const Vec2 image{q[0] + turn - p[0], 0.2 - q[1] - p[1]};
    if (std::hypot(image[0], image[1]) < std::hypot(nearest[0], nearest[1])) nearest = image;
  }
  return nearest;
}

double angle_between(const Vec2& a, const Vec2& b) {
  return std::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
}

TEST(ExactMap, GoesThroughTheTwistOfAPaperBand) {
  const PaperBand band = paper_band(30, 5);
  const auto mesh =
      trimesh::TriangleMesh::from_edge_lengths(static_cast<Index>(band.plane.size()), band.faces, band.lengths);
  ASSERT_FALSE(mesh.report().orientable);
  const PolyhedralSurface surface = surface_of(mesh);
  for (Index source = 0; source < surface.vertex_count(); source += 4) {
    const ExactMap map = exact::exact_map(surface, surface.vertex_point(Vertex(source)));
    auto seen = [&](Index v) { return seen_in_band(band.plane[source], band.plane[v]); };
    const exact::Corner first = surface.first_corner(source);
    const auto& r = surface.record(first.half);
    const Index right = first.forward ? r.head : r.apex, left = first.forward ? r.apex : r.head;
    const double sense = angle_between(seen(right), seen(left)) > 0 ? 1 : -1;
    for (Index v = 0; v < map.size(); ++v) {
      if (v == source) continue;
      const Vec2 d = seen(v);
      EXPECT_NEAR(map.distance(Vertex(v)) * mesh.length_unit(), std::hypot(d[0], d[1]), 1e-12);
      const double turned =
          std::remainder(map.direction(Vertex(v)) - sense * angle_between(seen(right), d), 2 * std::numbers::pi);
      EXPECT_NEAR(turned, 0, 1e-11) << source << ' ' << v;
    }
  }
}

/// One triangle with two sides of length 1 glued to each other: a cone with one face.
struct OneTriangle {
  explicit OneTriangle(double angle)
      : angle(angle),
        lengths{{1.0, 2 * std::sin(angle / 2), 1.0}},
        surface(PolyhedralSurface::from_lengths({tails, twins}, lengths)) {}
  Vec2 place(const MeshPoint& p) const {
    return {p.barycentric[1] + p.barycentric[2] * std::cos(angle), p.barycentric[2] * std::sin(angle)};
  }
  /// The least distance to the images of q turned about the apex.
  double distance(const MeshPoint& p, const MeshPoint& q) const {
    const Vec2 a = place(p), b = place(q);
    double least = 1e300;
    for (int k = -1; k <= 1; ++k) {
      const double c = std::cos(k * angle), s = std::sin(k * angle);
      least = std::min(least, std::hypot(a[0] - c * b[0] + s * b[1], a[1] - s * b[0] - c * b[1]));
    }
    return least;
  }

  static constexpr std::array<Index, 3> tails{0, 1, 1};
  static constexpr std::array<exact::Half, 3> twins{2, -1, 0};
  double angle;
  std::array<std::array<double, 3>, 1> lengths;
  PolyhedralSurface surface;
};

TEST(ExactMap, CrossesTheGluedSidesOfOneTriangle) {
  for (double angle : {0.4, 1.0, 2.0, 2.9}) {
    const OneTriangle cone(angle);
    std::mt19937_64 random(3);
    for (int k = 0; k < 100; ++k) {
      const MeshPoint p = random_point(cone.surface, random), q = random_point(cone.surface, random);
      EXPECT_NEAR(exact::geodesic_path(cone.surface, p, q).length, cone.distance(p, q), 1e-13) << angle;
    }
  }
}

/// A sphere whose vertices lie up to a quarter of the radius too high or too low: as many saddles as tips.
Mesh rough_sphere(Index parts, std::mt19937_64& random) {
  Mesh mesh = icosphere(parts);
  std::uniform_real_distribution<double> height(0.75, 1.25);
  for (Vec3& p : mesh.positions) {
    const double h = height(random);
    for (double& x : p) x *= h;
  }
  return mesh;
}

TEST(ExactMap, IsSymmetricBetweenRandomPoints) {
  const PolarCone saddle(8.0, 12, 4);
  const auto flat =
      trimesh::TriangleMesh::from_edge_lengths(static_cast<Index>(saddle.polar.size()), saddle.faces, saddle.lengths);
  const Polyhedron needles(sliver_square(400)), band(moebius_mesh(40, 6)), sphere(icosphere(6)),
      holed(holed_square(12));
  const PolyhedralSurface cone = surface_of(flat);
  std::mt19937_64 random(11);
  const Polyhedron rough(rough_sphere(14, random));
  for (const PolyhedralSurface* surface :
       {&cone, &needles.surface, &band.surface, &sphere.surface, &holed.surface, &rough.surface})
    for (int k = 0; k < 60; ++k) {
      const MeshPoint p = random_point(*surface, random), q = random_point(*surface, random);
      const double there = exact::geodesic_path(*surface, p, q).length,
                   back = exact::geodesic_path(*surface, q, p).length;
      EXPECT_NEAR(there, back, 1e-12);
      EXPECT_GT(there, 0);
    }
}

}  // namespace
}  // namespace ahm::test
