// The 30 nearest neighbors of all points of a random sphere, in random order, by each search: build and queries.
#include "ahm/pointcloud/neighbor_search.hpp"

#include <benchmark/benchmark.h>

#include "shapes.hpp"
#ifdef AHM_WITH_PCL
#include "ahm/pcl/search.hpp"
#endif

namespace {

void all_neighbors(benchmark::State& state, const ahm::pointcloud::NeighborSearchFactory& make) {
  const auto points = ahm::test::random_sphere(static_cast<ahm::Index>(state.range(0))).points;
  std::vector<ahm::Index> indices(31);
  std::vector<double> squared(31);
  for (auto _ : state) {
    const auto search = make(points);
    for (const ahm::Vec3& p : points) benchmark::DoNotOptimize(search->nearest(p, indices, squared));
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK_CAPTURE(all_neighbors, nanoflann, ahm::pointcloud::nanoflann_search)
    ->ArgName("n")
    ->Arg(2500)
    ->Arg(10000)
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(all_neighbors, flann, ahm::pointcloud::flann_search)
    ->ArgName("n")
    ->Arg(2500)
    ->Arg(10000)
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);
#ifdef AHM_WITH_PCL
BENCHMARK_CAPTURE(all_neighbors, pcl, ahm::pcl_bridge::kdtree_search)
    ->ArgName("n")
    ->Arg(2500)
    ->Arg(10000)
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);
#endif

}  // namespace
