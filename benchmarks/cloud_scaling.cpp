// Time and memory from points to log maps on random spheres: bench_cloud_scaling [points ...]
//
// One process per size gives honest peak memory; AHM_METIS=1 in the environment orders by nested dissection. The rows
// are Markdown.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "ahm/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_graph.hpp"
#include "clouds.hpp"

namespace {

template <class Work>
double seconds(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Work>
double median_of_five(const Work& work) {
  double times[5];
  for (double& t : times) t = seconds(work);
  std::sort(times, times + 5);
  return times[2];
}

double peak_megabytes() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1e3;
}

void run(ahm::Index n, ahm::Ordering ordering) {
  const auto points = ahm::bench::random_sphere(n);
  std::optional<ahm::pointcloud::PointCloudGraph> cloud;
  std::optional<ahm::LogMapSolver> solver;
  const double build = seconds([&] { cloud.emplace(ahm::pointcloud::PointCloudGraph::build(points)); });
  const double factor = seconds([&] { solver.emplace(cloud->graph(), ahm::OperatorOptions{.ordering = ordering}); });
  const ahm::Source source = cloud->source_at_point(0);
  ahm::Index ok = 0;
  const double first = seconds([&] { ok = solver->solve(source).count(ahm::Status::ok); });
  const double peak = peak_megabytes();
  const double adaptive = median_of_five([&] { solver->solve(source); });
  const double localized = median_of_five([&] { solver->solve(source, {.variant = ahm::Variant::localized}); });
  std::vector<ahm::Source> sources;
  for (ahm::Index s = 0; s < 64; ++s) sources.push_back(cloud->source_at_point(s * (n / 64)));
  const double batch = seconds([&] { solver->solve(sources); });
  const auto& statistics = solver->operators().statistics();
  std::printf("| %d | %s | %.2f | %.2f | %.3f | %.2f | %.3f | %.3f | %.4f | %.0f | %.0f | %.0f | %d |\n", n,
              ordering == ahm::Ordering::amd ? "amd" : "metis", build, factor, first, build + factor + first, adaptive,
              localized, batch / 64, static_cast<double>(statistics.bytes) / 1e6, peak, peak_megabytes(), ok);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::printf("BLAS: %s\n\n", ahm::linear_algebra_info().blas.c_str());
  std::printf(
      "| points | ordering | graph s | factor s | first map s | total s | further adaptive s | further localized s | "
      "batch of 64, s each | factors MB | peak MB | peak MB with the batch | ok |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::vector<ahm::Index> sizes;
  for (int a = 1; a < argc; ++a) sizes.push_back(std::atoi(argv[a]));
  if (sizes.empty()) sizes = {10000, 100000};
  const bool metis = std::getenv("AHM_METIS") != nullptr;
  for (ahm::Index n : sizes) run(n, metis ? ahm::Ordering::nested_dissection : ahm::Ordering::amd);
}
