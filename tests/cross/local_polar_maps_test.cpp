// Local maps by small fronts: parts of whole polar maps, on every backend.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>

#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/error.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/surface/row_local_maps.hpp"
#include "ahm/surface/surface_solver.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "surface/surfaces.hpp"

namespace ahm::test {
namespace {

std::vector<Vertex> some_vertices(const TangentGraph& graph) {
  std::vector<Vertex> vertices;
  for (Index v = 3; v < graph.size(); v += std::max(1, graph.size() / 25)) vertices.emplace_back(v);
  return vertices;
}

/// Checks that the local maps contain what whole maps contain within the radius.
/// @param tolerance  relative to the radius
void expect_parts_of_whole_maps(const PolarMapSolver& solver, double radius, double tolerance) {
  const TangentGraph& graph = solver.graph();
  const std::vector<Vertex> sources = some_vertices(graph);
  const LocalMaps maps = solver.local_maps(sources, {.radius = radius});
  const std::size_t width = maps.transport_width();
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const LogMap whole = solver.log_map(sources[s], {.frames = true});
    std::vector<char> found(to_size(graph.size()), 0);
    for (Offset e = maps.indptr[s]; e < maps.indptr[s + 1]; ++e) {
      const Vertex v = maps.neighbors[e];
      found[v.index] = 1;
      ASSERT_NEAR(maps.distances[e], whole.distance(v), tolerance * radius);
      for (int a : {0, 1}) ASSERT_NEAR(maps.logs[2 * e + a], whole.coordinates(v)[a], tolerance * radius);
      const double* U = whole.frames().data() + 4 * to_size(v.index);
      const double expected[] = {U[0], width == 2 ? U[2] : U[1], U[2], U[3]};
      for (std::size_t k = 0; k < width; ++k) ASSERT_NEAR(maps.transports[to_size(e) * width + k], expected[k], 1e-9);
    }
    EXPECT_EQ(maps.neighbors[maps.indptr[s]], sources[s]);
    EXPECT_TRUE(std::is_sorted(maps.distances.begin() + maps.indptr[s], maps.distances.begin() + maps.indptr[s + 1]));
    for (Vertex v(0); v.index < graph.size(); ++v.index) {
      const double d = whole.status(v) == Status::ok ? whole.distance(v) : INFINITY;
      if (std::abs(d - radius) > 1e-9 * radius) ASSERT_EQ(found[v.index] != 0, d < radius) << sources[s].index;
    }
  }
}

double edge_of(const TangentGraph& graph) { return graph.mean_edge_length() * graph.length_unit(); }

pointcloud::PointCloudSurface noisy_cloud(const Mesh& mesh, double noise) {
  std::vector<Vec3> points = mesh.positions;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, noise);
  for (Vec3& p : points) p = p + Vec3{normal(random), normal(random), normal(random)};
  return pointcloud::PointCloudSurface::build(points, {}, {.smooth = 0});
}

TEST(LocalPolarMaps, ArePartsOfWholeMapsOnMeshes) {
  for (const Mesh& mesh : {icosphere(12), torus(1500), holed_square(24), folded_strip(16), moebius_mesh(60, 9),
                           joined(icosphere(5), torus(300), {5, 0, 0})}) {
    const auto surface = surface_of(mesh);
    for (const Offset windows : {Offset{0}, Offset{1} << 17}) {
      const PolarMapSolver solver(surface, {.windows = windows});
      for (const double radius : {0.3, 1.2, 4.5})
        expect_parts_of_whole_maps(solver, radius * edge_of(surface.graph()), 1e-12);
    }
  }
}

TEST(LocalPolarMaps, ArePartsOfWholeMapsOnPolygonsAndGrids) {
  const auto polygons = surface_of(voronoi_square(300));
  expect_parts_of_whole_maps(PolarMapSolver(polygons), 3 * edge_of(polygons.graph()), 1e-12);
  const grid::GridGraph grid({.shape = {23, 17}, .spacing = {0.5, 0.4}});
  expect_parts_of_whole_maps(PolarMapSolver(grid), 1.7, 1e-12);
  const CsrGraph mirrored(planar_triangulation(15, TransportKind::block, true).data);
  expect_parts_of_whole_maps(PolarMapSolver(mirrored), 0.3, 1e-12);
}

TEST(LocalPolarMaps, ArePartsOfWholeMapsOnClouds) {
  const auto clean = pointcloud::PointCloudSurface::build(torus(1500).positions);
  expect_parts_of_whole_maps(PolarMapSolver(clean), 4 * edge_of(clean.graph()), 1e-12);
  // Where points have no triangles, fronts continue from the windows.
  const auto noisy = noisy_cloud(torus(1500), 0.3 * edge_of(clean.graph()));
  expect_parts_of_whole_maps(PolarMapSolver(noisy), 4 * edge_of(noisy.graph()), 1e-12);
  expect_parts_of_whole_maps(PolarMapSolver(noisy, {.windows = 0}), 4 * edge_of(noisy.graph()), 1e-12);
}

/// Qualities of local and whole maps at vertices whose neighbors the local map contains. Local maps have no other edges.
std::vector<std::array<double, 2>> qualities(const PolarMapSolver& solver, double radius) {
  const TangentGraph& graph = solver.graph();
  const std::vector<Vertex> sources = some_vertices(graph);
  const LocalMaps maps = solver.local_maps(sources, {.radius = radius, .quality = true});
  std::vector<std::array<double, 2>> result;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const std::vector<double> whole = map_quality(graph, solver.log_map(sources[s]));
    const auto first = maps.neighbors.begin() + maps.indptr[s], last = maps.neighbors.begin() + maps.indptr[s + 1];
    for (auto at = first; at != last; ++at)
      if (std::ranges::all_of(graph.star(at->index).neighbors,
                              [&](Index j) { return std::find(first, last, Vertex(j)) != last; }))
        result.push_back({maps.quality[to_size(at - maps.neighbors.begin())], whole[at->index]});
  }
  return result;
}

TEST(LocalPolarMaps, HaveTheQualityOfWholeMaps) {
  // The long tube of this torus is thinner than the radius, so maps contain cut loci.
  const auto mesh = surface_of(torus(1500));
  Index doubtful = 0;
  for (const Offset windows : {Offset{0}, Offset{1} << 17})
    for (const auto& [local, whole] : qualities(PolarMapSolver(mesh, {.windows = windows}), 1.8)) {
      ASSERT_NEAR(local, whole, 1e-9);
      doubtful += whole < reliable_quality;
    }
  EXPECT_GT(doubtful, 50);
  const auto clean = pointcloud::PointCloudSurface::build(torus(1500).positions);
  const auto noisy = noisy_cloud(torus(1500), 0.3 * edge_of(clean.graph()));
  for (const TangentGraph* graph : {&clean.graph(), &noisy.graph()}) {
    const PolarMapSolver solver(graph == &clean.graph() ? clean : noisy);
    const auto found = qualities(solver, 5 * edge_of(*graph));
    EXPECT_GT(found.size(), 200u);
    for (const auto& [local, whole] : found) ASSERT_NEAR(local, whole, 1e-9);
  }
  EXPECT_TRUE(PolarMapSolver(mesh).local_maps(some_vertices(mesh.graph()), {.radius = 0.5}).quality.empty());
}

TEST(LocalMaps, ContainEveryCopyOfAPoint) {
  std::vector<Vec3> points = torus(600).positions;
  const auto plain = pointcloud::PointCloudSurface::build(points);
  const std::size_t n = points.size();
  for (std::size_t k = 0; k < n; k += 7) points.push_back(points[k]);
  const auto copied = pointcloud::PointCloudSurface::build(points);
  ASSERT_EQ(copied.graph().size(), plain.graph().size());
  const double radius = 3 * edge_of(plain.graph());
  for (const Method method : {Method::polar, Method::heat}) {
    const RowLocalMaps single = row_local_maps(plain, {.radius = radius, .method = method}),
                       maps = row_local_maps(copied, {.radius = radius, .method = method});
    const auto original = [&](Row row) {
      return to_size(row.index) < n ? to_size(row.index) : 7 * (to_size(row.index) - n);
    };
    for (std::size_t r = 0; r < points.size(); ++r) {
      const std::size_t s = original(Row(static_cast<Index>(r)));
      EXPECT_EQ(maps.neighbors[to_size(maps.indptr[r])], Row(static_cast<Index>(r)));
      std::map<std::size_t, double> expected, found;
      for (Offset e = single.indptr[s]; e < single.indptr[s + 1]; ++e)
        expected[to_size(single.neighbors[e].index)] = single.weights[e];
      Offset copies = 0;
      for (Offset e = maps.indptr[r]; e < maps.indptr[r + 1]; ++e) {
        copies += to_size(maps.neighbors[e].index) >= n;
        found[original(maps.neighbors[e])] += maps.weights[e];
      }
      ASSERT_EQ(found.size(), expected.size());
      for (const auto& [row, weight] : expected) ASSERT_NEAR(found[row], weight, 1e-12);
      EXPECT_EQ(copies, std::ranges::count_if(expected, [](const auto& one) { return one.first % 7 == 0; }));
    }
    const RowLocalMaps nearest = row_local_maps(copied, {.k = 5, .method = method});
    for (std::size_t r = 0; r < points.size(); ++r) EXPECT_EQ(nearest.indptr[r + 1] - nearest.indptr[r], 5);
    const std::array<SurfacePoint, 1> last{Row(static_cast<Index>(points.size()) - 1)};
    EXPECT_EQ(row_local_maps(copied, last, {.k = 5, .method = method}).neighbors[0], std::get<Row>(last[0]));
  }
}

TEST(LocalPolarMaps, AreExactOnPlanes) {
  Mesh mesh = flat_square(21);
  const auto surface = surface_of(mesh);
  const std::vector<SurfacePoint> sources{Row(7), Row(200), FacePoint{40, {0.2, 0.3, 0.5}},
                                          EdgePoint{Row(0), Row(1), 0.4}};
  const Vec3 axis{0.3, 0.8, 0.1};
  const double radius = 0.23;
  const LocalMaps maps = PolarMapSolver(surface).local_maps(sources, {.radius = radius}, axis);
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const SurfaceSource from = surface.source(sources[s], axis);
    Index expected = 0;
    for (const Vec3& p : mesh.positions) expected += distance(p, from.position) <= radius;
    EXPECT_EQ(maps.indptr[s + 1] - maps.indptr[s], expected);
    for (Offset e = maps.indptr[s]; e < maps.indptr[s + 1]; ++e) {
      const Frame there = *surface.graph().frame(maps.neighbors[e].index);
      const Vec3 d = there.origin - from.position;
      EXPECT_NEAR(maps.logs[2 * e], dot(d, from.frame->x), 1e-12);
      EXPECT_NEAR(maps.logs[2 * e + 1], dot(d, from.frame->y), 1e-12);
      // The transport maps the u axis of the source to the same vector of space.
      EXPECT_NEAR(maps.transports[2 * e], dot(from.frame->x, there.x), 1e-12);
      EXPECT_NEAR(maps.transports[2 * e + 1], dot(from.frame->x, there.y), 1e-12);
    }
  }
}

TEST(LocalPolarMaps, HaveTheOrientationOfFronts) {
  const auto surface = surface_of(moebius_mesh(60, 9));
  const std::vector<Vertex> sources = some_vertices(surface.graph());
  const LocalMapOptions options{.radius = 6 * edge_of(surface.graph())};
  const LocalMaps windows = PolarMapSolver(surface).local_maps(sources, options),
                  fronts = PolarMapSolver(surface, {.windows = 0}).local_maps(sources, options);
  const auto mirrored = [](const LocalMaps& maps, std::size_t s) {
    std::map<Vertex, bool> result;
    for (Offset e = maps.indptr[s]; e < maps.indptr[s + 1]; ++e) {
      const double* U = maps.transports.data() + 4 * e;
      result[maps.neighbors[e]] = U[0] * U[3] < U[1] * U[2];
    }
    return result;
  };
  Index reflections = 0;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const auto other = mirrored(fronts, s);
    for (const auto& [vertex, is_mirrored] : mirrored(windows, s)) {
      reflections += is_mirrored;
      if (const auto found = other.find(vertex); found != other.end()) EXPECT_EQ(is_mirrored, found->second);
    }
  }
  EXPECT_GT(reflections, 20);
}

TEST(LocalPolarMaps, DoNotDependOnThreads) {
  const auto cloud = noisy_cloud(torus(1500), 0.02);
  const PolarMapSolver solver(cloud);
  std::vector<Vertex> sources;
  for (Index v = 0; v < cloud.graph().size(); ++v) sources.emplace_back(v);
  const LocalMaps one = solver.local_maps(sources, {.k = 20, .heat = {.threads = 1}}),
                  many = solver.local_maps(sources, {.k = 20, .heat = {.threads = 3}});
  EXPECT_EQ(one.indptr, many.indptr);
  EXPECT_EQ(one.neighbors, many.neighbors);
  EXPECT_EQ(one.logs, many.logs);
  EXPECT_EQ(one.distances, many.distances);
  EXPECT_EQ(one.transports, many.transports);
  for (const Index s : {0, 700}) {  // nor on the sources before
    const Vertex alone(s);
    const LocalMaps map = solver.local_maps(std::span(&alone, 1), {.k = 20});
    EXPECT_TRUE(std::ranges::equal(map.logs, std::span(one.logs).subspan(to_size(2 * one.indptr[s]), map.logs.size())));
  }
}

TEST(LocalPolarMaps, OfTheNearestAreTheFirstOfALargeRadius) {
  const auto mesh = surface_of(joined(torus(1500), icosphere(1), {50, 0, 0}));
  const auto cloud = noisy_cloud(torus(1500), 0.02), very_noisy = noisy_cloud(torus(1500), 0.1);
  for (const Surface* surface : std::initializer_list<const Surface*>{&mesh, &cloud, &very_noisy}) {
    const PolarMapSolver solver(*surface);
    const std::vector<Vertex> sources = some_vertices(surface->graph());
    for (const bool bound : {false, true}) {
      const LocalMaps all = solver.local_maps(
                          sources, {.radius = 12 * edge_of(surface->graph()), .bound_by_straight_line = bound}),
                      few = solver.local_maps(sources, {.k = 30, .bound_by_straight_line = bound});
      for (std::size_t s = 0; s < sources.size(); ++s) {
        const Offset size = few.indptr[s + 1] - few.indptr[s];
        ASSERT_EQ(size, std::min<Offset>(30, all.indptr[s + 1] - all.indptr[s]));
        for (Offset k = 0; k < size; ++k)
          ASSERT_NEAR(few.distances[few.indptr[s] + k], all.distances[all.indptr[s] + k], 1e-9);
      }
    }
  }
}

TEST(LocalMaps, ContainOnlyVerticesThatMayBeNeighbors) {
  // A third of the vertices. Within a radius they are the entries of all restricted; by number, the first of these.
  const auto surface = surface_of(joined(torus(1500), icosphere(1), {50, 0, 0}));
  const TangentGraph& graph = surface.graph();
  const PolarMapSolver solver(surface);
  const std::vector<Vertex> sources = some_vertices(graph);
  const double radius = 10 * edge_of(graph);
  const auto is_neighbor = [](Vertex v) { return v.index % 3 == 0; };
  for (const Method method : {Method::polar, Method::heat}) {
    const auto maps_of = [&](const LocalMapOptions& o) {
      return method == Method::polar ? solver.local_maps(sources, o) : local_maps(graph, sources, o);
    };
    const LocalMaps all = maps_of({.radius = radius}), some = maps_of({.radius = radius, .is_neighbor = is_neighbor});
    for (const LocalMaps& few : {maps_of({.k = 20, .is_neighbor = is_neighbor}),
                                 maps_of({.radius = radius, .k = 20, .is_neighbor = is_neighbor})})
      for (std::size_t s = 0; s < sources.size(); ++s) {
        Offset k = some.indptr[s], first = few.indptr[s];
        for (Offset e = all.indptr[s]; e < all.indptr[s + 1]; ++e) {
          if (!is_neighbor(all.neighbors[e])) continue;
          ASSERT_EQ(some.neighbors[k], all.neighbors[e]);
          ASSERT_EQ(some.distances[k], all.distances[e]);
          ASSERT_EQ(some.logs[2 * k + 1], all.logs[2 * e + 1]);
          if (first < few.indptr[s + 1]) {
            ASSERT_EQ(few.neighbors[first], all.neighbors[e]);
            ASSERT_NEAR(few.logs[2 * first + 1], all.logs[2 * e + 1], method == Method::polar ? 0 : 1e-3 * radius);
            ++first;
          }
          ++k;
        }
        ASSERT_EQ(k, some.indptr[s + 1]);
        ASSERT_EQ(first, few.indptr[s + 1]);
        ASSERT_EQ(first - few.indptr[s], std::min<Offset>(20, k - some.indptr[s]));
      }
  }
}

TEST(RowLocalMaps, HaveAMethod) {
  const auto polygons = surface_of(quad_grid(8));
  const auto rows = row_local_maps(polygons, {.k = 9});  // polar: exact on the plane
  ASSERT_EQ(rows.sources(), polygons.rows().row_count());
  const std::vector<Vec3> positions(polygons.positions().begin(), polygons.positions().end());
  for (std::size_t s = 0; s < positions.size(); ++s) {
    ASSERT_EQ(rows.indptr[s + 1] - rows.indptr[s], 9);
    for (Offset e = rows.indptr[s]; e < rows.indptr[s + 1]; ++e)
      EXPECT_NEAR(rows.distances[e], distance(positions[s], positions[rows.neighbors[e].index]), 1e-12);
  }
  const auto sphere = surface_of(icosphere(8));
  const double radius = 3 * edge_of(sphere.graph());
  const SurfaceSolver by_default(sphere), by_heat(sphere, HeatOptions{});
  EXPECT_EQ(by_default.local_maps({.radius = radius}).logs, row_local_maps(sphere, {.radius = radius}).logs);
  EXPECT_EQ(by_heat.local_maps({.radius = radius}).logs,
            row_local_maps(sphere, {.radius = radius, .method = Method::heat}).logs);
  EXPECT_EQ(by_heat.local_maps({.radius = radius, .method = Method::polar}).logs,
            by_default.local_maps({.radius = radius}).logs);
}

TEST(LocalPolarMaps, RefuseInvalidArguments) {
  const auto surface = surface_of(icosphere(3));
  const PolarMapSolver solver(surface), of_graph(surface.graph());
  const std::vector<Vertex> sources{Vertex(0)}, outside{Vertex(9999)};
  for (const LocalMapOptions& options : {LocalMapOptions{},
                                         {.radius = -1},
                                         {.radius = NAN},
                                         {.radius = INFINITY},
                                         {.radius = 1, .k = -1},
                                         {.radius = 1, .method = Method::heat}})
    EXPECT_THROW(solver.local_maps(sources, options), InvalidArgument);
  EXPECT_THROW(solver.local_maps(outside, {.radius = 1}), InvalidArgument);
  EXPECT_THROW(of_graph.local_maps(std::vector<SurfacePoint>{Row(0)}, {.radius = 1}), InvalidArgument);
  EXPECT_THROW(row_local_maps(of_graph, {.radius = 1}), InvalidArgument);
  EXPECT_THROW(row_local_maps(surface, {.radius = 1, .method = Method::exact}), InvalidArgument);
  EXPECT_THROW(local_maps(surface.graph(), {.radius = 1, .method = Method::polar}), InvalidArgument);
  LocalMapOptions small{.radius = 10, .memory = 1000};
  EXPECT_THROW(solver.local_maps(some_vertices(surface.graph()), small), ResourceExhausted);
  EXPECT_TRUE(solver.local_maps(std::vector<Vertex>{}, {.radius = 1}).neighbors.empty());
  // Curves have no directions.
  Source curve(2);
  const double axes[] = {1, 0, 0, 1};
  curve.add(Vertex(0), 1, std::array{0.0, 0.0}, axes, {});
  EXPECT_THROW(local_polar_maps(surface.graph(), std::span(&curve, 1), {.radius = 1}, {}), InvalidArgument);
  const CsrGraph volume(lattice3(4).data);
  const Source corner = Source::at_vertex(Vertex(0));
  EXPECT_THROW(local_polar_maps(volume, std::span(&corner, 1), {.radius = 1}, {}), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
