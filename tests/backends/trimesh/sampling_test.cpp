// The map at points and corners of the input mesh.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ahm/error.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

TEST(MeshSampling, IsExactOnThePlane) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const Mesh& mesh : {sliver_square(600), holed_square(20), maze(5)}) {
    const SolvedMesh solved(mesh);
    const LogMap map = solved.solver.solve(solved.surface.source(FacePoint{5, {0.25, 0.25, 0.5}}).source);
    const auto origin = mesh.plane_point(5, {0.25, 0.25, 0.5});
    const auto &a = mesh.plane[mesh.faces[5][0]], &b = mesh.plane[mesh.faces[5][1]];
    const double r = std::hypot(b[0] - a[0], b[1] - a[1]), c = (b[0] - a[0]) / r, s = (b[1] - a[1]) / r;
    auto exact = [&](const std::array<double, 2>& p) {
      const double x = p[0] - origin[0], y = p[1] - origin[1];
      return std::array{c * x + s * y, c * y - s * x};
    };
    for (int trial = 0; trial < 500; ++trial) {
      FacePoint point{static_cast<Index>(random() % mesh.faces.size()), {uniform(random), uniform(random), 0}};
      for (int k : {0, 1}) point.barycentric[k] *= 0.5;
      point.barycentric[2] = 1 - point.barycentric[0] - point.barycentric[1];
      const Sample sample = solved.surface.at(map, point);
      const auto wanted = exact(plane_point(mesh, point));
      ASSERT_EQ(sample.status, Status::ok);
      ASSERT_NEAR(sample.u, wanted[0], 2e-11);
      ASSERT_NEAR(sample.v, wanted[1], 2e-11);
    }
    const auto corners = solved.surface.to_corners(map);
    ASSERT_EQ(corners.size(), 3 * mesh.faces.size());
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const auto wanted = exact(mesh.plane[mesh.faces[k / 3][k % 3]]);
      ASSERT_NEAR(corners[k][0], wanted[0], 2e-10);
      ASSERT_NEAR(corners[k][1], wanted[1], 2e-10);
    }
  }
}

/// Side lengths of every face in the texture against those in space.
double worst_stretch(const Mesh& mesh, const std::vector<std::array<double, 2>>& corners, Index& torn) {
  double worst = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (int s = 0; s < 3; ++s) {
      const auto &p = corners[3 * f + s], &q = corners[3 * f + (s + 1) % 3];
      const Vec3 &a = mesh.positions[mesh.faces[f][s]], &b = mesh.positions[mesh.faces[f][(s + 1) % 3]];
      const double flat = std::hypot(p[0] - q[0], p[1] - q[1]);
      const double length =
          std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
      if (std::isnan(flat))
        ++torn;
      else
        worst = std::max(worst, std::max(flat / length, length / flat));
    }
  return worst;
}

TEST(MeshSampling, CutsTheTextureOpenAlongTheCutLocus) {
  // A closed cylinder: the cut locus of a point is the line opposite to it, and every face is nearly isometric on
  // either side.
  Mesh mesh;
  const Index around = 60, rows = 40;
  const double step = 2 * std::acos(-1.0) / around;
  for (Index i = 0; i < rows; ++i)
    for (Index j = 0; j < around; ++j)
      mesh.positions.push_back({i * step, std::cos((j + 0.3 * (i % 2)) * step), std::sin((j + 0.3 * (i % 2)) * step)});
  for (Index i = 0; i + 1 < rows; ++i)
    for (Index j = 0; j < around; ++j) {
      const Index a = i * around + j, b = i * around + (j + 1) % around, c = a + around, d = b + around;
      mesh.faces.push_back({a, b, d});
      mesh.faces.push_back({a, d, c});
    }
  const SolvedMesh solved(mesh);
  const Index source = (rows / 2) * around;
  const LogMap map = solved.solver.solve(solved.surface.source(Row(source)).source);
  Index torn = 0;
  const auto corners = solved.surface.to_corners(map);
  const double stretch = worst_stretch(mesh, corners, torn);
  EXPECT_EQ(torn, 0);
  // Without cutting, faces across it would be stretched tenfold.
  EXPECT_LE(stretch, 1.6);
  std::vector<std::array<double, 2>> joined(corners.size());
  for (std::size_t k = 0; k < joined.size(); ++k) {
    const auto phi = map.coordinates(solved.surface.vertex(Row(mesh.faces[k / 3][k % 3])));
    joined[k] = {phi[0], phi[1]};
  }
  EXPECT_GT(worst_stretch(mesh, joined, torn), 5);
}

TEST(MeshSampling, KeepsTheStatusOfMaskedVertices) {
  const Mesh mesh = icosphere(12);
  const SolvedMesh solved(mesh);
  const LogMap map = solved.solver.solve(solved.surface.source(Row(0)).source, {.radius = 0.5});
  const auto result = solved.surface.to_rows(map);
  const auto corners = solved.surface.to_corners(map);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    bool ok = true;
    for (Index v : mesh.faces[f]) ok = ok && result.status[v] == Status::ok;
    for (int s = 0; s < 3; ++s) ASSERT_EQ(std::isnan(corners[3 * f + s][0]), !ok);
    const Sample sample = solved.surface.at(map, FacePoint{static_cast<Index>(f), {0.4, 0.3, 0.3}});
    ASSERT_EQ(std::isnan(sample.u), sample.status != Status::ok);
  }
}

TEST(MeshSampling, RefusesMapsOfOtherGraphs) {
  const Mesh mesh = icosphere(4), other = icosphere(5);
  const SolvedMesh solved(mesh), wrong(other);
  const LogMap map = wrong.solver.solve(wrong.surface.source(Row(0)).source);
  EXPECT_THROW(solved.surface.to_rows(map), InvalidArgument);
  EXPECT_THROW(solved.surface.to_corners(map), InvalidArgument);
  EXPECT_THROW(solved.surface.at(map, FacePoint{0, {1, 0, 0}}), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
