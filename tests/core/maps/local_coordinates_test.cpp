// Coordinates of chosen vertices against maps of the whole graph.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/log_map_solver.hpp"

namespace ahm::test {
namespace {

/// Sources all over a graph, and of each the vertices within a radius in its map.
struct Charts {
  Charts(const TangentGraph& graph, const LogMapSolver& solver, Index step, double radius, Variant variant) {
    for (Index v = 0; v < graph.size(); v += step) {
      sources.push_back(Source::at_vertex(Vertex(v)));
      whole.push_back(solver.solve(sources.back(), {.variant = variant}));
      auto& region = vertices.emplace_back();
      for (Index j = 0; j < graph.size(); ++j)
        if (whole.back().distance(Vertex(j)) <= radius) region.emplace_back(j);
    }
    regions.assign(vertices.begin(), vertices.end());
  }
  /// The largest difference of coordinates to the maps of the whole graph.
  double difference(std::span<const double> phi) const {
    double worst = 0;
    std::size_t k = 0;
    for (std::size_t s = 0; s < sources.size(); ++s)
      for (Vertex vertex : vertices[s])
        for (const double x : whole[s].coordinates(vertex)) {
          const double difference = std::abs(phi[k++] - x);
          if (!(difference <= worst)) worst = difference;
        }
    EXPECT_EQ(k, phi.size());
    return worst;
  }

  std::vector<Source> sources;
  std::vector<LogMap> whole;
  std::vector<std::vector<Vertex>> vertices;
  std::vector<std::span<const Vertex>> regions;
};

TEST(LocalCoordinates, AreExactOnFlatGeometryAtAnyMargin) {
  for (const FlatGraph& flat :
       {planar_triangulation(40), planar_triangulation(25, TransportKind::block, true), lattice3(8)}) {
    const CsrGraph graph(flat.data);
    const LogMapSolver solver(graph);
    for (Variant variant : all_variants) {
      const Charts charts(graph, solver, 37, 0.3, variant);
      const auto phi = local_coordinates(graph, charts.sources, charts.regions, {.variant = variant}, 0);
      EXPECT_LT(charts.difference(phi), 1e-10 * flat.diameter());
    }
  }
}

TEST(LocalCoordinates, AreThoseOfTheMapOfTheWholeGraph) {
  const CsrGraph graph(sphere_graph(4000));
  const LogMapSolver solver(graph);
  const double radius = 6 * graph.mean_edge_length();
  for (Variant variant : all_variants) {
    const Charts charts(graph, solver, 97, radius, variant);
    double before = INFINITY;
    for (double margin : {0.0, 4.0, 8.0, 16.0}) {
      const auto phi = local_coordinates(graph, charts.sources, charts.regions, {.variant = variant}, margin);
      const double now = charts.difference(phi);
      EXPECT_LT(now, 0.2 * before) << to_string(variant) << ", margin " << margin;
      before = now;
    }
    EXPECT_LT(before, 1e-11 * radius) << to_string(variant);
  }
}

TEST(LocalCoordinates, ReachTheWholeGraphWhereItIsAsked) {
  const CsrGraph graph(sphere_graph(600));
  const LogMapSolver solver(graph);
  const Charts charts(graph, solver, 299, INFINITY, Variant::adaptive);
  EXPECT_LT(charts.difference(local_coordinates(graph, charts.sources, charts.regions)), 1e-9);
}

TEST(LocalCoordinates, DoNotDependOnThreads) {
  const CsrGraph graph(sphere_graph(2000));
  const Charts charts(graph, LogMapSolver(graph), 41, 5 * graph.mean_edge_length(), Variant::adaptive);
  const auto one = local_coordinates(graph, charts.sources, charts.regions, {.threads = 1});
  EXPECT_EQ(local_coordinates(graph, charts.sources, charts.regions, {.threads = 5}), one);
}

TEST(LocalCoordinates, AreUnknownInOtherComponents) {
  const CsrGraph graph(doubled(sphere_graph(300)));
  const std::vector<Vertex> region{Vertex(0), Vertex(7), Vertex(graph.size() - 1)};
  const std::vector<Source> sources{Source::at_vertex(Vertex(0))};
  const std::vector<std::span<const Vertex>> regions{region};
  const auto phi = local_coordinates(graph, sources, regions);
  ASSERT_EQ(phi.size(), 6u);
  for (const std::size_t k : {0, 1, 2, 3}) EXPECT_TRUE(std::isfinite(phi[k]));
  for (const std::size_t k : {4, 5}) EXPECT_TRUE(std::isnan(phi[k]));
}

TEST(LocalCoordinates, RefuseWhatDoesNotFit) {
  const CsrGraph graph(sphere_graph(300));
  const std::vector<Vertex> region{Vertex(3)}, outside{Vertex(300)};
  const std::vector<Source> sources{Source::at_vertex(Vertex(0))};
  const std::vector<std::span<const Vertex>> regions{region}, beyond{outside};
  EXPECT_THROW(local_coordinates(graph, sources, {}), InvalidArgument);
  EXPECT_THROW(local_coordinates(graph, sources, beyond), InvalidArgument);
  EXPECT_THROW(local_coordinates(graph, sources, regions, {.t_coef = -1}), InvalidArgument);
  EXPECT_THROW(local_coordinates(graph, sources, regions, {}, NAN), InvalidArgument);
  EXPECT_TRUE(local_coordinates(graph, {}, {}).empty());
}

}  // namespace
}  // namespace ahm::test
