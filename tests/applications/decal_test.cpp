#include "ahm/applications/decal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "mapped_surfaces.hpp"

namespace ahm::test {
namespace {

/// A tilted plane through (1, 2, 3).
std::array<Vec3, 2> tilted(double u, double v) { return {Vec3{1 + 0.6 * u, 2 + v, 3 + 0.8 * u}, Vec3{-0.8, 0, 0.6}}; }

/// The point of the decal at this place in the image; there is exactly one such place in every test that asks.
Vec3 point_at(const Decal& decal, double x, double y) {
  Vec3 found{1e9, 1e9, 1e9};
  for (std::size_t i = 0; i < decal.points.size(); ++i)
    if (std::hypot(decal.image_coordinates[2 * i] - x, decal.image_coordinates[2 * i + 1] - y) < 1e-12)
      found = decal.points[i];
  return found;
}

/// Area in space, by fans.
double area_of(const Decal& decal) {
  double area = 0;
  for (std::size_t f = 0; f + 1 < decal.face_begin.size(); ++f)
    for (Offset c = decal.face_begin[f] + 1; c + 1 < decal.face_begin[f + 1]; ++c) {
      std::array<Vec3, 2> side;
      const Vec3& o = decal.points[decal.face_vertices[decal.face_begin[f]]];
      for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t a = 0; a < 3; ++a) side[k][a] = decal.points[decal.face_vertices[to_size(c) + k]][a] - o[a];
      const auto& [a, b] = side;
      area += std::sqrt(dot(a, a) * dot(b, b) - dot(a, b) * dot(a, b)) / 2;
    }
  return area;
}

TEST(Decal, LiesOnAPlaneWhereItsImageDoes) {
  const Patch plane = patch(23, 1, tilted);
  const InverseMap inverse(plane.surface());
  for (double angle : {0.0, 0.4, -2.0}) {
    const Decal decal = make_decal(inverse, {.width = 0.8, .height = 0.5, .angle = angle});
    const double c = std::cos(angle), s = std::sin(angle);
    for (const auto& [x, y] : {std::array{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
      const double across = 0.8 * (x - 0.5), up = 0.5 * (y - 0.5);
      EXPECT_LT(distance(point_at(decal, x, y), tilted(c * across - s * up, s * across + c * up)[0]), 1e-9);
    }
    for (std::size_t i = 0; i < decal.points.size(); ++i) {
      const double across = 0.8 * (decal.image_coordinates[2 * i] - 0.5),
                   up = 0.5 * (decal.image_coordinates[2 * i + 1] - 0.5);
      EXPECT_LT(distance(decal.points[i], tilted(c * across - s * up, s * across + c * up)[0]), 1e-9);
      EXPECT_LT(distance(decal.normals[i], {-0.8, 0, 0.6}), 1e-12);
    }
    EXPECT_NEAR(area_of(decal), 0.4, 1e-9);  // neither gaps nor overlaps
    EXPECT_EQ(decal.hidden, 0);
  }
}

TEST(Decal, TurnsWithTheSourcesFrame) {
  // The same surface seen from a source whose u axis is turned by `turn`: the coordinates turn back.
  const Patch cap = patch(25, 1.2, on_sphere);
  Patch turned = cap;
  const double turn = 0.7, c = std::cos(turn), s = std::sin(turn);
  for (std::size_t i = 0; i + 1 < turned.coordinates.size(); i += 2) {
    const double u = cap.coordinates[i], v = cap.coordinates[i + 1];
    turned.coordinates[i] = c * u + s * v, turned.coordinates[i + 1] = c * v - s * u;
  }
  const Decal a = make_decal(InverseMap(cap.surface()), {.width = 0.9, .height = 0.6, .angle = 0.3}),
              b = make_decal(InverseMap(turned.surface()), {.width = 0.9, .height = 0.6, .angle = 0.3 - turn});
  EXPECT_NEAR(area_of(a), area_of(b), 1e-9);
  for (const auto& [x, y] : {std::array{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
    EXPECT_LT(distance(point_at(a, x, y), point_at(b, x, y)), 1e-9);
    EXPECT_NEAR(dot(point_at(a, x, y), point_at(a, x, y)), 1, 0.01);
  }
}

TEST(Decal, MirroredExchangesLeftAndRight) {
  const InverseMap inverse(patch(15, 1, flat).surface());
  const Decal plain = make_decal(inverse, {.width = 1, .height = 0.5}),
              mirrored = make_decal(inverse, {.width = 1, .height = 0.5, .mirrored = true});
  EXPECT_LT(distance(point_at(plain, 0, 1), point_at(mirrored, 1, 1)), 1e-12);
}

TEST(Decal, IsCutAtTheRadiusAndLiftedAlongNormals) {
  const InverseMap inverse(patch(31, 1, flat).surface());
  const double r = 0.4;
  const Decal decal = make_decal(inverse, {.width = 1, .height = 1, .radius = r, .lift = 0.25});
  double farthest = 0;
  for (const Vec3& p : decal.points) {
    farthest = std::max(farthest, std::hypot(p[0], p[1]));
    EXPECT_NEAR(p[2], 0.25, 1e-12);
  }
  EXPECT_NEAR(farthest, r, 1e-9);
  EXPECT_NEAR(area_of(decal), 32 * r * r * std::sin(2 * std::numbers::pi / 64), 1e-9);  // of 64 corners
}

TEST(Decal, HasNoFacesWhereTheMapIsNotTrusted) {
  Patch plane = patch(31, 1, flat);
  for (std::size_t i = 0; i < plane.valid.size(); ++i) plane.valid[i] = plane.coordinates[2 * i] < 0.2;
  const Decal decal = make_decal(InverseMap(plane.surface()), {.width = 1, .height = 1});
  EXPECT_FALSE(decal.points.empty());
  for (const Vec3& p : decal.points) EXPECT_LT(p[0], 0.2);
  EXPECT_GT(area_of(decal), 0.7 - plane.longest_edge);
}

TEST(Decal, ShowsOneSheetOfAFold) {
  const Patch strip = pleat();
  const InverseMap inverse(strip.surface());
  const Decal decal = make_decal(inverse, {.width = 4, .height = 1});
  EXPECT_EQ(decal.hidden, 40);  // of the third sheet, over the first and beyond it
  EXPECT_NEAR(area_of(decal), 0.05 * 1, 1e-9);
  for (const Vec3& p : decal.points) EXPECT_LE(p[0], 1 + 1e-9);
  const auto places = image_coordinates_of_vertices(inverse, {.width = 4, .height = 1});
  for (std::size_t i = 0; i < strip.positions.size(); ++i)
    EXPECT_EQ(std::isfinite(places[2 * i]), strip.positions[i][0] <= 1 + 1e-9) << strip.positions[i][0];
}

TEST(Decal, OnVerticesAgreesWithTheMesh) {
  const Patch cap = patch(25, 1.2, on_sphere);
  const InverseMap inverse(cap.surface());
  const DecalOptions options{.width = 1, .height = 0.7, .angle = 1, .radius = 0.45};
  const auto places = image_coordinates_of_vertices(inverse, options);
  const Decal decal = make_decal(inverse, options);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < cap.positions.size(); ++i) {
    if (std::isnan(places[2 * i])) continue;
    ++inside;
    EXPECT_LT(distance(point_at(decal, places[2 * i], places[2 * i + 1]), cap.positions[i]), 1e-12);
  }
  EXPECT_GT(inside, 20U);
}

TEST(Decal, RefusesBadSizes) {
  const InverseMap inverse(patch(5, 1, flat).surface());
  for (double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(make_decal(inverse, {.width = bad, .height = 1}), InvalidArgument);
    EXPECT_THROW(image_coordinates_of_vertices(inverse, {.width = 1, .height = bad}), InvalidArgument);
  }
  EXPECT_THROW(make_decal(inverse, {.width = 1, .height = 1, .angle = std::nan("")}), InvalidArgument);
  EXPECT_THROW(make_decal(inverse, {.width = 1, .height = 1, .radius = 0}), InvalidArgument);
  EXPECT_THROW(make_decal(inverse, {.width = 1, .height = 1, .lift = std::nan("")}), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
