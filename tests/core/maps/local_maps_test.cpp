// Batches of local maps against maps of the whole graph.
#include "ahm/maps/local_maps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

std::vector<Vertex> every(Index step, const TangentGraph& graph) {
  std::vector<Vertex> vertices;
  for (Index v = 0; v < graph.size(); v += step) vertices.emplace_back(v);
  return vertices;
}

TEST(LocalMaps, AreExactOnFlatGeometryAndComplete) {
  for (const FlatGraph& flat :
       {planar_triangulation(40), planar_triangulation(25, TransportKind::block, true), lattice3(8)}) {
    const CsrGraph graph(flat.data);
    const double radius = flat.dimension == 2 ? 0.15 : 0.3;
    const std::vector<Vertex> sources = every(7, graph);
    for (Variant variant : all_variants) {
      const LocalMaps maps = local_maps(graph, sources, {.radius = radius, .heat = {.variant = variant}});
      ASSERT_EQ(maps.sources(), static_cast<Index>(sources.size()));
      for (std::size_t s = 0; s < sources.size(); ++s) {
        std::set<Index> found;
        for (Offset e = maps.indptr[s]; e < maps.indptr[s + 1]; ++e) {
          found.insert(maps.neighbors[e].index);
          const std::vector<double> exact = flat.exact(sources[s].index, maps.neighbors[e].index);
          for (int a = 0; a < flat.dimension; ++a)
            ASSERT_NEAR(maps.logs[e * flat.dimension + a], exact[a], 1e-11 * flat.diameter());
          if (e > maps.indptr[s]) ASSERT_GE(maps.distances[e], maps.distances[e - 1]) << "nearest first";
          ASSERT_EQ(maps.weights[e], graph.mass(maps.neighbors[e].index));
        }
        EXPECT_EQ(maps.neighbors[maps.indptr[s]].index, sources[s].index);
        for (Index j = 0; j < flat.size(); ++j) {
          double squared = 0;
          for (double x : flat.exact(sources[s].index, j)) squared += x * x;
          if (std::abs(std::sqrt(squared) - radius) > 1e-9) ASSERT_EQ(found.count(j), std::sqrt(squared) < radius);
        }
      }
    }
  }
}

TEST(LocalMaps, ApproachTheMapOfTheWholeGraphWithTheMargin) {
  const CsrGraph graph(sphere_graph(4000));
  const LogMapSolver solver(graph);
  const std::vector<Vertex> sources = every(97, graph);
  const double h = graph.mean_edge_length(), radius = 4 * h;
  for (Variant variant : all_variants) {
    double before = INFINITY;
    for (double margin : {0.0, 1.5, 3.0}) {
      const LocalMaps maps =
          local_maps(graph, sources, {.radius = radius, .margin = margin, .heat = {.variant = variant}});
      double worst = 0;
      for (std::size_t s = 0; s < sources.size(); ++s) {
        const LogMap whole = solver.solve(Source::at_vertex(sources[s]), {.variant = variant});
        for (Offset e = maps.indptr[s]; e < maps.indptr[s + 1]; ++e)
          for (int a : {0, 1})
            worst = std::max(worst, std::abs(maps.logs[2 * e + a] - whole.coordinates(maps.neighbors[e])[a]));
      }
      EXPECT_LT(worst, 0.5 * before) << to_string(variant) << ", margin " << margin;
      before = worst;
    }
    EXPECT_LT(before, 1e-5 * radius);
  }
}

TEST(LocalMaps, CarryTheSourcesFrame) {
  for (const CsrGraphData& data : {sphere_graph(2000), as_blocks(sphere_graph(2000))}) {
    const CsrGraph graph(data);
    const std::array sources{Vertex{5}};
    const double radius = 5 * graph.mean_edge_length();
    const LocalMaps maps = local_maps(graph, sources, {.radius = radius, .margin = 8});
    const LogMap whole = LogMapSolver(graph).solve(Source::at_vertex(Vertex{5}), {.frames = true});
    const std::size_t width = maps.transport_width();
    for (std::size_t e = 0; e < maps.neighbors.size(); ++e) {
      const double* U = whole.frames().data() + 4 * static_cast<std::size_t>(maps.neighbors[e].index);
      const double expected[] = {U[0], width == 2 ? U[2] : U[1], U[2], U[3]};
      for (std::size_t k = 0; k < width; ++k) ASSERT_NEAR(maps.transports[e * width + k], expected[k], 1e-4);
    }
  }
}

TEST(LocalMaps, DoNotDependOnThreadsOrOnCompany) {
  const CsrGraph graph(sphere_graph(3000));
  const double radius = 4 * graph.mean_edge_length();
  const LocalMaps one = local_maps(graph, {.radius = radius, .heat = {.threads = 1}}),
                  many = local_maps(graph, {.radius = radius, .heat = {.threads = 3}});
  EXPECT_EQ(one.indptr, many.indptr);
  EXPECT_EQ(one.neighbors, many.neighbors);
  EXPECT_EQ(one.logs, many.logs);
  EXPECT_EQ(one.transports, many.transports);
  // A source alone has a patch of its own.
  for (Index s : {0, 1234, 2999}) {
    const LocalMaps alone = local_maps(graph, std::array{Vertex{s}}, {.radius = radius});
    ASSERT_NEAR(alone.neighbors.size(), one.indptr[s + 1] - one.indptr[s], 1);
    for (std::size_t e = 0; e < 20; ++e)
      ASSERT_NEAR(alone.distances[e], one.distances[static_cast<std::size_t>(one.indptr[s]) + e], 1e-3 * radius);
  }
}

TEST(LocalMaps, KeepTheNearest) {
  const FlatGraph flat = planar_triangulation(30);
  const CsrGraph graph(flat.data);
  const std::vector<Vertex> sources = every(50, graph);
  const LocalMaps all = local_maps(graph, sources, {.radius = 0.2}),
                  few = local_maps(graph, sources, {.radius = 0.2, .nearest = 9});
  for (std::size_t s = 0; s < sources.size(); ++s) {
    ASSERT_EQ(few.indptr[s + 1] - few.indptr[s], 9);
    for (Offset k = 0; k < 9; ++k) ASSERT_EQ(few.neighbors[few.indptr[s] + k], all.neighbors[all.indptr[s] + k]);
  }
}

TEST(LocalMaps, TakeSourcesOfAnyKind) {
  const FlatGraph flat = planar_triangulation(30, TransportKind::block);  // frames differ: blocks for simplicity
  const CsrGraph graph(flat.data);
  // Halfway between vertex 400 and a neighbour, in the frame of 400.
  const Star star = graph.star(400);
  const Index other = star.neighbors[0];
  const std::vector<double> e{star.log(0)[0], star.log(0)[1]};
  const auto R = star.transports.first(4);  // R_ji with j = other: frame other -> frame 400; axes in frame other: R^T
  Source source(2);
  source.add(Vertex{400}, 0.5, std::array{-e[0] / 2, -e[1] / 2}, std::array{1.0, 0.0, 0.0, 1.0});
  source.add(Vertex(other), 0.5, std::array{e[0] / 2, e[1] / 2}, std::array{R[0], R[2], R[1], R[3]});
  const LocalMaps maps = local_maps(graph, std::array{source}, {.radius = 0.2});
  ASSERT_GT(maps.neighbors.size(), 20u);
  for (std::size_t k = 0; k < maps.neighbors.size(); ++k)
    for (int a : {0, 1})
      ASSERT_NEAR(maps.logs[2 * k + a], flat.exact(400, maps.neighbors[k].index)[a] - e[a] / 2, 1e-11);
}

TEST(LocalMaps, StayInTheirComponent) {
  const FlatGraph flat = planar_triangulation(12);
  const CsrGraph graph(doubled(flat.data));
  const LocalMaps maps = local_maps(graph, {.radius = 100});
  for (Index s = 0; s < graph.size(); ++s) {
    ASSERT_EQ(maps.indptr[s + 1] - maps.indptr[s], flat.size());
    for (Offset e = maps.indptr[s]; e < maps.indptr[s + 1]; ++e)
      ASSERT_EQ(maps.neighbors[e].index < flat.size(), s < flat.size());
  }
}

TEST(LocalMaps, FindAllNeighboursWhereEdgesGoRoundCorners) {
  // Distances along the edges of a square lattice are up to 41 % too long.
  const CsrGraph graph(tube(60, 60));
  const LocalMaps maps = local_maps(graph, std::array{Vertex(30 * 60 + 30)}, {.radius = 10.5});
  Index expected = 0;
  for (int x = -11; x <= 11; ++x)
    for (int y = -11; y <= 11; ++y) expected += std::hypot(x, y) <= 10.5;
  EXPECT_EQ(static_cast<Index>(maps.neighbors.size()), expected);
}

/// Where they alone would fill the memory, before it is taken.
TEST(LocalMaps, RefuseWhatFillsTheMemory) {
  const CsrGraph graph(sphere_graph(2000));
  LocalMapOptions options{.radius = 10, .memory = 10'000'000};
  EXPECT_THROW(local_maps(graph, options), ResourceExhausted);  // 2000 x 2000 entries
  EXPECT_EQ(local_maps(graph, every(100, graph), options).neighbors.size(), 20u * 2000u);
  options.nearest = 9;
  EXPECT_EQ(local_maps(graph, options).neighbors.size(), 9u * 2000u);
  options.nearest = 0;
  options.radius = 0.1;
  EXPECT_GT(local_maps(graph, options).neighbors.size(), 2000u);
}

TEST(LocalMaps, RefuseNonsense) {
  const CsrGraph graph(sphere_graph(200));
  for (double radius : {0.0, -1.0, double(NAN), double(INFINITY)})
    EXPECT_THROW(local_maps(graph, {.radius = radius}), InvalidArgument);
  EXPECT_THROW(local_maps(graph, {.radius = 1, .nearest = -1}), InvalidArgument);
  EXPECT_THROW(local_maps(graph, {.radius = 1, .heat = {.t_coef = 0}}), InvalidArgument);
  EXPECT_THROW(local_maps(graph, {.radius = 1, .margin = -1}), InvalidArgument);
  EXPECT_THROW(local_maps(graph, std::array{Vertex{200}}, {.radius = 1}), InvalidArgument);
  EXPECT_EQ(local_maps(graph, std::vector<Vertex>{}, {.radius = 1}).indptr, std::vector<Offset>{0});
}

/// Source number s of some local maps.
std::vector<Vertex> neighbors_of(const LocalMaps& maps, std::size_t s) {
  return {maps.neighbors.begin() + maps.indptr[s], maps.neighbors.begin() + maps.indptr[s + 1]};
}

TEST(LocalMaps, OfTheNearestAreThoseOfAWideRadius) {
  for (const CsrGraphData& data : {sphere_graph(1500), planar_triangulation(30).data}) {
    const CsrGraph graph(data);
    constexpr Index nearest = 25;
    const double radius = 8 * graph.mean_edge_length();
    const std::vector<Vertex> sources = every(11, graph);
    const LocalMaps by_number = local_maps(graph, sources, {.nearest = nearest, .margin = 5}),
                    by_radius = local_maps(graph, sources, {.radius = radius, .nearest = nearest, .margin = 5});
    for (std::size_t s = 0; s < sources.size(); ++s) {
      ASSERT_EQ(by_number.indptr[s + 1] - by_number.indptr[s], nearest);
      // Distances alone: ties may be broken otherwise on a patch of another size.
      for (auto e = by_number.indptr[s]; e < by_number.indptr[s + 1]; ++e)
        ASSERT_NEAR(by_number.distances[e], by_radius.distances[e], 1e-6 * radius);
    }
  }
}

TEST(LocalMaps, OfTheNearestHoldThemWhereNoRadiusWould) {
  // A lattice whose spacings grow from 1 to 1000.
  Mesh mesh = flat_square(21, 0);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i] = {std::pow(1000.0, mesh.plane[i][0]), std::pow(1000.0, mesh.plane[i][1]), 0};
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const LocalMaps maps = local_maps(surface.graph(), {.nearest = 12});
  for (std::size_t s = 0; s < mesh.positions.size(); ++s) {
    ASSERT_EQ(maps.indptr[s + 1] - maps.indptr[s], 12);
    std::vector<double> away;
    for (const Vec3& p : mesh.positions)
      away.push_back(std::hypot(p[0] - mesh.positions[s][0], p[1] - mesh.positions[s][1]));
    std::sort(away.begin(), away.end());
    for (std::size_t k = 0; k < 12; ++k)
      ASSERT_NEAR(maps.distances[maps.indptr[s] + static_cast<Offset>(k)], away[k], 1e-8 * away[11]) << s;
  }
}

TEST(LocalMaps, OfTheNearestEndWithTheComponent) {
  const CsrGraph graph(sphere_graph(30));
  const LocalMaps maps = local_maps(graph, {.nearest = 50});
  for (std::size_t s = 0; s < 30; ++s) EXPECT_EQ(neighbors_of(maps, s).size(), 30U);
  EXPECT_THROW(local_maps(graph, LocalMapOptions{}), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
