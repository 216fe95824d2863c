// Cancelled at any step of its progress, work ends with Cancelled, and what it stood on serves as before.
#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <stop_token>

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

/// Asks to stop at step number k of its progress.
class StopAt {
 public:
  explicit StopAt(int k) : left_(k) {}
  Progress progress() {
    return {[this](std::string_view, double) {
              if (left_-- == 1) source_.request_stop();
            },
            source_.get_token()};
  }
  bool came() const { return left_ < 1; }

 private:
  std::atomic<int> left_;
  std::stop_source source_;
};

/// Work cancelled at step 1, 2, ..., as long as there are steps; returns their number.
template <class Work>
int cancel_in_turn(const Work& work) {
  for (int k = 1;; ++k) {
    StopAt stop(k);
    bool cancelled = false;
    try {
      work(stop.progress());
    } catch (const Cancelled&) {
      cancelled = true;
    }
    EXPECT_EQ(cancelled, stop.came()) << "at step " << k;
    if (!stop.came()) return k - 1;
  }
}

TEST(Cancellation, AtAnyStepLeavesWhatItStoodOnAsItWas) {
  const Mesh mesh = torus(600);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const LogMapSolver solver(surface.graph()), marching(surface.graph(), {.strategy = Strategy::march});
  std::vector<Source> sources;
  for (Index row = 0; row < 80; ++row) sources.push_back(Source::at_vertex(Vertex(row)));
  const auto numbers = [&](const LogMapSolver& from, const Progress& progress) {
    std::vector<double> all;
    for (const LogMap& map : from.solve(sources, {.progress = progress}))
      all.insert(all.end(), map.coordinates().begin(), map.coordinates().end());
    return all;
  };
  const std::vector<double> expected = numbers(solver, {}), marched = numbers(marching, {});
  int steps = 0;
  for (const unsigned threads : {1U, 4U}) {
    steps += cancel_in_turn([&](const Progress& progress) {
      (void)trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = threads, .progress = progress});
    });
    steps += cancel_in_turn([&](const Progress& progress) {
      (void)LogMapSolver(surface.graph(), {.threads = threads, .progress = progress});
    });
    LocalMapOptions local{.radius = 0.3};
    local.heat.threads = threads;
    steps += cancel_in_turn([&](const Progress& progress) {
      local.heat.progress = progress;
      (void)local_maps(surface.graph(), local);
    });
  }
  steps += cancel_in_turn([&](const Progress& progress) { (void)numbers(solver, progress); });
  EXPECT_GT(steps, 30);
  EXPECT_EQ(numbers(solver, {}), expected);
  EXPECT_EQ(numbers(marching, {}), marched);
}

TEST(Cancellation, AThousandTimesAtRandomSteps) {
  const Mesh mesh = torus(300);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const ExactGeodesics exact(surface);
  const LogMapSolver marching(surface.graph(), {.strategy = Strategy::march, .threads = 2});
  const LogMap expected = marching.solve(Source::at_vertex(Vertex(0)));
  const LogMap expected_exact = exact.log_map(Vertex(0));
  std::mt19937 generator(5);
  int cancelled = 0;
  for (int run = 0; run < 1000; ++run) {
    StopAt stop(static_cast<int>(1 + generator() % 12));
    try {
      if (run % 2 == 0)
        (void)marching.solve(Source::at_vertex(Vertex(0)), {.progress = stop.progress()});
      else
        (void)exact.log_map(Vertex(0), {.progress = stop.progress()});
      EXPECT_FALSE(stop.came()) << run;
    } catch (const Cancelled&) {
      EXPECT_TRUE(stop.came()) << run;
      ++cancelled;
    }
  }
  EXPECT_GT(cancelled, 300);
  const LogMap map = marching.solve(Source::at_vertex(Vertex(0)));
  EXPECT_TRUE(std::ranges::equal(map.coordinates(), expected.coordinates()));
  EXPECT_TRUE(std::ranges::equal(exact.log_map(Vertex(0)).coordinates(), expected_exact.coordinates()));
}

}  // namespace
}  // namespace ahm::test
