// Every allocation fails in turn: the work ends with a typed error or std::bad_alloc, and leaves solvers, files and memory as they were.
#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/io/npz.hpp"
#include "ahm/io/read.hpp"
#include "ahm/io/write.hpp"
#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "failing_allocations.hpp"
#include "folder.hpp"

namespace ahm::test {
namespace {

using Work = std::function<void()>;

/// Outcome of work during which allocations fail.
struct Outcome {
  bool is_done, has_failed;  ///< whether the work ended without an error; whether an allocation failed
};

/// Runs the work while allocation k fails, alone or with all later ones. Only errors for lack of memory are allowed.
Outcome run_failing(const Work& work, long k, bool ever_after) {
  const FailingAllocation failing(k, ever_after);
  bool is_done = false;
  try {
    work();
    is_done = true;
  } catch (const Error&) {
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return {is_done, failing.happened()};
}

/// Whether memory in use grows at each of three runs. Once is allowed: for what is kept.
bool loses_memory(const Work& work) {
  for (int times = 0; times < 3; ++times) {
    const long before = live_blocks();
    work();
    if (live_blocks() <= before) return false;
  }
  return true;
}

/// Runs the work while allocation 1, 2, ... fails, until there are no more.
/// @param check  called after each run
void fail_in_turn(
    const Work& work, const Work& check = [] {}) {
  for (int warm = 0; warm < 2; ++warm) work();  // allocates what is kept, such as tables
  for (const bool ever_after : {false, true}) {
    long failures = 0, errors = 0;
    for (long k = 1;; ++k) {
      const Outcome outcome = run_failing(work, k, ever_after);
      errors += !outcome.is_done;
      failures += outcome.has_failed;
      ASSERT_FALSE(loses_memory([&] { run_failing(work, k, ever_after); })) << "where allocation " << k << " fails";
      check();
      if (!outcome.has_failed) break;
    }
    EXPECT_GT(failures, 10);
    EXPECT_GT(errors, 10);  // not all failures: sorting works with less memory, too
  }
}

trimesh::TriangleMeshSurface square_surface() {
  const Mesh mesh = flat_square(5);
  return trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = 1});
}

TEST(AllocationsFail, WhileAMeshIsBuiltFactoredSolvedAndWritten) {
  const Folder folder{};
  const Mesh mesh = flat_square(5);
  const std::string file = folder.write("map.csv", "precious\n");
  const Work work = [&] {
    const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = 1});
    const LogMapSolver solver(surface.graph(), {.threads = 1});
    const RowLogMap map = surface.to_rows(solver.solve(surface.source(Row(12)).source));
    io::Table table{"map"};
    table.add({"x", "y", "z"}, mesh.positions);
    table.add("distance", map.distance);
    io::write(file, table);
  };
  work();
  const std::string whole = folder.read("map.csv");
  folder.write("map.csv", "precious\n");
  fail_in_turn(work, [&] {
    const std::string text = folder.read("map.csv");
    ASSERT_TRUE(text == "precious\n" || text == whole) << text;
    ASSERT_EQ(folder.files(), 1U);
    folder.write("map.csv", "precious\n");
  });
}

/// After each failure, the solver returns the same maps.
void solve_in_turn(const HeatOptions& options, std::vector<Index> rows = {0, 3, 7, 12, 20, 24}) {
  const auto surface = square_surface();
  const LogMapSolver solver(surface.graph(), options);
  std::vector<Source> sources;
  for (const Index row : rows) sources.push_back(surface.source(Row(row)).source);
  const auto coordinates = [&] {
    std::vector<double> all;
    for (const LogMap& map : solver.solve(sources))
      all.insert(all.end(), map.coordinates().begin(), map.coordinates().end());
    return all;
  };
  const std::vector<double> expected = coordinates();
  fail_in_turn([&] { (void)coordinates(); }, [&] { ASSERT_EQ(coordinates(), expected); });
}

TEST(AllocationsFail, WhileASolverSolves) { solve_in_turn({.threads = 1}); }
TEST(AllocationsFail, WhileASolverMarches) { solve_in_turn({.strategy = Strategy::march, .threads = 1}, {12}); }
TEST(AllocationsFail, OnManyThreads) { solve_in_turn({.threads = 4}); }

TEST(AllocationsFail, WhileOperatorsAreFactoredInAnyOrder) {
  const auto surface = square_surface();
  for (const Ordering ordering : {Ordering::amd, Ordering::nested_dissection})
    fail_in_turn([&] { (void)LogMapSolver(surface.graph(), {.ordering = ordering, .threads = 1}); });
}

TEST(AllocationsFail, WhileACloudIsBuilt) {
  const Cloud cloud = flat_cloud(60);
  const auto weights = [&] {
    const auto surface = pointcloud::PointCloudSurface::build(cloud.points, cloud.normals, {.threads = 1});
    return surface.graph().data().weights;
  };
  const std::vector<double> expected = weights();
  fail_in_turn([&] { ASSERT_EQ(weights(), expected); });
}

TEST(AllocationsFail, WhilePolygonsAreBuilt) {
  const Polygons mesh = l_shapes(2);
  for (const auto how : {polymesh::Discretization::polygons, polymesh::Discretization::refined})
    fail_in_turn([&] {
      (void)polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners,
                                                {.discretization = how, .threads = 1});
    });
}

TEST(AllocationsFail, WhileLocalMapsAreMadeAndWritten) {
  const Folder folder{};
  const auto surface = square_surface();
  LocalMapOptions options{.radius = 0.5};
  options.heat.threads = 1;
  fail_in_turn(
      [&] {
        const LocalMaps maps = local_maps(surface.graph(), options);
        if (!io::has_npz()) return;
        io::NpzFile file(folder.path("maps.npz"));
        file.add("distance", {maps.distances.size()}, maps.distances);
        file.commit();
      },
      [&] {
        ASSERT_LE(folder.files(), 1U);
        std::filesystem::remove(folder.path("maps.npz"));
      });
}

TEST(AllocationsFail, WhileWindowsAreTraced) {
  const auto surface = square_surface();
  fail_in_turn([&] {
    const ExactGeodesics exact(surface);
    (void)exact.log_map(Row(12));
    (void)exact.path(std::array<SurfacePoint, 2>{Row(0), Row(24)});
    (void)exact.locally_shortest_path(Row(0), Row(24));
  });
}

TEST(AllocationsFail, WhileFilesAreRead) {
  const Folder folder{};
  const Mesh mesh = flat_square(3);
  io::Table table{"points"};
  table.add({"x", "y", "z"}, mesh.positions);
  io::write(folder.path("a.ply"), table);
  std::string obj, off = "OFF\n9 8 0\n", stl = "solid s\n", xyz;
  for (const Vec3& p : mesh.positions) {
    const std::string words = std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
    obj += "v " + words, off += words, xyz += words;
  }
  for (const auto& [i, j, k] : mesh.faces) {
    const auto text = [](Index vertex) { return " " + std::to_string(vertex); };
    obj += "f" + text(i + 1) + text(j + 1) + text(k + 1) + "\n", off += "3" + text(i) + text(j) + text(k) + "\n";
    stl += "facet normal 0 0 1\nouter loop\nvertex 0 0" + text(i) + "\nvertex 0 1" + text(j) + "\nvertex 1 1" +
           text(k) + "\nendloop\nendfacet\n";
  }
  folder.write("a.obj", obj), folder.write("a.off", off), folder.write("a.stl", stl + "endsolid s\n"),
      folder.write("a.xyz", xyz);
  for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl", "a.xyz"})
    fail_in_turn([&] { (void)io::read(folder.path(name)); });
}

}  // namespace
}  // namespace ahm::test
