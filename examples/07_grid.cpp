// The beacon nearest by walking distance, of three in a building of two rooms; then a log map in a voxel grid.
#include <ahm/fields/vector_heat.hpp>
#include <ahm/grid/grid_graph.hpp>
#include <array>
#include <cmath>
#include <cstdio>

int main() {
  // 40 x 20 cells of 10 cm. A wall has a door at its right end.
  ahm::grid::Grid building{.shape = {41, 21}, .spacing = {0.1, 0.1}};
  building.blocked.assign(40 * 20, 0);
  for (int x = 0; x < 36; ++x) building.blocked[10 * 40 + x] = 1;
  const ahm::grid::GridGraph plan(building);
  const ahm::LogMapSolver plan_solver(plan);
  const auto at = [&](ahm::Index x, ahm::Index y) { return plan.vertex(std::array{x, y}); };
  const std::array beacons{at(2, 5), at(38, 3), at(20, 18)};
  const auto nearest = ahm::extend_scalar(plan_solver, beacons, std::array{0.0, 1.0, 2.0});
  const double here = nearest.values[at(2, 15).index];
  std::printf("beacon 0 is just behind the wall, but the nearest on foot is beacon %.0f\n", here);

  // In space the log map is the position relative to the source, here from inside a cell.
  const ahm::grid::GridGraph voxels({.shape = {12, 10, 8}, .spacing = {0.5, 0.5, 1.0}});
  const ahm::LogMap map = ahm::LogMapSolver(voxels).solve(voxels.source_at(std::array{1.2, 3.4, 5.6}));
  const auto phi = map.coordinates(voxels.vertex(std::array<ahm::Index, 3>{10, 9, 0}));
  std::printf("voxel (10, 9, 0) lies at %.3f, %.3f, %.3f\n", phi[0], phi[1], phi[2]);
  return std::abs(here - 2) < 0.01 && std::hypot(phi[0] - 3.8, phi[1] - 1.1, phi[2] + 5.6) < 1e-9 ? 0 : 1;
}
