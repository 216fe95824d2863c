// Isolines of functions with known level sets.
#include "ahm/applications/isolines.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/vec.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

std::vector<double> heights(std::span<const Vec3> points) {
  std::vector<double> z;
  for (const Vec3& p : points) z.push_back(p[2]);
  return z;
}

TEST(Isolines, OfTheHeightOnASphereAreCirclesOfLatitude) {
  const Mesh sphere = icosphere(16);
  const auto surface = trimesh::TriangleMeshSurface::build(sphere.positions, sphere.faces);
  const std::vector<double> levels{-0.7, 0.1, 0.5};
  const std::vector<Isoline> lines = isolines(surface, heights(sphere.positions), levels);
  ASSERT_EQ(lines.size(), levels.size());
  double h = 0;  // longest edge
  for (const Triangle& f : sphere.faces)
    for (std::size_t s = 0; s < 3; ++s)
      h = std::max(h, norm(sphere.positions[f[s]] - sphere.positions[f[(s + 1) % 3]]));
  const double sagitta = h * h / 6;  // of a triangle: its circumradius is at most h / sqrt(3)
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const Isoline& line = lines[k];
    EXPECT_EQ(line.level, levels[k]);
    EXPECT_TRUE(line.closed);
    const double radius = std::sqrt(1 - levels[k] * levels[k]);
    EXPECT_NEAR(line.length, 2 * std::numbers::pi * radius, 2 * std::numbers::pi * sagitta / radius);
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const Vec3 &p = line.points[i], &q = line.points[(i + 1) % line.points.size()];
      EXPECT_NEAR(p[2], levels[k], 1e-12);
      EXPECT_NEAR(norm(p), 1, sagitta);
      EXPECT_GT(p[0] * q[1] - p[1] * q[0], 0);  // larger heights are on the left
    }
  }
}

TEST(Isolines, EndAtTheBoundaryAndWhereTheFunctionIsNotANumber) {
  const Mesh square = flat_square(21);
  const auto surface = trimesh::TriangleMeshSurface::build(square.positions, square.faces);
  std::vector<double> u;
  for (const Vec2& p : square.plane) u.push_back(p[0]);
  const std::vector<double> middle{0.52};
  const std::vector<Isoline> one = isolines(surface, u, middle);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_FALSE(one[0].closed);
  EXPECT_NEAR(one[0].length, 1, 1e-12);
  u[static_cast<std::size_t>(nearest(square, {0.52, 0.5}))] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Isoline> two = isolines(surface, u, middle);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_LT(two[0].length + two[1].length, 1);
}

TEST(Isolines, OfACloudAreTheSameCircles) {
  const Mesh sphere = icosphere(16);
  const auto surface = pointcloud::PointCloudSurface::build(sphere.positions);
  const std::vector<double> levels{0.31};
  const std::vector<Isoline> lines = isolines(surface, heights(sphere.positions), levels);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].closed);
  EXPECT_NEAR(lines[0].length, 2 * std::numbers::pi * std::sqrt(1 - 0.31 * 0.31), 0.02);
}

TEST(Isolines, LevelsAreMultiplesOfTheStep) {
  const std::vector<double> values{-0.25, std::numeric_limits<double>::quiet_NaN(), 1.0};
  EXPECT_EQ(level_multiples(values, 0.5), (std::vector<double>{0, 0.5, 1}));
}

TEST(Isolines, RejectsWhatHasNoLines) {
  const Mesh sphere = icosphere(2);
  const auto surface = trimesh::TriangleMeshSurface::build(sphere.positions, sphere.faces);
  const std::vector<double> z = heights(sphere.positions), none(z.size(), std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> levels{0.1}, infinite{std::numeric_limits<double>::infinity()};
  expect_error<InvalidArgument>([&] { isolines(surface, std::span(z).first(3), levels); }, "3 values for 42 rows");
  expect_error<InvalidArgument>([&] { isolines(surface, z, infinite); }, "not finite");
  expect_error<InvalidArgument>([&] { level_multiples(z, 0); }, "step");
  expect_error<InvalidArgument>([&] { level_multiples(z, 1e-9); }, "more than a million");
  expect_error<InvalidArgument>([&] { level_multiples(none, 1); }, "no value is finite");
}

}  // namespace
}  // namespace ahm::test
