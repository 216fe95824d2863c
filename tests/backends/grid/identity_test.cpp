// On a grid the log map is the position relative to the source, in two and three dimensions and from any point.
#include <gtest/gtest.h>

#include <cmath>

#include "ahm/conformance/graph_changes.hpp"
#include "ahm/fields/vector_heat.hpp"
#include "ahm/grid/grid_graph.hpp"

namespace ahm::test {
namespace {

using grid::Grid;
using grid::GridGraph;

class GridMap : public testing::TestWithParam<Grid> {
 protected:
  GridMap() : grid(GetParam()), solver(grid), d(grid.dimension()) {
    const double unit = grid.length_unit();
    for (int a = 0; a < d; ++a) diameter += std::pow(at(grid.size() - 1)[a] / unit - at(0)[a] / unit, 2);
    diameter = std::sqrt(diameter) * unit;
  }
  Vec3 at(Index i) const { return grid.position(Vertex(i)); }
  /// A point of the box. The fractions are 0 at vertex 0 and 1 at the last vertex.
  std::vector<double> point(const Vec3& fractions) const {
    std::vector<double> p;
    for (int a = 0; a < d; ++a) p.push_back(at(0)[a] + fractions[a] * (at(grid.size() - 1)[a] - at(0)[a]));
    return p;
  }
  template <class Point>
  void expect_identity(const LogMap& map, const Point& source) const {
    for (Index i = 0; i < grid.size(); ++i) {
      ASSERT_EQ(map.status(Vertex(i)), Status::ok);
      for (int a = 0; a < d; ++a)
        ASSERT_NEAR(map.coordinates(Vertex(i))[a], at(i)[a] - source[a], 1e-11 * diameter) << "vertex " << i;
    }
  }
  GridGraph grid;
  LogMapSolver solver;
  int d;
  double diameter = 0;
};

TEST_P(GridMap, IsTheIdentityFromEveryVertexAndPoint) {
  for (Variant variant : all_variants) {
    for (Index p : {Index{0}, grid.size() / 3, grid.size() / 2, grid.size() - 1})
      expect_identity(solver.solve(Source::at_vertex(Vertex(p)), {.variant = variant}), at(p));
    // In the middle, near and on the border, on a face of a cell, on a vertex.
    for (const Vec3& fractions : {Vec3{0.53, 0.41, 0.37}, {0.001, 1, 0.5}, {0, 0.3, 0}, {1, 1, 1}}) {
      const std::vector<double> p = point(fractions);
      expect_identity(solver.solve(grid.source_at(p), {.variant = variant}), p);
    }
  }
}

TEST_P(GridMap, RotatesWithTheSourceFrame) {
  std::vector<double> axes(d * d, 0.0), zero(d, 0.0);  // x -> y, y -> -x
  axes[d] = 1, axes[1] = -1;
  if (d == 3) axes[8] = 1;
  const Index p = grid.size() / 3;
  const LogMap map = solver.solve(Source(d).add(Vertex(p), 1.0, zero, axes));
  for (Index i = 0; i < grid.size(); ++i) {
    ASSERT_NEAR(map.coordinates(Vertex(i))[0], at(i)[1] - at(p)[1], 1e-11 * diameter);
    ASSERT_NEAR(map.coordinates(Vertex(i))[1], at(p)[0] - at(i)[0], 1e-11 * diameter);
  }
}

TEST_P(GridMap, HasConstantTransportAndTheRadialFieldOfFlatSpace) {
  const std::vector<double> vector{2.0, -1.5, 0.25};
  const auto transported = transport_vectors(solver, std::array{Vertex{3}}, std::span(vector).first(d)),
             frames = parallel_transport(solver, grid.source_at(point({0.4, 0.6, 0.1}))),
             radial = radial_field(solver, Source::at_vertex(Vertex{3}));
  for (Index i = 0; i < grid.size(); ++i) {
    for (int a = 0; a < d; ++a) {
      ASSERT_NEAR(transported.values[i * d + a], vector[a], 1e-11);
      ASSERT_NEAR(radial.values[i * d + a], at(i)[a] - at(3)[a], 1e-11 * diameter);
    }
    for (int k = 0; k < d * d; ++k) ASSERT_NEAR(frames.values[i * d * d + k], k % (d + 1) == 0 ? 1.0 : 0.0, 1e-11);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Grids, GridMap,
    testing::Values(Grid{.shape = {40, 25}, .spacing = {0.1, 0.1}},
                    Grid{.shape = {25, 40}, .spacing = {0.02, 0.05}, .origin = {-3, 8}},
                    Grid{.shape = {30, 30}, .spacing = {1e-200, 2e-200}},
                    Grid{.shape = {2, 30}, .spacing = {1e150, 2e150}}, Grid{.shape = {9, 8, 7}, .spacing = {1, 1, 1}},
                    Grid{.shape = {8, 2, 9}, .spacing = {0.3, 0.2, 0.1}, .origin = {0.1, 0.2, 0.3}}),
    [](const auto& info) { return "grid" + std::to_string(info.index); });

// Conjugate gradients solve the bands of volumes.
TEST(GridMarch, IsTheIdentityInSpace) {
  const GridGraph grid({.shape = {34, 28, 30}, .spacing = {1, 1.3, 0.8}});
  const Vertex p = grid.vertex(std::array<Index, 3>{3, 14, 11});
  const LogMapSolver solver(grid, {.strategy = Strategy::march});
  for (Variant variant : all_variants) {
    const LogMap map = solver.solve(Source::at_vertex(p), {.variant = variant});
    EXPECT_GT(map.march().bands, 3);
    for (Index i = 0; i < grid.size(); ++i)
      for (int a = 0; a < 3; ++a)
        ASSERT_NEAR(map.coordinates(Vertex(i))[a], grid.position(Vertex(i))[a] - grid.position(p)[a], 1e-11 * 50)
            << "vertex " << i;
  }
}

TEST(GridBlocks, HaveTheMapOfRotations) {
  const GridGraph grid({.shape = {25, 40}, .spacing = {0.02, 0.05}});
  const CsrGraph blocks(as_blocks(stored(grid)));
  const LogMapSolver solver(grid), solver_on_blocks(blocks);
  const Source source = grid.source_at(std::array{0.213, 0.77});
  for (Variant variant : all_variants) {
    const LogMap map = solver.solve(source, {.variant = variant}),
                 other = solver_on_blocks.solve(source, {.variant = variant});
    for (std::size_t k = 0; k < map.coordinates().size(); ++k)
      ASSERT_NEAR(map.coordinates()[k], other.coordinates()[k], 1e-11 * 2.0);
  }
}

}  // namespace
}  // namespace ahm::test
