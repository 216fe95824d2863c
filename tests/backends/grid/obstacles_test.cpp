// Obstacles decide what is connected, and change nothing else in the map. Distances and the quality follow the paths around
// them.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ahm/fields/vector_heat.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::test {
namespace {

using grid::Grid;
using grid::GridGraph;

/// A random maze without loops: each room opens to the right or upwards. Corridors are `wide` cells wide between walls one cell
/// thick.
Grid maze(Index rooms, Index wide) {
  const Index step = wide + 1, cells = rooms * step - 1;
  Grid grid{.shape = {cells + 1, cells + 1}, .spacing = {0.1, 0.1}};
  grid.blocked.assign(static_cast<std::size_t>(cells) * cells, 1);
  std::mt19937 random(1);
  for (Index room = 0; room < rooms * rooms; ++room) {
    const Index x0 = room % rooms * step, y0 = room / rooms * step;
    const bool at_right = x0 + wide == cells, at_top = y0 + wide == cells;
    const bool opens_right = !at_right && (at_top || random() % 2 == 0), opens_up = !at_top && !opens_right;
    for (Index y = y0; y < y0 + wide + opens_up; ++y)
      for (Index x = x0; x < x0 + wide + opens_right; ++x) grid.blocked[static_cast<std::size_t>(y) * cells + x] = 0;
  }
  return grid;
}

TEST(GridObstacles, LeaveTheIdentityInAMaze) {
  for (Index wide : {1, 3}) {
    const GridGraph grid(maze(8, wide));
    const LogMapSolver solver(grid);
    const Vec2 p{0.03, 0.07};
    const double diameter = 0.1 * grid.grid().shape[0] * std::sqrt(2.0);
    for (Variant variant : all_variants) {
      const LogMap map = solver.solve(grid.source_at(p), {.variant = variant});
      // Each vertex inside a wall is a component.
      EXPECT_EQ(connected_components(grid).count, 1 + map.count(Status::disconnected));
      for (Index i = 0; i < grid.size(); ++i) {
        ASSERT_EQ(map.status(Vertex(i)), grid.star(i).degree() == 0 ? Status::disconnected : Status::ok);
        for (int a = 0; a < 2 && grid.star(i).degree() > 0; ++a)
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
      for (Index x = 0; x < 8; ++x) box.blocked.push_back(std::min({x, y, z, 7 - x, 7 - y, 7 - z}) == 2);
  const GridGraph grid(box);
  const LogMap map = LogMapSolver(grid).solve(Source::at_vertex(Vertex{0}));
  for (Index i = 0; i < grid.size(); ++i)
    EXPECT_EQ(map.status(Vertex(i)),
              largest(grid.position(Vertex(i)) - Vec3{4, 4, 4}) <= 1 ? Status::disconnected : Status::ok)
        << "vertex " << i;
}

/// Two rooms of 40 x 10 cells above each other, with a door at the far end. Cells are `height` high.
GridGraph two_rooms(double height) {
  Grid rooms{.shape = {41, 22}, .spacing = {1, height}};
  rooms.blocked.assign(40 * 21, 0);
  for (std::size_t x = 0; x < 37; ++x) rooms.blocked[10 * 40 + x] = 1;
  return GridGraph(rooms);
}

TEST(GridObstacles, AreNotCrossedByHeat) {
  // Values extend along paths, not along straight lines through the wall.
  const GridGraph grid = two_rooms(1);
  const auto at = [&](Index x, Index y) { return grid.vertex(std::array{x, y}); };
  const auto field = extend_scalar(LogMapSolver(grid), std::array{at(2, 5), at(25, 16)}, std::array{0.0, 1.0});
  EXPECT_GT(field.values[at(2, 14).index], 0.99);
}

TEST(GridObstacles, LowerTheQualityBehindThem) {
  for (const double height : {1.0, 2.5}) {
    const GridGraph grid = two_rooms(height);
    const auto at = [&](Index x, Index y) { return grid.vertex(std::array{x, y}); };
    const auto quality = map_quality(grid, LogMapSolver(grid).solve(Source::at_vertex(at(2, 5))));
    for (Index y = 0; y <= 21; ++y)
      for (Index x = 0; x <= (y <= 10 ? 40 : 15); ++x)
        if (const double q = quality[at(x, y).index]; y <= 10)
          EXPECT_NEAR(q, 1, 1e-9) << x << " " << y;
        else
          EXPECT_LT(q, reliable_quality) << x << " " << y;
  }
}

/// A box of edge 1 with a wall in its middle, open above three quarters of its height.
struct Wall {
  explicit Wall(Index n, double depth = 1)
      : h(1.0 / n), middle(n / 2 * h), top(3 * n / 4 * h), graph([&] {
          Grid box{.shape = {n + 1, n + 1, n / 2 + 1}, .spacing = {h, h, 2 * h * depth}};
          for (Index z = 0; z < n / 2; ++z)
            for (Index y = 0; y < n; ++y)
              for (Index x = 0; x < n; ++x) box.blocked.push_back(x == n / 2 && y < 3 * n / 4);
          return box;
        }()) {}
  /// Distance from a point in front of the wall: straight, or over one or both edges at the top of the wall.
  double distance(const Vec3& a, const Vec3& b) const {
    const double far = middle + h;
    double in_plane = std::hypot(b[0] - a[0], b[1] - a[1]);
    const auto height_at = [&](double x) { return a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]); };
    if (b[0] > middle && (height_at(middle) < top || (b[0] <= far ? b[1] : height_at(far)) < top))
      in_plane =
          std::hypot(middle - a[0], top - a[1]) +
          (b[1] >= top ? std::hypot(b[0] - middle, b[1] - top) : far - middle + std::hypot(b[0] - far, b[1] - top));
    return std::hypot(in_plane, b[2] - a[2]);
  }
  double h, middle, top;
  GridGraph graph;
};

TEST(GridObstacles, AreGoneAroundInThePlane) {
  // A block on the lower wall. Behind it a path bends by up to a right angle, at one or both of its upper corners.
  for (const Vec2 from : {Vec2{3, 8}, Vec2{7, 8}, Vec2{3, 6}, Vec2{1, 0}}) {
    for (const Index n : {1, 2, 4, 8, 16}) {  // edges per unit
      Grid room{.shape = {12 * n + 1, 8 * n + 1}, .spacing = {1.0 / n, 1.0 / n}};
      for (Index y = 0; y < 8 * n; ++y)
        for (Index x = 0; x < 12 * n; ++x) room.blocked.push_back(x >= 4 * n && x < 8 * n && y < 6 * n);
      const GridGraph graph(room);
      Wavefront front(graph);
      front.add(Source::at_vertex(
          graph.vertex(std::array{static_cast<Index>(from[0] * n), static_cast<Index>(from[1] * n)})));
      front.run();
      const Vec2 corner{8, 6};
      const double to_corner = from[1] >= 6 ? length(corner - from) : length(Vec2{4, 6} - from) + 4;
      double worst = 0;
      for (Index i = 0; i < graph.size(); ++i) {
        const Vec3 at = graph.position(Vertex(i));
        if (graph.star(i).degree() == 0 || at[0] < 8 || at[1] > 6) continue;
        const Vec2 away = Vec2{at[0], at[1]} - corner;
        const double straight = length(corner + away - from);
        const bool is_seen = from[1] >= 6 && cross(corner - from, away) >= 0;
        const double expected = is_seen ? straight : to_corner + length(away);
        ASSERT_GE(front.distance(Vertex(i)), expected * (1 - 1e-12)) << at[0] << " " << at[1];
        worst = std::max(worst, front.distance(Vertex(i)) / expected - 1);
      }
      EXPECT_LT(worst, 0.012 / std::sqrt(n)) << n;  // from squares between both kinds of paths
    }
  }
}

TEST(GridObstacles, AreGoneAroundInSpace) {
  std::vector<double> errors;
  for (const Index n : {12, 24, 48}) {
    const Wall wall(n);
    const Vertex source = wall.graph.vertex(std::array<Index, 3>{n / 4, n / 4, n / 4});
    Wavefront front(wall.graph);
    front.add(Source::at_vertex(source));
    front.run();
    errors.push_back(0);
    for (Index i = 0; i < wall.graph.size(); ++i) {
      if (wall.graph.star(i).degree() == 0) continue;
      const Vec3 at = wall.graph.position(Vertex(i));
      const double error = std::abs(front.distance(Vertex(i)) - wall.distance(wall.graph.position(source), at));
      errors.back() = std::max(errors.back(), error);
      if (at[0] <= wall.middle) ASSERT_LT(error, 1e-12) << i;
    }
  }
  // First order, except for the logarithm of an edge that bends in all directions.
  EXPECT_LT(errors[0], 2.0 / 12);
  EXPECT_LT(errors[1], 0.65 * errors[0]);
  EXPECT_LT(errors[2], 0.65 * errors[1]);
}

TEST(GridObstacles, LowerTheQualityBehindThemInSpace) {
  const Wall wall(16, 0.7);
  const Vertex source = wall.graph.vertex(std::array<Index, 3>{4, 4, 4});
  const auto quality = map_quality(wall.graph, LogMapSolver(wall.graph).solve(Source::at_vertex(source)));
  int behind = 0;
  for (Index i = 0; i < wall.graph.size(); ++i) {
    if (wall.graph.star(i).degree() == 0) continue;
    const Vec3 a = wall.graph.position(source), b = wall.graph.position(Vertex(i));
    if (b[0] <= wall.middle) EXPECT_NEAR(quality[i], 1, 1e-9) << i;
    if (wall.distance(a, b) < 1.2 * distance(a, b) + 2 * wall.h) continue;
    ++behind;
    EXPECT_LT(quality[i], reliable_quality) << i;
  }
  EXPECT_GT(behind, 400);
}

TEST(GridObstacles, LeaveTheGraphOfASmallerGrid) {
  // Blocking the right half leaves the graph of the left half.
  Grid box{.shape = {21, 9}, .spacing = {0.2, 0.3}};
  for (int cell = 0; cell < 20 * 8; ++cell) box.blocked.push_back(cell % 20 >= 10);
  const GridGraph grid(box), half({.shape = {11, 9}, .spacing = {0.2, 0.3}});
  for (Index k = 0; k < half.size(); ++k) {
    const Index i = grid.vertex(std::array{k % 11, k / 11}).index;
    ASSERT_EQ(grid.mass(i), half.mass(k));
    const Star a = half.star(k);
    const std::vector<double> weights(a.weights.begin(), a.weights.end()),
        logs(a.logs.begin(), a.logs.end());  // until the next star
    const Star b = grid.star(i);
    ASSERT_TRUE(std::ranges::equal(weights, b.weights));
    ASSERT_TRUE(std::ranges::equal(logs, b.logs));
  }
  EXPECT_EQ(grid.edge_count(), half.edge_count());
  EXPECT_EQ(grid.mean_edge_length(), half.mean_edge_length());
}

}  // namespace
}  // namespace ahm::test
