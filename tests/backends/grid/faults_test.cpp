// Grids and points that make no sense are refused with a message that names what is wrong.
#include <gtest/gtest.h>

#include <cmath>

#include "ahm/error.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

using grid::GridGraph;

TEST(GridFaults, NameTheAxis) {
  expect_error<InvalidGeometry>([] { GridGraph({}); }, "0 axes");
  expect_error<InvalidGeometry>([] { GridGraph({.shape = {2, 2, 2, 2}, .spacing = {1, 1, 1, 1}}); }, "4 axes");
  expect_error<InvalidGeometry>([] { GridGraph({.shape = {2, 2}, .spacing = {1}}); }, "'spacing'");
  expect_error<InvalidGeometry>([] { GridGraph({.shape = {2, 2}, .spacing = {1, 1}, .origin = {0}}); }, "'origin'");
  expect_error<InvalidGeometry>([] { GridGraph({.shape = {5, 1}, .spacing = {1, 1}}); }, "axis 1: 1 is too few");
  expect_error<InvalidGeometry>([] { GridGraph({.shape = {5, -3}, .spacing = {1, 1}}); }, "axis 1: -3 is too few");
  for (double spacing : {0.0, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY), 1e308})
    expect_error<InvalidGeometry>([&] { GridGraph({.shape = {5, 5}, .spacing = {1, spacing}}); }, "axis 1: spacing");
  expect_error<InvalidGeometry>([] { GridGraph({.shape = {5, 5}, .spacing = {1, 1}, .origin = {NAN, 0}}); }, "axis 0");
}

TEST(GridFaults, CountCellsAndVertices) {
  expect_error<InvalidGeometry>(
      [] {
        GridGraph({.shape = {3, 4}, .spacing = {1, 1}, .blocked = {0, 0, 1}});
      },
      "3 bytes, the grid has 6 cells");
  expect_error<InvalidGeometry>(
      [] {
        GridGraph({.shape = {3, 2}, .spacing = {1, 1}, .blocked = {1, 1}});
      },
      "all 2 cells");
  expect_error<ResourceExhausted>([] { GridGraph({.shape = {2000, 2000, 2000}, .spacing = {1, 1, 1}}); }, "coarser");
}

TEST(GridFaults, NameThePointOrVertexOutside) {
  const GridGraph grid({.shape = {4, 3}, .spacing = {1, 1}, .origin = {10, 20}, .blocked = {0, 1, 0, 0, 0, 0}});
  expect_error<InvalidArgument>([&] { grid.source_at(std::array{9.9, 20.5}); }, "coordinate 0, 9.9");
  expect_error<InvalidArgument>([&] { grid.source_at(std::array{11.0, 22.1}); }, "coordinate 1, 22.1");
  expect_error<InvalidArgument>([&] { grid.source_at(std::array{11.0, static_cast<double>(NAN)}); }, "coordinate 1");
  expect_error<InvalidArgument>([&] { grid.source_at(std::array{11.0}); }, "2 numbers");
  expect_error<InvalidArgument>([&] { grid.source_at(std::array{11.5, 20.5}); }, "obstacle");
  expect_error<InvalidArgument>([&] { grid.source_at(std::array{11.5, 20.0}); }, "obstacle");
  EXPECT_NO_THROW(grid.source_at(std::array{11.0, 20.5}));  // where a free cell ends
  EXPECT_NO_THROW(grid.source_at(std::array{11.5, 21.0}));
  EXPECT_NO_THROW(grid.source_at(std::array{12.0, 21.0}));
  expect_error<InvalidArgument>([&] { grid.vertex(std::array<Index, 2>{1, 3}); }, "step 3 along axis 1");
  expect_error<InvalidArgument>([&] { grid.vertex(std::array<Index, 3>{1, 1, 1}); }, "2 numbers");
}

}  // namespace
}  // namespace ahm::test
