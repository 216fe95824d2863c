// Time and memory from points to log maps on random spheres: bench_cloud_scaling [points ...]
//
// One process per size gives honest peak memory; AHM_METIS=1 in the environment orders by nested dissection. The rows
// are Markdown.
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "measure.hpp"
#include "shapes.hpp"

namespace {

using ahm::bench::median_of_five, ahm::bench::peak_megabytes, ahm::bench::seconds;

void run(ahm::Index n, ahm::Ordering ordering) {
  const auto points = ahm::bench::random_sphere(n);
  std::optional<ahm::pointcloud::PointCloudSurface> cloud;
  std::optional<ahm::LogMapSolver> solver;
  const double build = seconds([&] { cloud.emplace(ahm::pointcloud::PointCloudSurface::build(points)); });
  const double factor = seconds([&] { solver.emplace(cloud->graph(), ahm::OperatorOptions{.ordering = ordering}); });
  const ahm::Source source = cloud->source(ahm::Row(0)).source;
  ahm::Index ok = 0;
  const double first = seconds([&] { ok = solver->solve(source).count(ahm::Status::ok); });
  const double peak = peak_megabytes();
  const double adaptive = median_of_five([&] { solver->solve(source); });
  const double localized = median_of_five([&] { solver->solve(source, {.variant = ahm::Variant::localized}); });
  std::vector<ahm::Source> sources;
  for (ahm::Index s = 0; s < 64; ++s) sources.push_back(cloud->source(ahm::Row(s * (n / 64))).source);
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
