// A plate parameterized along a stroke, and its Voronoi cells around farthest points.
#include <ahm/applications/cells.hpp>
#include <ahm/applications/stroke.hpp>
#include <ahm/grid/grid_graph.hpp>
#include <ahm/maps/log_map_solver.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

int main() {
  const ahm::grid::GridGraph plate({.shape = {41, 21}, .spacing = {0.1, 0.1}});
  const ahm::LogMapSolver solver(plate);
  const auto at = [&](ahm::Index x, ahm::Index y) { return plate.vertex(std::array{x, y}); };

  // u: arclength along the stroke, v: signed distance, positive on its left.
  std::vector<ahm::Vertex> path;
  for (ahm::Index x = 5; x <= 35; ++x) path.push_back(at(x, 10));
  const ahm::LogMap map = solver.solve(ahm::stroke_source(plate, path));
  const auto phi = map.coordinates(at(20, 14));
  std::printf("the point lies %.3f along the stroke and %.3f to its left\n", phi[0], phi[1]);

  const auto seeds = ahm::farthest_points(plate, at(0, 0), 4);
  const auto cell = ahm::voronoi_cells(plate, seeds).labels;
  std::printf("vertex (35, 3) belongs to cell %d of %zu\n", static_cast<int>(cell[at(35, 3).index]), seeds.size());
  return std::hypot(phi[0] - 1.5, phi[1] - 0.4) < 1e-9 && cell[seeds[2].index] == 2 ? 0 : 1;
}
