// Time and memory from points to log maps on random spheres.
#include <fmt/format.h>

#include <optional>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "scaling/sizes.hpp"
#include "shapes.hpp"

namespace ahm::bench {
namespace {

std::vector<double> measure(Index n, Ordering ordering, const Settings& settings) {
  const std::vector<Vec3> points = test::random_sphere(n).points;
  const MapOptions options{.threads = settings.threads}, alone{.threads = settings.threads, .distances = false};
  std::optional<pointcloud::PointCloudSurface> cloud;
  std::optional<LogMapSolver> solver;
  const double build =
      seconds([&] { cloud.emplace(pointcloud::PointCloudSurface::build(points, {}, {.threads = settings.threads})); });
  const double factor = seconds([&] {
    solver.emplace(cloud->graph(),
                   HeatOptions{.strategy = Strategy::global, .ordering = ordering, .threads = settings.threads});
  });
  const Source source = cloud->source(Row(0)).source;
  Index ok = 0;
  const double first = seconds([&] { ok = solver->solve(source, options).count(Status::ok); });
  const double peak = peak_megabytes();
  const double adaptive = median_of_five([&] { solver->solve(source, options); });
  const double localized =
      median_of_five([&] { solver->solve(source, {.variant = Variant::localized, .threads = settings.threads}); });
  const double coordinates = median_of_five([&] { solver->solve(source, alone); });
  std::vector<Source> sources;
  for (Index s = 0; s < 64; ++s) sources.push_back(cloud->source(Row(s * (n / 64))).source);
  const double batch = seconds([&] { solver->solve(sources, options); });
  const double batch_alone = seconds([&] { solver->solve(sources, alone); });
  return {build,
          factor,
          first,
          build + factor + first,
          adaptive,
          localized,
          coordinates,
          batch / 64,
          batch_alone / 64,
          static_cast<double>(solver->operators().statistics().bytes) / 1e6,
          peak,
          peak_megabytes(),
          static_cast<double>(ok)};
}

}  // namespace

Table cloud_scaling(const Settings& settings) {
  Table table({"points", "ordering", "graph s", "factor s", "first map s", "total s", "additional adaptive s",
               "additional localized s", "u and v only s", "batch of 64, s each", "batch of u and v only, s each",
               "factors MB", "peak MB", "peak MB with the batch", "ok"});
  for (Index n : sizes(settings, 1000, {10000, 100000, 400000}))
    for (const auto& [name, ordering] :
         {std::pair{"amd", Ordering::amd}, {"nested dissection", Ordering::nested_dissection}}) {
      std::vector<Cell> row{n, name};
      for (double number : in_own_process(13, [&] { return measure(n, ordering, settings); })) row.push_back(number);
      table.add(row);
    }
  const Table amd = table.where("ordering", "amd");
  table.seen = fmt::format("From {:.0f} points to their first map in {:.2g} s and {:.0f} MB.", amd.largest("points"),
                           amd.largest("total s"), amd.largest("peak MB"));
  return table;
}

}  // namespace ahm::bench
