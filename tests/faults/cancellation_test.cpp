// StoppableWork that is cancelled at any step of its progress ends with Cancelled, and its inputs stay usable.
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <random>
#include <stop_token>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

/// Requests a stop at step k of the progress.
class StopAt {
 public:
  explicit StopAt(int k) : left_(k) {}
  Progress progress() {
    return {[this](std::string_view, double) {
              if (left_-- == 1) source_.request_stop();
            },
            source_.get_token()};
  }
  bool is_reached() const { return left_ < 1; }

 private:
  std::atomic<int> left_;
  std::stop_source source_;
};

using StoppableWork = std::function<void(const Progress&)>;

/// Runs the work, which must end with Cancelled if it reaches step k. @return whether it does
bool is_cancelled(int k, const StoppableWork& work) {
  StopAt stop(k);
  bool cancelled = false;
  try {
    work(stop.progress());
  } catch (const Cancelled&) {
    cancelled = true;
  }
  EXPECT_EQ(cancelled, stop.is_reached()) << "at step " << k;
  return stop.is_reached();
}

/// Cancels the work at step 1, 2, ...; returns the number of steps.
int cancel_in_turn(const StoppableWork& work) {
  int steps = 0;
  while (is_cancelled(steps + 1, work)) ++steps;
  return steps;
}

TEST(Cancellation, AtAnyStepLeavesInputsUsable) {
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
  const auto march = [&](const Progress& progress) {
    return marching.solve(Source::at_vertex(Vertex(0)), {.progress = progress});
  };
  const auto trace = [&](const Progress& progress) { return exact.log_map(Vertex(0), {.progress = progress}); };
  const LogMap marched = march({}), traced = trace({});
  std::mt19937 generator(5);
  int cancelled = 0;
  for (int run = 0; run < 1000; ++run) {
    const StoppableWork work = run % 2 == 0 ? StoppableWork([&](const Progress& progress) { (void)march(progress); })
                                            : StoppableWork([&](const Progress& progress) { (void)trace(progress); });
    cancelled += is_cancelled(static_cast<int>(1 + generator() % 12), work);
  }
  EXPECT_GT(cancelled, 300);
  EXPECT_TRUE(std::ranges::equal(march({}).coordinates(), marched.coordinates()));
  EXPECT_TRUE(std::ranges::equal(trace({}).coordinates(), traced.coordinates()));
}

}  // namespace
}  // namespace ahm::test
