// Mazes, rooms without a door and holes: obstacles decide what is connected, and nothing else about the map.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ahm/fields/vector_heat.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::test {
namespace {

using grid::Grid;
using grid::GridGraph;

/// A maze without loops: corridors `wide` cells wide between walls one cell thick, carved at random.
Grid maze(Index rooms, Index wide, unsigned seed = 1) {
  const Index step = wide + 1, cells = rooms * step - 1;
  Grid grid{.shape = {cells + 1, cells + 1}, .spacing = {0.1, 0.1}};
  grid.blocked.assign(static_cast<std::size_t>(cells) * cells, 1);
  auto open = [&](Index x0, Index y0, Index x1, Index y1) {
    for (Index y = y0; y < y1; ++y)
      for (Index x = x0; x < x1; ++x) grid.blocked[static_cast<std::size_t>(y) * cells + x] = 0;
  };
  std::mt19937 random(seed);
  std::vector<bool> seen(static_cast<std::size_t>(rooms) * rooms, false);
  std::vector<std::array<Index, 2>> path{{0, 0}};
  while (!path.empty()) {
    const auto [x, y] = path.back();
    seen[y * rooms + x] = true;
    open(x * step, y * step, x * step + wide, y * step + wide);
    std::vector<std::array<Index, 2>> next;
    for (const auto& [u, v] : {std::array{x + 1, y}, {x - 1, y}, {x, y + 1}, {x, y - 1}})
      if (u >= 0 && v >= 0 && u < rooms && v < rooms && !seen[v * rooms + u]) next.push_back({u, v});
    if (next.empty()) {
      path.pop_back();
      continue;
    }
    const auto [u, v] = next[random() % next.size()];
    const Index x0 = std::min(x, u) * step, y0 = std::min(y, v) * step;
    open(x0, y0, x0 + wide + (u != x ? step : 0), y0 + wide + (v != y ? step : 0));
    path.push_back({u, v});
  }
  return grid;
}

TEST(GridObstacles, LeaveTheIdentityInAMaze) {
  for (Index wide : {1, 3}) {
    const GridGraph grid(maze(8, wide));
    const LogMapSolver solver(grid);
    const double p[] = {0.03, 0.07}, diameter = 0.1 * grid.grid().shape[0] * std::sqrt(2.0);
    for (Variant variant : all_variants) {
      const LogMap map = solver.solve(grid.source_at(p), {.variant = variant});
      EXPECT_EQ(connected_components(grid).count,
                1 + map.count(Status::disconnected));  // vertices inside walls stand alone
      for (Index i = 0; i < grid.size(); ++i) {
        if (map.status(Vertex(i)) == Status::disconnected) {
          EXPECT_EQ(grid.star(i).degree(), 0u);
          continue;
        }
        ASSERT_EQ(map.status(Vertex(i)), Status::ok);
        for (int a = 0; a < 2; ++a)
          ASSERT_NEAR(map.coordinates(Vertex(i))[a], grid.position(Vertex(i))[a] - p[a], 1e-11 * diameter);
      }
    }
  }
}

TEST(GridObstacles, MaskRoomsWithoutADoor) {
  // A box in a box: the shell between them is blocked.
  Grid box{.shape = {9, 9, 9}, .spacing = {1, 1, 1}};
  for (Index z = 0; z < 8; ++z)
    for (Index y = 0; y < 8; ++y)
      for (Index x = 0; x < 8; ++x) {
        const Index depth = std::min({x, y, z, 7 - x, 7 - y, 7 - z});
        box.blocked.push_back(depth == 2);
      }
  const GridGraph grid(box);
  const LogMap map = LogMapSolver(grid).solve(Source::at_vertex(Vertex{0}));
  for (Index i = 0; i < grid.size(); ++i) {
    const Vec3 p = grid.position(Vertex(i));
    const double from_center = std::max({std::abs(p[0] - 4), std::abs(p[1] - 4), std::abs(p[2] - 4)});
    EXPECT_EQ(map.status(Vertex(i)), from_center <= 1 ? Status::disconnected : Status::ok) << "vertex " << i;
  }
}

TEST(GridObstacles, AreGoneRoundByHeat) {
  // Two rooms with a wall and a door at the far end: what is nearest on foot takes the value, not what is nearest as the
  // crow flies.
  Grid rooms{.shape = {41, 22}, .spacing = {1, 1}};
  rooms.blocked.assign(40 * 21, 0);
  for (std::size_t x = 0; x < 37; ++x) rooms.blocked[10 * 40 + x] = 1;
  const GridGraph grid(rooms);
  const LogMapSolver solver(grid);
  const Vertex below = grid.vertex(std::array<Index, 2>{2, 5}), above = grid.vertex(std::array<Index, 2>{25, 16}),
               here = grid.vertex(std::array<Index, 2>{2, 14});
  const auto field = extend_scalar(solver, std::array{below, above}, std::array{0.0, 1.0});
  EXPECT_GT(field.values[here.index], 0.99);
}

TEST(GridObstacles, AreSeenByTheQuality) {
  for (const double height : {1.0, 2.5}) {
    Grid rooms{.shape = {41, 22}, .spacing = {1, height}};
    rooms.blocked.assign(40 * 21, 0);
    for (std::size_t x = 0; x < 37; ++x) rooms.blocked[10 * 40 + x] = 1;
    const GridGraph grid(rooms);
    const auto at = [&](Index x, Index y) { return static_cast<std::size_t>(grid.vertex(std::array{x, y}).index); };
    const auto quality =
        map_quality(grid, LogMapSolver(grid).solve(Source::at_vertex(grid.vertex(std::array<Index, 2>{2, 5}))));
    for (Index y = 0; y <= 10; ++y)
      for (Index x = 0; x <= 40; ++x) EXPECT_NEAR(quality[at(x, y)], 1, 1e-9) << x << " " << y;
    for (Index y = 11; y <= 21; ++y)
      for (Index x = 0; x <= 15; ++x) EXPECT_LT(quality[at(x, y)], trusted_quality) << x << " " << y;
  }
}

/// A box of edge 1 with a wall through its middle, open above three quarters of its height.
struct Wall {
  explicit Wall(Index n, double depth = 1)
      : h(1.0 / n), middle(n / 2 * h), top(3 * n / 4 * h), graph([&] {
          Grid box{.shape = {n + 1, n + 1, n / 2 + 1}, .spacing = {h, h, 2 * h * depth}};
          for (Index z = 0; z < n / 2; ++z)
            for (Index y = 0; y < n; ++y)
              for (Index x = 0; x < n; ++x) box.blocked.push_back(x == n / 2 && y < 3 * n / 4);
          return box;
        }()) {}
  /// Over the two edges at the top of the wall, or straight.
  double shortest(const Vec3& a, const Vec3& b) const {
    const double far = middle + h;
    double in_plane = std::hypot(b[0] - a[0], b[1] - a[1]);
    if (b[0] > middle) {
      const auto height_at = [&](double x) { return a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]); };
      const double up = std::hypot(middle - a[0], top - a[1]);
      const bool sees_near_edge =
          b[0] <= far ? b[1] >= top : height_at(far) >= top || (b[1] - top) * (far - middle) >= 0;
      const bool is_free =
          b[0] <= far ? height_at(middle) >= top && b[1] >= top : height_at(middle) >= top && height_at(far) >= top;
      if (!is_free)
        in_plane = up + (sees_near_edge && b[1] >= top ? std::hypot(b[0] - middle, b[1] - top)
                                                       : far - middle + std::hypot(b[0] - far, b[1] - top));
    }
    return std::hypot(in_plane, b[2] - a[2]);
  }
  double h, middle, top;
  GridGraph graph;
};

TEST(GridObstacles, AreGoneRoundInSpace) {
  std::vector<double> errors;
  for (const Index n : {12, 24, 48}) {
    const Wall wall(n);
    const Vertex source = wall.graph.vertex(std::array<Index, 3>{n / 4, n / 4, n / 4});
    Wavefront front(wall.graph);
    front.add(Source::at_vertex(source));
    front.run();
    double most = 0;
    for (Index i = 0; i < wall.graph.size(); ++i) {
      if (wall.graph.star(i).degree() == 0) continue;
      const Vec3 at = wall.graph.position(Vertex(i));
      const double exact = wall.shortest(wall.graph.position(source), at);
      most = std::max(most, std::abs(front.distance(Vertex(i)) - exact));
      if (at[0] <= wall.middle) ASSERT_NEAR(front.distance(Vertex(i)), exact, 1e-12) << i;
    }
    errors.push_back(most);
  }
  // First order but for the logarithm of an edge that bends all ways.
  EXPECT_LT(errors[0], 2.0 / 12);
  EXPECT_LT(errors[1], 0.65 * errors[0]);
  EXPECT_LT(errors[2], 0.65 * errors[1]);
}

TEST(GridObstacles, AreSeenInSpaceByTheQuality) {
  const Wall wall(16, 0.7);
  const Vertex source = wall.graph.vertex(std::array<Index, 3>{4, 4, 4});
  const auto quality = map_quality(wall.graph, LogMapSolver(wall.graph).solve(Source::at_vertex(source)));
  int behind = 0;
  for (Index i = 0; i < wall.graph.size(); ++i) {
    if (wall.graph.star(i).degree() == 0) continue;
    const Vec3 a = wall.graph.position(source), b = wall.graph.position(Vertex(i));
    const double straight = distance(a, b), exact = wall.shortest(a, b);
    if (b[0] <= wall.middle) EXPECT_NEAR(quality[i], 1, 1e-9) << i;
    if (exact < 1.2 * straight + 2 * wall.h) continue;
    ++behind;
    EXPECT_LT(quality[i], trusted_quality) << i;
  }
  EXPECT_GT(behind, 400);
}

TEST(GridObstacles, EqualASmallerGridWhereTheyFillTheRest) {
  // Blocking the right half leaves the graph of the left half: same weights, masses and map.
  Grid box{.shape = {21, 9}, .spacing = {0.2, 0.3}};
  for (int cell = 0; cell < 20 * 8; ++cell) box.blocked.push_back(cell % 20 >= 10);
  const GridGraph grid(box), half({.shape = {11, 9}, .spacing = {0.2, 0.3}});
  for (Index y = 0; y < 9; ++y)
    for (Index x = 0; x < 11; ++x) {
      const Index i = grid.vertex(std::array{x, y}).index, k = half.vertex(std::array{x, y}).index;
      ASSERT_EQ(grid.mass(i), half.mass(k));
      const Star a = half.star(k);
      const std::vector<double> weights(a.weights.begin(), a.weights.end()), logs(a.logs.begin(), a.logs.end());
      const Star b = grid.star(i);
      ASSERT_EQ(weights, std::vector<double>(b.weights.begin(), b.weights.end()));
      ASSERT_EQ(logs, std::vector<double>(b.logs.begin(), b.logs.end()));
    }
  EXPECT_EQ(grid.edge_count(), half.edge_count());
  EXPECT_EQ(grid.mean_edge_length(), half.mean_edge_length());
}

}  // namespace
}  // namespace ahm::test
