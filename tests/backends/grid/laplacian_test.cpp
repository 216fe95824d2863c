// The finite volume Laplacian: what a good discretization of a box gives besides exact log maps.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ahm/grid/grid_graph.hpp"

namespace ahm::test {
namespace {

using grid::GridGraph;

/// -(Laplacian of f) at vertex i in world units: sum_j w_ij (f_i - f_j) / m_i.
template <class Function>
double laplacian(const GridGraph& grid, Index i, const Function& f) {
  const Star star = grid.star(i);
  double sum = 0;
  for (std::size_t e = 0; e < star.degree(); ++e)
    sum += star.weights[e] * (f(grid.position(Vertex(i))) - f(grid.position(Vertex(star.neighbors[e]))));
  const double unit = grid.length_unit();
  return sum / grid.mass(i) / (unit * unit);
}

TEST(GridLaplacian, HasTheVolumeOfTheFreeCellsAsItsMass) {
  for (int d : {2, 3}) {
    grid::Grid box{.shape = {7, 5}, .spacing = {0.3, 0.7}};
    double cell = 0.3 * 0.7, cells = 6 * 4;
    if (d == 3) {
      box.shape.push_back(4);
      box.spacing.push_back(0.2);
      cell *= 0.2, cells *= 3;
    }
    box.blocked.assign(static_cast<std::size_t>(cells), 0);
    box.blocked[8] = box.blocked[15] = 1;
    const GridGraph grid(box);
    double volume = 0;
    for (Index i = 0; i < grid.size(); ++i) volume += grid.mass(i) * std::pow(grid.length_unit(), d);
    EXPECT_NEAR(volume, (cells - 2) * cell, 1e-12);
  }
}

TEST(GridLaplacian, DifferentiatesQuadraticsExactlyInside) {
  const GridGraph grid({.shape = {6, 7, 8}, .spacing = {0.3, 0.7, 0.2}});
  const Index inside = grid.vertex(std::array<Index, 3>{2, 3, 4}).index;
  EXPECT_NEAR(laplacian(grid, inside, [](const Vec3& p) { return p[0] * p[0] + 3 * p[1] * p[1] - p[2] * p[2]; }), -6.0,
              1e-11);
}

TEST(GridLaplacian, HasTheEigenfunctionsOfABoxWithInsulatedWalls) {
  // cos(pi k x) on n vertices of [0, 1] has the eigenvalue (2 - 2 cos(pi k h)) / h^2 at every vertex, corners included.
  using std::numbers::pi;
  for (int d : {2, 3}) {
    std::vector<Index> shape{11, 21, 6};
    std::vector<double> spacing{0.1, 0.05, 0.2};
    shape.resize(d), spacing.resize(d);
    double eigenvalue = 0;
    for (int a = 0; a < d; ++a) eigenvalue += (2 - 2 * std::cos(pi * (a + 1) * spacing[a])) / (spacing[a] * spacing[a]);
    const GridGraph grid({.shape = shape, .spacing = spacing});
    auto wave = [&](const Vec3& p) {
      double product = 1;
      for (int a = 0; a < d; ++a) product *= std::cos(pi * (a + 1) * p[a]);
      return product;
    };
    for (Index i = 0; i < grid.size(); ++i)
      ASSERT_NEAR(laplacian(grid, i, wave), eigenvalue * wave(grid.position(Vertex(i))), 1e-10 * eigenvalue);
  }
}

TEST(GridLaplacian, MeasuresTheMeanEdge) {
  const GridGraph grid({.shape = {3, 2}, .spacing = {5, 11}});  // 4 edges of 5, 3 of 11
  EXPECT_DOUBLE_EQ(grid.mean_edge_length() * grid.length_unit(), 53.0 / 7);
}

TEST(GridLaplacian, CountsItsEdgesWithoutLookingAtEachVertex) {
  for (const std::vector<Index>& shape :
       std::vector<std::vector<Index>>{{2, 2}, {2, 5}, {3, 4}, {2, 2, 2}, {2, 3, 5}, {4, 3, 3}}) {
    const std::vector<double> spacing(shape.size(), 1.0);
    const GridGraph grid({.shape = shape, .spacing = spacing});
    std::size_t edges = 0;
    for (Index i = 0; i < grid.size(); ++i) edges += grid.star(i).neighbors.size();
    EXPECT_EQ(grid.edge_count(), static_cast<Offset>(edges));
    EXPECT_DOUBLE_EQ(grid.mean_edge_length() * grid.length_unit(), 1.0);
  }
  // One by one these would take minutes.
  EXPECT_EQ(GridGraph({.shape = {40'000, 40'000}, .spacing = {1, 1}}).edge_count(), 4 * Offset{40'000} * 39'999);
  EXPECT_EQ(GridGraph({.shape = {1200, 1200, 1200}, .spacing = {1, 1, 1}}).edge_count(),
            6 * Offset{1200} * 1200 * 1199);
}

}  // namespace
}  // namespace ahm::test
