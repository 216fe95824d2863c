// Grids in two and three dimensions: refused arguments, the finite volume Laplacian, and the map, which is the position relative
// to the source.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ahm/error.hpp"
#include "ahm/fields/vector_heat.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

using grid::Grid;
using grid::GridGraph;

TEST(GridFaults, AreNamed) {
  std::vector<std::pair<Grid, const char*>> cases{
      {{}, "0 axes"},
      {{.shape = {2, 2, 2, 2}, .spacing = {1, 1, 1, 1}}, "4 axes"},
      {{.shape = {2, 2}, .spacing = {1}}, "'spacing'"},
      {{.shape = {2, 2}, .spacing = {1, 1}, .origin = {0}}, "'origin'"},
      {{.shape = {5, 1}, .spacing = {1, 1}}, "axis 1: 1 is too few"},
      {{.shape = {5, -3}, .spacing = {1, 1}}, "axis 1: -3 is too few"},
      {{.shape = {5, 5}, .spacing = {1, 1}, .origin = {NAN, 0}}, "axis 0"},
      {{.shape = {3, 4}, .spacing = {1, 1}, .blocked = {0, 0, 1}}, "3 bytes, the grid has 6 cells"},
      {{.shape = {3, 2}, .spacing = {1, 1}, .blocked = {1, 1}}, "all 2 cells"}};
  for (double spacing : {0.0, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY), 1e308})
    cases.push_back({{.shape = {5, 5}, .spacing = {1, spacing}}, "axis 1: spacing"});
  for (const auto& [grid, text] : cases) expect_error<InvalidGeometry>([&, &grid = grid] { GridGraph{grid}; }, text);
  expect_error<ResourceExhausted>([] { GridGraph({.shape = {2000, 2000, 2000}, .spacing = {1, 1, 1}}); }, "coarser");
}

TEST(GridFaults, OfPointsAndVerticesAreNamed) {
  const GridGraph grid({.shape = {4, 3}, .spacing = {1, 1}, .origin = {10, 20}, .blocked = {0, 1, 0, 0, 0, 0}});
  const std::pair<std::vector<double>, const char*> points[] = {
      {{9.9, 20.5}, "coordinate 0, 9.9"}, {{11.0, 22.1}, "coordinate 1, 22.1"},
      {{11.0, NAN}, "coordinate 1"},      {{11.0}, "2 numbers"},
      {{11.5, 20.5}, "obstacle"},         {{11.5, 20.0}, "obstacle"}};
  for (const auto& [point, text] : points)
    expect_error<InvalidArgument>([&, &point = point] { grid.source_at(point); }, text);
  for (const Vec2& border : {Vec2{11.0, 20.5}, {11.5, 21.0}, {12.0, 21.0}}) EXPECT_NO_THROW(grid.source_at(border));
  expect_error<InvalidArgument>([&] { grid.vertex(std::array<Index, 2>{1, 3}); }, "step 3 along axis 1");
  expect_error<InvalidArgument>([&] { grid.vertex(std::array<Index, 3>{1, 1, 1}); }, "2 numbers");
}

TEST(GridLaplacian, HasTheVolumeOfTheFreeCellsAsItsMass) {
  for (int d : {2, 3}) {
    Grid box{.shape = {7, 5, 4}, .spacing = {0.3, 0.7, 0.2}};
    box.shape.resize(d), box.spacing.resize(d);
    const std::size_t cells = d == 2 ? 24 : 72;
    box.blocked.assign(cells, 0);
    box.blocked[8] = box.blocked[15] = 1;
    const GridGraph grid(box);
    double volume = 0;
    for (Index i = 0; i < grid.size(); ++i) volume += grid.mass(i) * std::pow(grid.length_unit(), d);
    EXPECT_NEAR(volume, static_cast<double>(cells - 2) * 0.3 * 0.7 * (d == 3 ? 0.2 : 1), 1e-12);
  }
}

/// -(Laplacian of f) at vertex i in world units: sum_j w_ij (f_i - f_j) / m_i.
template <class Function>
double laplacian(const GridGraph& grid, Index i, const Function& f) {
  const Star star = grid.star(i);
  double sum = 0;
  for (std::size_t e = 0; e < star.degree(); ++e)
    sum += star.weights[e] * (f(grid.position(Vertex(i))) - f(grid.position(Vertex(star.neighbors[e]))));
  return sum / grid.mass(i) / (grid.length_unit() * grid.length_unit());
}

TEST(GridLaplacian, DifferentiatesQuadraticsExactlyInside) {
  const GridGraph grid({.shape = {6, 7, 8}, .spacing = {0.3, 0.7, 0.2}});
  const Index inside = grid.vertex(std::array<Index, 3>{2, 3, 4}).index;
  const auto f = [](const Vec3& p) { return p[0] * p[0] + 3 * p[1] * p[1] - p[2] * p[2]; };
  EXPECT_NEAR(laplacian(grid, inside, f), -6.0, 1e-11);
}

TEST(GridLaplacian, HasTheEigenfunctionsOfABoxWithInsulatedWalls) {
  // cos(pi k x) on n vertices of [0, 1] has the eigenvalue (2 - 2 cos(pi k h)) / h^2 at every vertex, also at corners.
  using std::numbers::pi;
  for (int d : {2, 3}) {
    Grid box{.shape = {11, 21, 6}, .spacing = {0.1, 0.05, 0.2}};
    box.shape.resize(d), box.spacing.resize(d);
    double eigenvalue = 0;
    for (int a = 0; a < d; ++a)
      eigenvalue += (2 - 2 * std::cos(pi * (a + 1) * box.spacing[a])) / std::pow(box.spacing[a], 2);
    const GridGraph grid(box);
    const auto wave = [&](const Vec3& p) {
      double product = 1;
      for (int a = 0; a < d; ++a) product *= std::cos(pi * (a + 1) * p[a]);
      return product;
    };
    for (Index i = 0; i < grid.size(); ++i)
      ASSERT_NEAR(laplacian(grid, i, wave), eigenvalue * wave(grid.position(Vertex(i))), 1e-10 * eigenvalue);
  }
}

TEST(GridEdges, AreCountedAndMeasured) {
  const GridGraph uneven({.shape = {3, 2}, .spacing = {5, 11}});  // 4 edges of 5, 3 of 11
  EXPECT_DOUBLE_EQ(uneven.mean_edge_length() * uneven.length_unit(), 53.0 / 7);
  for (const std::vector<Index>& shape :
       std::vector<std::vector<Index>>{{2, 2}, {2, 5}, {3, 4}, {2, 2, 2}, {2, 3, 5}, {4, 3, 3}}) {
    const GridGraph grid({.shape = shape, .spacing = std::vector<double>(shape.size(), 1.0)});
    std::size_t edges = 0;
    for (Index i = 0; i < grid.size(); ++i) edges += grid.star(i).degree();
    EXPECT_EQ(grid.edge_count(), static_cast<Offset>(edges));
    EXPECT_DOUBLE_EQ(grid.mean_edge_length() * grid.length_unit(), 1.0);
  }
  // A loop over the vertices would take minutes.
  EXPECT_EQ(GridGraph({.shape = {40'000, 40'000}, .spacing = {1, 1}}).edge_count(), 4 * Offset{40'000} * 39'999);
  EXPECT_EQ(GridGraph({.shape = {1200, 1200, 1200}, .spacing = {1, 1, 1}}).edge_count(),
            6 * Offset{1200} * 1200 * 1199);
}

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

}  // namespace
}  // namespace ahm::test
