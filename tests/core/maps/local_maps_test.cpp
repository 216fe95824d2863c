// Batches of local maps and coordinates of selected vertices against maps of the whole graph.
#include "ahm/maps/local_maps.hpp"

#include <set>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "core/solved_graph.hpp"

namespace ahm::test {
namespace {

std::vector<Vertex> every(Index step, const TangentGraph& graph) {
  std::vector<Vertex> vertices;
  for (Index v = 0; v < graph.size(); v += step) vertices.emplace_back(v);
  return vertices;
}

TEST(LocalMaps, AreExactOnFlatGraphsAndComplete) {
  for (const FlatGraph& flat : {planar_triangulation(40), mirrored_plane(25), lattice3(8)}) {
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
          expect_near(std::span(maps.logs).subspan(to_size(e * flat.dimension), to_size(flat.dimension)),
                      flat.exact(sources[s].index, maps.neighbors[e].index), 1e-11 * flat.diameter());
          if (e > maps.indptr[s]) ASSERT_GE(maps.distances[e], maps.distances[e - 1]) << "nearest first";
          ASSERT_EQ(maps.weights[e], graph.mass(maps.neighbors[e].index));
        }
        EXPECT_EQ(maps.neighbors[maps.indptr[s]], sources[s]);
        for (Index j = 0; j < flat.size(); ++j) {
          const double exact = length(flat.exact(sources[s].index, j));
          if (std::abs(exact - radius) > 1e-9) ASSERT_EQ(found.count(j), exact < radius);
        }
      }
    }
  }
}

TEST(LocalMaps, ApproachTheMapOfTheWholeGraphWithTheMargin) {
  const SolvedGraph sphere(sphere_graph(4000));
  const std::vector<Vertex> sources = every(97, sphere.graph);
  const double radius = 4 * sphere.graph.mean_edge_length();
  for (Variant variant : all_variants) {
    double before = INFINITY;
    for (double margin : {0.0, 1.5, 3.0}) {
      const LocalMaps maps =
          local_maps(sphere.graph, sources, {.radius = radius, .margin = margin, .heat = {.variant = variant}});
      double worst = 0;
      for (std::size_t s = 0; s < sources.size(); ++s) {
        const LogMap whole = sphere.map(sources[s].index, {.variant = variant});
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

TEST(LocalMaps, HaveTheFramesAndDistancesOfWholeMaps) {
  for (const CsrGraphData& data : {sphere_graph(2000), as_blocks(sphere_graph(2000))}) {
    const SolvedGraph sphere(data);
    const double radius = 5 * sphere.graph.mean_edge_length();
    const LocalMaps maps = local_maps(sphere.graph, std::array{Vertex{5}}, {.radius = radius, .margin = 8});
    const LogMap whole = sphere.map(5, {.frames = true});
    const std::size_t width = maps.transport_width();
    ASSERT_EQ(maps.neighbors.front(), Vertex{5});
    for (const double x : {maps.distances[0], maps.logs[0], maps.logs[1]}) EXPECT_EQ(x, 0);
    for (std::size_t e = 0; e < maps.neighbors.size(); ++e) {
      const double* U = whole.frames().data() + 4 * to_size(maps.neighbors[e].index);
      const double expected[] = {U[0], width == 2 ? U[2] : U[1], U[2], U[3]};
      expect_near(std::span(maps.transports).subspan(e * width, width), std::span(expected).first(width), 1e-4);
      EXPECT_NEAR(maps.distances[e], whole.distance(maps.neighbors[e]), 1e-4 * radius);
    }
  }
}

TEST(LocalMaps, DoNotDependOnThreadsOrOnOtherSources) {
  const CsrGraph graph(sphere_graph(3000));
  const double radius = 4 * graph.mean_edge_length();
  const LocalMaps one = local_maps(graph, {.radius = radius, .heat = {.threads = 1}}),
                  many = local_maps(graph, {.radius = radius, .heat = {.threads = 3}});
  EXPECT_EQ(one.indptr, many.indptr);
  EXPECT_EQ(one.neighbors, many.neighbors);
  EXPECT_EQ(one.logs, many.logs);
  EXPECT_EQ(one.transports, many.transports);
  for (Index s : {0, 1234, 2999}) {  // a single source is solved on a patch of its own
    const LocalMaps alone = local_maps(graph, std::array{Vertex{s}}, {.radius = radius});
    ASSERT_NEAR(alone.neighbors.size(), one.indptr[s + 1] - one.indptr[s], 1);
    for (std::size_t e = 0; e < 20; ++e)
      ASSERT_NEAR(alone.distances[e], one.distances[to_size(one.indptr[s]) + e], 1e-3 * radius);
  }
}

TEST(LocalMaps, ContainOnlyTheNearest) {
  const CsrGraph graph(planar_triangulation(30).data);
  const std::vector<Vertex> sources = every(50, graph);
  const LocalMaps all = local_maps(graph, sources, {.radius = 0.2}),
                  few = local_maps(graph, sources, {.radius = 0.2, .k = 9});
  for (std::size_t s = 0; s < sources.size(); ++s) {
    ASSERT_EQ(few.indptr[s + 1] - few.indptr[s], 9);
    for (Offset k = 0; k < 9; ++k) ASSERT_EQ(few.neighbors[few.indptr[s] + k], all.neighbors[all.indptr[s] + k]);
  }
}

TEST(LocalMaps, HaveALowQualityNextToTheCutLocus) {
  const CsrGraph plane(planar_triangulation(20).data), sphere(sphere_graph(500));
  for (const double q : local_maps(plane, every(37, plane), {.radius = 0.3, .quality = true}).quality)
    EXPECT_NEAR(q, 1, 1e-9);
  const LocalMaps maps = local_maps(sphere, every(97, sphere), {.radius = 3.5, .quality = true});
  ASSERT_EQ(maps.quality.size(), maps.neighbors.size());
  double lowest = 1;
  for (std::size_t e = 0; e < maps.quality.size(); ++e) {
    EXPECT_GT(maps.quality[e], maps.distances[e] < 1 ? reliable_quality : 0);
    EXPECT_LE(maps.quality[e], 1);
    lowest = std::min(lowest, maps.quality[e]);
  }
  EXPECT_LT(lowest, 0.3);
  EXPECT_TRUE(local_maps(plane, every(37, plane), {.radius = 0.3}).quality.empty());
}

TEST(LocalMaps, TakeSourcesOfAnyKind) {
  const FlatGraph flat = planar_triangulation(30, TransportKind::block);
  const CsrGraph graph(flat.data);
  // Halfway between vertex 400 and a neighbor, in the frame of 400. R maps the neighbor's frame to that frame.
  const Star star = graph.star(400);
  const auto e = star.log(0), R = star.transports.first(4);
  const Source source =
      Source(2)
          .add(Vertex{400}, 0.5, Vec2{-e[0] / 2, -e[1] / 2}, identity)
          .add(Vertex(star.neighbors[0]), 0.5, Vec2{e[0] / 2, e[1] / 2}, std::array{R[0], R[2], R[1], R[3]});
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

TEST(LocalMaps, ContainAllNeighborsWhereEdgePathsHaveCorners) {
  // Edge paths of a square lattice are up to 41 % longer than the distance.
  const CsrGraph graph(tube(60, 60));
  const LocalMaps maps = local_maps(graph, std::array{Vertex(30 * 60 + 30)}, {.radius = 10.5});
  Index expected = 0;
  for (int x = -11; x <= 11; ++x)
    for (int y = -11; y <= 11; ++y) expected += std::hypot(x, y) <= 10.5;
  EXPECT_EQ(static_cast<Index>(maps.neighbors.size()), expected);
}

TEST(LocalMaps, RefuseWhatFillsTheMemory) {
  const CsrGraph graph(sphere_graph(2000));
  LocalMapOptions options{.radius = 10, .memory = 10'000'000};
  EXPECT_THROW(local_maps(graph, options), ResourceExhausted);  // 2000 x 2000 entries
  EXPECT_EQ(local_maps(graph, every(100, graph), options).neighbors.size(), 20u * 2000u);
  options.k = 9;
  EXPECT_EQ(local_maps(graph, options).neighbors.size(), 9u * 2000u);
  options.k = 0;
  options.radius = 0.1;
  EXPECT_GT(local_maps(graph, options).neighbors.size(), 2000u);
}

TEST(LocalMaps, RefuseInvalidArguments) {
  const CsrGraph graph(sphere_graph(200));
  for (const LocalMapOptions& options : {LocalMapOptions{},
                                         {.radius = 0},
                                         {.radius = -1},
                                         {.radius = NAN},
                                         {.radius = INFINITY},
                                         {.radius = 1, .k = -1},
                                         {.radius = 1, .margin = -1},
                                         {.radius = 1, .heat = {.t_coef = 0}}})
    EXPECT_THROW(local_maps(graph, options), InvalidArgument);
  EXPECT_THROW(local_maps(graph, std::array{Vertex{200}}, {.radius = 1}), InvalidArgument);
  EXPECT_EQ(local_maps(graph, std::vector<Vertex>{}, {.radius = 1}).indptr, std::vector<Offset>{0});
}

TEST(LocalMaps, OfTheNearestAreCompleteWhereSpacingsDifferAThousandfold) {
  Mesh mesh = flat_square(21, 0);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i] = {std::pow(1000.0, mesh.plane[i][0]), std::pow(1000.0, mesh.plane[i][1]), 0};
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const LocalMaps maps = local_maps(surface.graph(), {.k = 12});
  for (std::size_t s = 0; s < mesh.positions.size(); ++s) {
    ASSERT_EQ(maps.indptr[s + 1] - maps.indptr[s], 12);
    std::vector<double> exact;
    for (const Vec3& p : mesh.positions) exact.push_back(distance(p, mesh.positions[s]));
    std::ranges::sort(exact);
    expect_near(std::span(maps.distances).subspan(12 * s, 12), std::span(exact).first(12), 1e-8 * exact[11]);
  }
}

TEST(LocalMaps, OfTheNearestEndWithTheComponent) {
  const CsrGraph graph(sphere_graph(30));
  const LocalMaps maps = local_maps(graph, {.k = 50});
  for (std::size_t s = 0; s < 30; ++s) EXPECT_EQ(maps.indptr[s + 1] - maps.indptr[s], 30);
}

/// Sources all over a graph, and for each the vertices within a radius in its map.
struct Regions {
  Regions(const SolvedGraph& solved, Index step, double radius, Variant variant = Variant::adaptive) {
    for (const Vertex source : every(step, solved.graph)) {
      sources.push_back(Source::at_vertex(source));
      whole.push_back(solved.map(sources.back(), {.variant = variant}));
      auto& region = vertices.emplace_back();
      for (Index j = 0; j < solved.graph.size(); ++j)
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

TEST(LocalCoordinates, AreExactOnFlatGraphsForAnyMargin) {
  for (const FlatGraph& flat : {planar_triangulation(40), mirrored_plane(25), lattice3(8)}) {
    const SolvedGraph solved(flat.data);
    for (Variant variant : all_variants) {
      const Regions charts(solved, 37, 0.3, variant);
      const auto phi = local_coordinates(solved.graph, charts.sources, charts.regions, {.variant = variant}, 0);
      EXPECT_LT(charts.difference(phi), 1e-10 * flat.diameter());
    }
  }
}

TEST(LocalCoordinates, AreThoseOfTheMapOfTheWholeGraph) {
  const SolvedGraph sphere(sphere_graph(4000));
  const double radius = 6 * sphere.graph.mean_edge_length();
  for (Variant variant : all_variants) {
    const Regions charts(sphere, 97, radius, variant);
    double before = INFINITY;
    for (double margin : {0.0, 4.0, 8.0, 16.0}) {
      const double now = charts.difference(
          local_coordinates(sphere.graph, charts.sources, charts.regions, {.variant = variant}, margin));
      EXPECT_LT(now, 0.2 * before) << to_string(variant) << ", margin " << margin;
      before = now;
    }
    EXPECT_LT(before, 1e-11 * radius) << to_string(variant);
  }
  const SolvedGraph small(sphere_graph(600));
  const Regions everything(small, 299, INFINITY);
  EXPECT_LT(everything.difference(local_coordinates(small.graph, everything.sources, everything.regions)), 1e-9);
}

TEST(LocalCoordinates, DoNotDependOnThreads) {
  const SolvedGraph sphere(sphere_graph(2000));
  const Regions charts(sphere, 41, 5 * sphere.graph.mean_edge_length());
  const auto one = local_coordinates(sphere.graph, charts.sources, charts.regions, {.threads = 1});
  EXPECT_EQ(local_coordinates(sphere.graph, charts.sources, charts.regions, {.threads = 5}), one);
}

TEST(LocalCoordinates, AreNanInOtherComponents) {
  const CsrGraph graph(doubled(sphere_graph(300)));
  const std::vector<Vertex> region{Vertex(0), Vertex(7), Vertex(graph.size() - 1)};
  const auto phi = local_coordinates(graph, std::array{source_at(0)}, std::array{std::span<const Vertex>(region)});
  ASSERT_EQ(phi.size(), 6u);
  for (const std::size_t k : {0, 1, 2, 3, 4, 5}) EXPECT_EQ(std::isnan(phi[k]), k >= 4);
}

TEST(LocalCoordinates, RefuseInvalidArguments) {
  const CsrGraph graph(sphere_graph(300));
  const std::vector<Vertex> region{Vertex(3)}, outside{Vertex(300)};
  const std::vector<Source> sources{source_at(0)};
  const std::vector<std::span<const Vertex>> regions{region}, outside_regions{outside};
  EXPECT_THROW(local_coordinates(graph, sources, {}), InvalidArgument);
  EXPECT_THROW(local_coordinates(graph, sources, outside_regions), InvalidArgument);
  EXPECT_THROW(local_coordinates(graph, sources, regions, {.t_coef = -1}), InvalidArgument);
  EXPECT_THROW(local_coordinates(graph, sources, regions, {}, NAN), InvalidArgument);
  EXPECT_TRUE(local_coordinates(graph, {}, {}).empty());
}

}  // namespace
}  // namespace ahm::test
