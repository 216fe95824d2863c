// All parallel code, on sizes for the thread sanitizer: the same bits on any number of threads, and from many threads at once.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <thread>

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/fields/distance.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "cholesky/multifrontal.hpp"

namespace ahm::test {
namespace {

using Numbers = std::vector<double>;

void append(Numbers& all, std::span<const double> more) { all.insert(all.end(), more.begin(), more.end()); }

Numbers numbers_of(const std::vector<LogMap>& maps) {
  Numbers all;
  for (const LogMap& map : maps) append(all, map.coordinates()), append(all, map.distances());
  return all;
}

/// Compares bit by bit, so that NaN equals NaN.
bool same(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

trimesh::TriangleMeshSurface surface_of(const Mesh& mesh, unsigned threads) {
  return trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = threads});
}

std::vector<Source> some_sources(const TangentGraph& graph, Index step) {
  std::vector<Source> sources;
  for (Index i = 0; i < graph.size(); i += step) sources.push_back(Source::at_vertex(Vertex(i)));
  return sources;
}

/// Eight threads compute maps with one solver, one by one and in blocks, several times.
void solve_on_eight_threads(const HeatOptions& options) {
  const auto surface = surface_of(holed_square(20), 1);
  const LogMapSolver solver(surface.graph(), options);
  const std::vector<Source> sources = some_sources(surface.graph(), 50);
  const Numbers expected = numbers_of(solver.solve(sources));
  std::vector<Numbers> expected_alone;  // rounding differs from that of a block
  for (const Source& source : sources) expected_alone.push_back(numbers_of({solver.solve(source)}));
  std::atomic<int> blocks{0}, singles{0};
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t)
      threads.emplace_back([&, t] {
        for (int times = 0; times < 3; ++times) {
          const auto number = static_cast<std::size_t>(t) % sources.size();
          if (!same(numbers_of(solver.solve(sources, {.threads = 1U + static_cast<unsigned>(t) % 3})), expected))
            ++blocks;
          if (!same(numbers_of({solver.solve(sources[number])}), expected_alone[number])) ++singles;
        }
      });
  }
  EXPECT_EQ(blocks, 0);
  EXPECT_EQ(singles, 0);
}

TEST(Threads, EightWithOneSolverComputeTheMapsOfOne) {
  solve_on_eight_threads({});
  solve_on_eight_threads({.variant = Variant::localized});
  solve_on_eight_threads({.strategy = Strategy::march});
}

TEST(Threads, EightFactorizationsAtOnceAreThatOfOne) {
  const auto surface = surface_of(holed_square(20), 1);
  const std::vector<Source> sources = some_sources(surface.graph(), 100);
  const Numbers expected = numbers_of(LogMapSolver(surface.graph(), {.threads = 1}).solve(sources));
  std::atomic<int> wrong{0};
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t)
      threads.emplace_back([&] {
        if (numbers_of(LogMapSolver(surface.graph(), {.threads = 2}).solve(sources)) != expected) ++wrong;
      });
  }
  EXPECT_EQ(wrong, 0);
}

TEST(Threads, BuildTheSameSurfaces) {
  const auto weights = [](unsigned threads) {
    const auto of_mesh = surface_of(torus(2000), threads);
    Numbers all = of_mesh.graph().data().weights;
    const Cloud cloud = flat_cloud(2000);
    const auto of_cloud = pointcloud::PointCloudSurface::build(cloud.points, {}, {.threads = threads});
    append(all, of_cloud.graph().data().weights);
    const Polygons polygons = voronoi_square(300);
    const auto of_polygons =
        polymesh::PolygonMeshSurface::build(polygons.positions, polygons.begin, polygons.corners, {.threads = threads});
    append(all, of_polygons.graph().data().weights);
    return all;
  };
  const Numbers expected = weights(1);
  EXPECT_EQ(weights(2), expected);
  EXPECT_EQ(weights(8), expected);
}

TEST(Threads, MakeTheSameLocalMapsAndPaths) {
  const auto surface = surface_of(holed_square(20), 1);
  const auto numbers = [&](unsigned threads) {
    LocalMapOptions options{.radius = 0.2};
    options.heat.threads = threads;
    const LocalMaps maps = local_maps(surface.graph(), options);
    Numbers all = maps.logs;
    append(all, maps.distances);
    const ExactGeodesics exact(surface);
    std::vector<std::array<SurfacePoint, 2>> pairs;
    for (Index i = 0; i + 40 < static_cast<Index>(surface.positions().size()); i += 20)
      pairs.push_back({Row(i), Row(i + 40)});
    for (const auto& path : exact.paths(pairs, {}, threads)) all.push_back(path.length);
    return all;
  };
  const Numbers expected = numbers(1);
  EXPECT_EQ(numbers(2), expected);
  EXPECT_EQ(numbers(8), expected);
}

/// Loops over vertices have chunks of up to 32,768.
TEST(Threads, ShareMoreVerticesThanOneChunk) {
  const auto numbers = [](unsigned threads) {
    const auto surface = surface_of(torus(40'000), threads);
    validate(surface.graph(), threads);
    Numbers all = surface.graph().data().weights;
    const LogMapSolver solver(surface.graph(), {.strategy = Strategy::march, .threads = threads});
    const LogMap map = solver.solve(Source::at_vertex(Vertex{7}));
    append(all, numbers_of({map}));
    append(all, map_quality(surface.graph(), map, threads));
    const auto of_cloud = pointcloud::PointCloudSurface::build(flat_cloud(12'000).points, {}, {.threads = threads});
    append(all, of_cloud.graph().data().weights);
    return all;
  };
  EXPECT_TRUE(same(numbers(3), numbers(1)));
}

/// The charts of an atlas are computed like this.
TEST(Threads, SolveOnDifferentPatches) {
  const auto surface = surface_of(holed_square(20), 1);
  const std::vector<Source> sources = some_sources(surface.graph(), 40);
  std::vector<Vertex> everything;
  for (Index i = 0; i < surface.graph().size(); ++i) everything.emplace_back(i);
  const std::vector<std::span<const Vertex>> regions(sources.size(), std::span<const Vertex>(everything).first(200));
  const auto numbers = [&](unsigned threads) {
    return local_coordinates(surface.graph(), sources, regions, {.threads = threads});
  };
  EXPECT_TRUE(same(numbers(4), numbers(1)));
}

/// The last block of rows below the columns has a single row.
TEST(Threads, ShareTheRowsOfALargeFront) {
  static constexpr Offset rows = 686, columns = 45;
  ASSERT_TRUE(is_large_front(rows, columns));
  const auto numbers = [](unsigned threads) {
    Numbers L(rows * columns, 0.01), update((rows - columns) * (rows - columns), 0.0);
    for (Offset j = 0; j < columns; ++j) L[j * (rows + 1)] = 2;
    EXPECT_EQ(factor_front<1>(L.data(), rows, columns, update.data(), threads), columns);
    append(update, std::span(L).last(rows));
    return update;
  };
  EXPECT_TRUE(same(numbers(4), numbers(1)));
}

}  // namespace
}  // namespace ahm::test
