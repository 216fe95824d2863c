// A source's own vertex has the vector and the distance it was given with, and no spread, in every kind of map.
#include <gtest/gtest.h>

#include <array>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"

namespace ahm::test {
namespace {

TEST(SourceVertices, HaveTheVectorZero) {
  const CsrGraph graph(sphere_graph(700));
  for (const Strategy strategy : {Strategy::global, Strategy::march}) {
    const LogMapSolver solver(graph, {.strategy = strategy});
    for (const Variant variant : all_variants) {
      const LogMap map = solver.solve(Source::at_vertex(Vertex{20}), {.variant = variant});
      for (const double x : map.coordinates(Vertex{20})) EXPECT_EQ(x, 0);
      EXPECT_EQ(map.distance(Vertex{20}), 0);
      EXPECT_EQ(map.spread()[20], 0);
      EXPECT_EQ(map_quality(graph, map)[20], 1);
    }
  }
}

TEST(SourceVertices, HaveTheVectorZeroInLocalMaps) {
  const CsrGraph graph(sphere_graph(700));
  const std::array<Source, 2> sources{Source::at_vertex(Vertex{20}), Source::at_vertex(Vertex{400})};
  const LocalMaps maps = local_maps(graph, sources, {.radius = 0.4});
  for (const std::size_t s : {0, 1}) {
    const auto first = static_cast<std::size_t>(maps.indptr[s]);
    EXPECT_EQ(maps.neighbors[first], sources[s].vertices()[0]);
    EXPECT_EQ(maps.distances[first], 0);
    for (const std::size_t a : {0, 1}) EXPECT_EQ(maps.logs[2 * first + a], 0);
  }
}

}  // namespace
}  // namespace ahm::test
