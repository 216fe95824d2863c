// Every allocation fails in turn: what was asked for ends in a typed error or std::bad_alloc, and leaves solvers, files and
// memory as they were.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

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

/// Whether the work was done with allocation k failing; false where it ended in an error. Everything else ends the test.
bool survives(const Work& work, long k, bool ever_after, bool& happened) {
  const FailingAllocation failing(k, ever_after);
  bool done = false;
  try {
    work();
    done = true;
  } catch (const Error&) {
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  happened = failing.happened();
  return done;
}

/// Whether memory that lives grows each time, and not once for what is kept.
bool loses_memory(const Work& work) {
  for (int times = 0; times < 3; ++times) {
    const long before = live_blocks();
    work();
    if (live_blocks() <= before) return false;
  }
  return true;
}

/// Work with allocation 1, 2, ... failing, until there are no more of them.
/// @param intact  called after each run
void fail_in_turn(
    const Work& work, const Work& intact = [] {}) {
  for (int warm = 0; warm < 2; ++warm) work();  // what is made once: tables, names of the BLAS
  for (const bool ever_after : {false, true}) {
    long failures = 0, errors = 0;
    bool happened = true;
    for (long k = 1; happened; ++k) {
      errors += survives(work, k, ever_after, happened) ? 0 : 1;
      failures += happened ? 1 : 0;
      ASSERT_FALSE(loses_memory([&] { survives(work, k, ever_after, happened); }))
          << "where allocation " << k << " fails";
      intact();
    }
    EXPECT_GT(failures, 10);
    EXPECT_GT(errors, 10);  // not all: sorting takes less memory where it gets no more
  }
}

TEST(AllocationsFail, WhileAMeshIsBuiltFactoredSolvedAndWritten) {
  const Folder folder;
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

/// A solver serves as before after each failure.
void solve_in_turn(const HeatOptions& options, std::vector<Index> rows = {0, 3, 7, 12, 20, 24}) {
  const Mesh mesh = flat_square(5);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = 1});
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
  const Mesh mesh = flat_square(5);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = 1});
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
  const Folder folder;
  const Mesh mesh = flat_square(5);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = 1});
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
  const Mesh mesh = flat_square(5);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = 1});
  fail_in_turn([&] {
    const ExactGeodesics exact(surface);
    (void)exact.log_map(Row(12));
    (void)exact.path(std::array<SurfacePoint, 2>{Row(0), Row(24)});
    (void)exact.locally_shortest_path(Row(0), Row(24));
  });
}

TEST(AllocationsFail, WhileFilesAreRead) {
  const Folder folder;
  const Mesh mesh = flat_square(3);
  std::string obj, off = "OFF\n9 8 0\n", stl = "solid s\n", xyz;
  for (const Vec3& p : mesh.positions) {
    const std::string words = std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
    obj += "v " + words, off += words, xyz += words;
  }
  for (const Triangle& face : mesh.faces) {
    obj += "f", off += "3", stl += "facet normal 0 0 1\nouter loop\n";
    for (const Index corner : face) {
      obj += " " + std::to_string(corner + 1), off += " " + std::to_string(corner);
      stl += "vertex " + std::to_string(corner) + " 0 1\n";
    }
    obj += "\n", off += "\n", stl += "endloop\nendfacet\n";
  }
  stl += "endsolid s\n";
  io::Table table{"points"};
  table.add({"x", "y", "z"}, mesh.positions);
  io::write(folder.path("a.ply"), table);
  folder.write("a.obj", obj), folder.write("a.off", off), folder.write("a.stl", stl), folder.write("a.xyz", xyz);
  for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl", "a.xyz"})
    fail_in_turn([&] { (void)io::read(folder.path(name)); });
}

}  // namespace
}  // namespace ahm::test
