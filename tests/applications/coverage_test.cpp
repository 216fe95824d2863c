// Paths that cover a surface.
#include "ahm/applications/coverage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ahm/error.hpp"
#include "mapped_surfaces.hpp"

namespace ahm::test {
namespace {

constexpr double pi = std::numbers::pi;

InverseMap plane_inverse() { return InverseMap(patch(31, 1.5, flat).surface()); }

TEST(Coverage, RasterOnThePlaneHasEqualSpacingAndAlternates) {
  const InverseMap inverse = plane_inverse();
  const CoverageOptions options{.radius = 1, .spacing = 0.15, .step = 0.04};
  const CoveragePath path = coverage_path(inverse, options);
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
    if (i == 0 || path.points[i - 1].piece != p.piece) {
      EXPECT_EQ(p.arclength, 0);
    } else {
      const double step = distance(p.position, path.points[i - 1].position);
      EXPECT_LE(step, options.step * (1 + 1e-9));
      EXPECT_NEAR(p.arclength - path.points[i - 1].arclength, step, 1e-13);
    }
  }
}

TEST(Coverage, TurnsWithItsAngle) {
  const InverseMap inverse = plane_inverse();
  for (const auto pattern : {CoveragePattern::raster, CoveragePattern::spiral}) {
    const CoveragePath straight = coverage_path(inverse, {.radius = 1, .spacing = 0.2, .pattern = pattern});
    const CoveragePath turned = coverage_path(inverse, {.radius = 1, .spacing = 0.2, .pattern = pattern, .angle = 0.7});
    ASSERT_EQ(straight.points.size(), turned.points.size());
    const double c = std::cos(0.7), s = std::sin(0.7);
    for (std::size_t i = 0; i < straight.points.size(); ++i) {
      const Vec3 &p = straight.points[i].position, &h = straight.points[i].heading;
      EXPECT_LT(distance(turned.points[i].position, {c * p[0] - s * p[1], s * p[0] + c * p[1], 0}), 1e-13);
      EXPECT_LT(distance(turned.points[i].heading, {c * h[0] - s * h[1], s * h[0] + c * h[1], 0}), 1e-9);
    }
  }
}

TEST(Coverage, SpiralOnThePlaneKeepsItsPitch) {
  const CoverageOptions options{.radius = 1, .spacing = 0.11, .pattern = CoveragePattern::spiral, .step = 0.02};
  const CoveragePath path = coverage_path(plane_inverse(), options);
  EXPECT_EQ(path.pieces, 1);
  double angle = 0;
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    const auto &a = path.points[i - 1].coordinates, &b = path.points[i].coordinates;
    angle += i == 1 ? std::atan2(b[1], b[0]) : std::remainder(std::atan2(b[1], b[0]) - std::atan2(a[1], a[0]), 2 * pi);
    EXPECT_NEAR(std::hypot(b[0], b[1]), options.spacing * angle / (2 * pi), 1e-12);
    EXPECT_LE(distance(path.points[i].position, path.points[i - 1].position), options.step);
  }
  EXPECT_NEAR(std::hypot(path.points.back().position[0], path.points.back().position[1]), 1, 1e-12);
  // Arclength of r = b angle against b/2 (angle sqrt(1 + angle^2) + asinh angle); chords fall short of arcs by at most
  // step^2 / 24 of the squared curvature, which is at most 2 / b.
  const double b = options.spacing / (2 * pi), last = 1 / b,
               exact = b / 2 * (last * std::hypot(1, last) + std::asinh(last));
  EXPECT_LE(path.points.back().arclength, exact);
  EXPECT_GE(path.points.back().arclength, exact - options.step);
}

TEST(Coverage, LeavesNoPointOfTheDiscFartherThanHalfTheSpacing) {
  const InverseMap inverse = plane_inverse();
  const double spacing = 0.13, step = 0.03;
  for (const auto pattern : {CoveragePattern::raster, CoveragePattern::spiral}) {
    const CoveragePath path =
        coverage_path(inverse, {.radius = 1, .spacing = spacing, .pattern = pattern, .step = step, .angle = 0.3});
    for (const auto& [u, v] : points_in_disc(1 - spacing, 1000)) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const CoveragePoint& p : path.points) nearest = std::min(nearest, distance(p.position, {u, v, 0}));
      EXPECT_LE(nearest, std::hypot(spacing / 2, step / 2) + 1e-12);
    }
  }
}

TEST(Coverage, IsCutIntoPiecesWhereTheMapIsNotValid) {
  Patch plane = patch(61, 1.5, flat);
  const auto in_slot = [](double u) { return std::abs(u - 0.3) < 0.1; };
  for (std::size_t i = 0; i < plane.valid.size(); ++i) plane.valid[i] = !in_slot(plane.coordinates[2 * i]);
  const InverseMap inverse(plane.surface());
  const double step = 0.09;  // a tool would fly over the slot in four of these
  const CoveragePath path = coverage_path(inverse, {.radius = 1, .spacing = 0.1, .step = step});
  EXPECT_LT(path.points.size(), static_cast<std::size_t>(path.planned));
  std::vector<Index> pieces_of_line(21, 0);
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const CoveragePoint& p = path.points[i];
    EXPECT_FALSE(in_slot(p.coordinates[0]));
    const bool first = i == 0 || path.points[i - 1].piece != p.piece;
    if (first) {
      EXPECT_EQ(p.piece, i == 0 ? 0 : path.points[i - 1].piece + 1);
      ++pieces_of_line[p.line];
    } else {
      EXPECT_LE(distance(p.position, path.points[i - 1].position), step + 1e-12);
    }
  }
  EXPECT_EQ(path.points.back().piece + 1, path.pieces);
  for (int line = 5; line <= 15; ++line) EXPECT_EQ(pieces_of_line[line], 2) << line;
}

TEST(Coverage, NeverJumpsFromSheetToSheet) {
  // A cliff at u = 0: the triangles across it are stretched too much, and steps are longer than the gap they leave.
  const Patch cliff = patch(61, 1, [](double u, double v) {
    return std::array<Vec3, 2>{Vec3{u, v, u > 0 ? 3.0 : 0.0}, Vec3{0, 0, 1}};
  });
  const CoveragePath path = coverage_path(InverseMap(cliff.surface()), {.radius = 0.9, .spacing = 0.1, .step = 0.2});
  EXPECT_GT(path.pieces, 20);
  for (std::size_t i = 1; i < path.points.size(); ++i)
    if (path.points[i].piece == path.points[i - 1].piece)
      EXPECT_EQ(path.points[i].position[2], path.points[i - 1].position[2]);
}

TEST(Coverage, SpiralKeepsItsPitchOnASphere) {
  const double spacing = 0.1;
  const Patch cap = patch(81, 1.3, on_sphere);
  const CoveragePath path =
      coverage_path(InverseMap(cap.surface()), {.radius = 1.2, .spacing = spacing, .pattern = CoveragePattern::spiral});
  ASSERT_EQ(path.pieces, 1);
  double angle = 0;
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    const Vec3 &a = path.points[i - 1].position, &b = path.points[i].position;
    angle += i == 1 ? std::atan2(b[1], b[0]) : std::remainder(std::atan2(b[1], b[0]) - std::atan2(a[1], a[0]), 2 * pi);
    const double from_pole = std::atan2(std::hypot(b[0], b[1]), b[2]);
    // Linear interpolation is off by h^2 / 8 times the second derivative of the map, at most 1.
    EXPECT_NEAR(from_pole, spacing * angle / (2 * pi), cap.longest_edge * cap.longest_edge / 2 + spacing * 1e-2);
  }
}

TEST(Coverage, TellsTheSpacingInSpace) {
  const double spacing = 0.1;
  const Patch cap = patch(161, 1.4, on_sphere);
  const CoveragePath path = coverage_path(InverseMap(cap.surface()), {.radius = 1.2, .spacing = spacing});
  for (const CoveragePoint& p : path.points) {
    const double u = p.coordinates[0], v = p.coordinates[1], r = std::hypot(u, v);
    EXPECT_LT(std::abs(dot(p.heading, p.normal)), 1e-12);
    EXPECT_NEAR(dot(p.heading, p.heading), 1, 1e-12);
    if (r < 0.2) continue;
    // Jacobi fields on the sphere: 1 along the radius, sin r / r across it. Over the width of a line they change by at
    // most half of it, and derivatives across triangles are off by the edge length.
    const double s = std::sin(r) / r, along = std::hypot(u / r, v / r * s);
    EXPECT_NEAR(p.spacing, spacing * s / along, spacing * (spacing / 2 + cap.longest_edge));
  }
}

TEST(Coverage, KnowsNoSpacingWithoutANeighbour) {
  Patch strip = patch(41, 1, flat);
  for (std::size_t i = 0; i < strip.valid.size(); ++i) strip.valid[i] = std::abs(strip.coordinates[2 * i + 1]) < 0.3;
  const CoveragePath path = coverage_path(InverseMap(strip.surface()), {.radius = 0.9, .spacing = 0.5});
  ASSERT_FALSE(path.points.empty());
  for (const CoveragePoint& p : path.points) EXPECT_TRUE(std::isnan(p.spacing));
}

TEST(Coverage, IsEmptyWhereNothingIsValid) {
  Patch plane = patch(11, 1, flat);
  std::fill(plane.valid.begin(), plane.valid.end(), std::uint8_t{0});
  const CoveragePath path = coverage_path(InverseMap(plane.surface()), {.radius = 1, .spacing = 0.1});
  EXPECT_TRUE(path.points.empty());
  EXPECT_EQ(path.pieces, 0);
  EXPECT_GT(path.planned, 0);
}

TEST(Coverage, RefusesBadArguments) {
  const InverseMap inverse = plane_inverse();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(coverage_path(inverse, {.radius = 0, .spacing = 0.1}), InvalidArgument);
  EXPECT_THROW(coverage_path(inverse, {.radius = 1, .spacing = -1}), InvalidArgument);
  EXPECT_THROW(coverage_path(inverse, {.radius = 1, .spacing = 0.1, .step = nan}), InvalidArgument);
  EXPECT_THROW(coverage_path(inverse, {.radius = 1, .spacing = 0.1, .angle = nan}), InvalidArgument);
  EXPECT_THROW(coverage_path(inverse, {.radius = 1, .spacing = 1e-9}), InvalidArgument);
  try {
    coverage_path(inverse, {.radius = 1, .spacing = 1e-7});
    FAIL() << "a pattern without bounds";
  } catch (const InvalidArgument& e) {
    EXPECT_NE(std::string(e.what()).find("about 6.28319e+14 points"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace ahm::test
