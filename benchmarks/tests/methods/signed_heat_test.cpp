// SHM: signed distances to curves.
#include "methods/signed_heat.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ahm/applications/stroke.hpp"
#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/error.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "flat_maps.hpp"

namespace ahm::test {
namespace {

/// The middle row of `flat_square`, from left to right.
std::vector<Vertex> middle_row(Index side, Index first, Index last) {
  std::vector<Vertex> path;
  for (Index i = first; i <= last; ++i) path.emplace_back(side / 2 * side + i);
  return path;
}

/// Distance above the row of a vertex of `flat_square`.
double height(const Mesh& mesh, Index i) { return mesh.plane[i][1] - 0.5; }

TEST(SignedHeat, IsExactForAStraightLineInThePlane) {
  const Index side = 31;
  const Mesh mesh = flat_square(side);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.intrinsic_delaunay = false});
  const methods::SignedHeat shm(surface.graph());
  // The distance is that of a whole line on both sides of a broken line and beyond its ends.
  for (const auto& [first, last] : {std::pair{0, 30}, std::pair{10, 20}}) {
    const auto f = shm.signed_distance(stroke_source(surface.graph(), middle_row(side, first, last)));
    for (Index i = 0; i < mesh.vertices(); ++i) ASSERT_NEAR(f[i], height(mesh, i), 1e-10);
  }
}

TEST(SignedHeat, ClosesTheGapsOfABrokenLine) {
  const Index side = 31;
  const Mesh mesh = flat_square(side);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.intrinsic_delaunay = false});
  Source broken(2);
  for (const auto& [first, last] : {std::pair{2, 6}, std::pair{14, 17}, std::pair{25, 29}}) {
    const Source part = stroke_source(surface.graph(), middle_row(side, first, last));
    for (std::size_t k = 0; k < part.vertices().size(); ++k)
      broken.add(part.vertices()[k], part.weights()[k], part.offsets().subspan(2 * k, 2),
                 part.axes().subspan(4 * k, 4));
  }
  const auto f = methods::SignedHeat(surface.graph()).signed_distance(broken);
  for (Index i = 0; i < mesh.vertices(); ++i) ASSERT_NEAR(f[i], height(mesh, i), 1e-10);
}

TEST(SignedHeat, ChangesSignWithTheDirectionOfTheCurve) {
  const Index side = 21;
  const Mesh mesh = flat_square(side);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.intrinsic_delaunay = false});
  const methods::SignedHeat shm(surface.graph());
  auto path = middle_row(side, 5, 15);
  const auto f = shm.signed_distance(stroke_source(surface.graph(), path));
  std::reverse(path.begin(), path.end());
  const auto g = shm.signed_distance(stroke_source(surface.graph(), path));
  for (std::size_t i = 0; i < f.size(); ++i) ASSERT_NEAR(f[i], -g[i], 1e-10);
}

/// A ring of edges of a hexagon, counter-clockwise around its center.
std::vector<Vertex> ring(const Mesh& mesh, Index radius) {
  std::vector<std::pair<double, Index>> around;
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const auto& p = mesh.plane[i];
    // Distance in edges: the largest of the three lattice coordinates.
    const double j = p[1] / std::sqrt(0.75), k = p[0] - 0.5 * j;
    if (std::lround(std::max({std::abs(j), std::abs(k), std::abs(j + k)})) == radius)
      around.emplace_back(std::atan2(p[1], p[0]), i);
  }
  std::sort(around.begin(), around.end());
  std::vector<Vertex> path;
  for (const auto& [angle, i] : around) path.emplace_back(i);
  return path;
}

TEST(SignedHeat, IsPositiveInsideACounterClockwiseLoop) {
  const Mesh mesh = hexagon(20);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const auto f = methods::SignedHeat(surface.graph())
                     .signed_distance(stroke_source(surface.graph(), ring(mesh, 10), {.closed = true}));
  // Distance from the center of a hexagon to its sides. Diffusion rounds its corners by a few edges.
  EXPECT_NEAR(f[0], 10 * std::sqrt(0.75), 1.0);
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const double r = plane_distance(mesh, 0, i);
    if (r < 10 * std::sqrt(0.75) - 1) EXPECT_GT(f[i], 0) << r;
    if (r > 11) EXPECT_LT(f[i], 0) << r;
  }
}

TEST(SignedHeat, RefusesWhatIsNoCurve) {
  const CsrGraph sphere(sphere_graph(300)), lattice(bent_lattice(5));
  EXPECT_THROW(methods::SignedHeat(sphere).signed_distance(Source::at_vertex(Vertex{3})), InvalidArgument);
  EXPECT_THROW(methods::SignedHeat(lattice).signed_distance(Source::at_vertex(Vertex{3})), InvalidArgument);
  Source outside(2);
  const double zero[] = {0, 0}, axes[] = {1, 0, 0, 1};
  outside.add(Vertex{300000}, 1.0, zero, axes);
  EXPECT_THROW(methods::SignedHeat(sphere).signed_distance(outside), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
