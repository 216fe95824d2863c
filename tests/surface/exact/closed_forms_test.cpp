#include <gtest/gtest.h>

#include <cmath>

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
      const ExactMap map = exact::exact_map(surface, surface.vertex_point(source));
      for (Index v = 0; v < map.size(); ++v)
        EXPECT_NEAR(map.distance(v) * mesh.length_unit(), cone.distance(source, v), 1e-12) << angle << ' ' << source;
    }
  }
}

TEST(ExactMap, ScalesTheDirectionsAboutAnApexToAFullTurn) {
  const PolarCone cone(5.0, 24, 6);
  const auto mesh =
      trimesh::TriangleMesh::from_edge_lengths(static_cast<Index>(cone.polar.size()), cone.faces, cone.lengths);
  const PolyhedralSurface surface = surface_of(mesh);
  const ExactMap map = exact::exact_map(surface, surface.vertex_point(0));
  const double first = map.direction(1);
  for (Index v = 1; v < map.size(); ++v) {
    const double turn = 2 * 3.14159265358979323846, expected = first + cone.polar[v][1] * turn / cone.angle;
    EXPECT_NEAR(std::remainder(map.direction(v) - expected, turn), 0, 1e-12);
  }
}

TEST(ExactMap, GoesThroughTheTwistOfAPaperBand) {
  const PaperBand band = paper_band(30, 5);
  const auto mesh =
      trimesh::TriangleMesh::from_edge_lengths(static_cast<Index>(band.plane.size()), band.faces, band.lengths);
  ASSERT_FALSE(mesh.report().orientable);
  const PolyhedralSurface surface = surface_of(mesh);
  for (Index source : {0, 17, 95}) {
    const ExactMap map = exact::exact_map(surface, surface.vertex_point(source));
    for (Index v = 0; v < map.size(); ++v)
      EXPECT_NEAR(map.distance(v) * mesh.length_unit(), band.distance(band.plane[source], band.plane[v]), 1e-12);
  }
}

/// One triangle with two sides of length 1 glued to each other: a cone with one face.
struct OneTriangle {
  explicit OneTriangle(double angle)
      : angle(angle),
        surface(PolyhedralSurface::from_lengths({tails, twins},
                                                std::array{std::array{1.0, 2 * std::sin(angle / 2), 1.0}})) {}
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

TEST(ExactMap, IsSymmetricBetweenRandomPoints) {
  const PolarCone saddle(8.0, 12, 4);
  const auto flat =
      trimesh::TriangleMesh::from_edge_lengths(static_cast<Index>(saddle.polar.size()), saddle.faces, saddle.lengths);
  const Polyhedron needles(sliver_square(400)), band(moebius_mesh(40, 6)), sphere(icosphere(6)),
      holed(holed_square(12));
  const PolyhedralSurface cone = surface_of(flat);
  std::mt19937_64 random(11);
  for (const PolyhedralSurface* surface : {&cone, &needles.surface, &band.surface, &sphere.surface, &holed.surface})
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
