// The published contract, on grids in the plane and in space.
#include "ahm/conformance/graph_contract.hpp"
#include "ahm/grid/grid_graph.hpp"

namespace ahm::test {
namespace {

using grid::GridGraph;

struct PlaneGrids {
  /// Scattered single cells are obstacles.
  static std::unique_ptr<TangentGraph> surface() {
    grid::Grid grid{.shape = {14, 11}, .spacing = {0.3, 0.4}};
    grid.blocked.assign(13 * 10, 0);
    for (std::size_t cell : {16, 22, 47, 71, 74, 110}) grid.blocked[cell] = 1;
    return std::make_unique<GridGraph>(std::move(grid));
  }
  static std::unique_ptr<TangentGraph> flat() {
    return std::make_unique<GridGraph>(grid::Grid{.shape = {20, 15}, .spacing = {1e-3, 2e-3}, .origin = {5, 7}});
  }
};

struct SpaceGrids {
  static std::unique_ptr<TangentGraph> surface() {
    grid::Grid grid{.shape = {6, 5, 4}, .spacing = {1.0, 0.8, 1.3}};
    grid.blocked.assign(5 * 4 * 3, 0);
    for (std::size_t cell : {7, 32, 46}) grid.blocked[cell] = 1;
    return std::make_unique<GridGraph>(std::move(grid));
  }
  static std::unique_ptr<TangentGraph> flat() {
    return std::make_unique<GridGraph>(grid::Grid{.shape = {7, 9, 6}, .spacing = {30, 20, 40}});
  }
};

INSTANTIATE_TYPED_TEST_SUITE_P(Plane, GraphContract, PlaneGrids);
INSTANTIATE_TYPED_TEST_SUITE_P(Space, GraphContract, SpaceGrids);

}  // namespace
}  // namespace ahm::test
