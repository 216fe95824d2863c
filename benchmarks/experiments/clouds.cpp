// Distances on clouds, compared with exact distances of a mesh whose vertices are the points; and how often the straight
// line in space determines them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/exact/exact_map.hpp"
#include "ahm/util/vec.hpp"
#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

constexpr int source_count = 9;

/// Errors over all vertices and sources, beyond three edges from the source.
struct DistanceErrors {
  std::vector<double> error;  ///< relative errors of the distances
  double bounded = 0;         ///< number of distances that are not longer than the straight line in space
  std::vector<double> good_quality_error;
};

/// Points moved by `noise` mean edges in random directions.
std::vector<Vec3> moved(std::span<const Vec3> points, double noise, double edge) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal(0, noise * edge / std::sqrt(3.0));
  std::vector<Vec3> result(points.begin(), points.end());
  if (noise > 0)
    for (Vec3& p : result)
      for (double& x : p) x += normal(random);
  return result;
}

/// Distances of all vertices, world units; not finite where there is no path.
std::vector<double> distances(const exact::ExactMap& map, const Surface& surface) {
  std::vector<double> result;
  for (Index i = 0; i < surface.size(); ++i) result.push_back(map.distance(Vertex(i)) * surface.graph().length_unit());
  return result;
}

/// @param quality  quality of each row; empty: unknown
void compare(const pointcloud::PointCloudSurface& cloud, std::span<const double> distances,
             std::span<const double> quality, const std::vector<double>& truth, Index source, double near,
             DistanceErrors& found) {
  const auto points = cloud.positions();
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (!std::isfinite(distances[i]) || !(truth[i] > near) || !std::isfinite(truth[i])) continue;
    const double line = distance(points[i], points[source]), error = std::abs(std::max(distances[i], line) - truth[i]);
    found.error.push_back(error / truth[i]);
    found.bounded += distances[i] <= line;
    if (quality.empty() || !(quality[i] >= reliable_quality)) continue;
    found.good_quality_error.push_back(found.error.back());
  }
}

void add_row(const Surface& surface, double noise, std::string_view variant, const DistanceErrors& found,
             Table& table) {
  const auto count = static_cast<double>(found.error.size());
  const double sum = std::accumulate(found.error.begin(), found.error.end(), 0.0);
  const bool has_quality = !found.good_quality_error.empty();
  table.add({surface.name(), surface.size(), noise, variant, sum / count, quantile(found.error, 0.95),
             quantile(found.error, 1), found.bounded / count,
             has_quality ? Cell(static_cast<double>(found.good_quality_error.size()) / count) : Cell(),
             has_quality ? Cell(quantile(found.good_quality_error, 0.95)) : Cell()});
}

void measure(const Surface& surface, double noise, Table& table) {
  const auto cloud = pointcloud::PointCloudSurface::build(moved(surface.points(), noise, surface.mean_edge()));
  const exact::PolyhedralSurface polyhedral = surface.polyhedron();
  const double near = 3 * surface.mean_edge();
  std::vector<std::vector<double>> truth;
  std::vector<Index> sources;
  DistanceErrors unfolded;
  for (int s = 0; s < source_count; ++s) {
    const Index source = sources.emplace_back(surface.size() / 11 + s * (surface.size() / source_count));
    truth.push_back(distances(exact::exact_map(polyhedral, polyhedral.vertex_point(Vertex(source))), surface));
    Wavefront front(cloud.graph());
    front.add(cloud.source(Row(source)).source);
    front.run();
    std::vector<double> found(truth.back().size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < found.size(); ++i)
      if (const auto vertex = cloud.rows().vertex(Row(static_cast<Index>(i)))) found[i] = front.distance(*vertex);
    compare(cloud, found, {}, truth.back(), source, near, unfolded);
  }
  add_row(surface, noise, "unfolded", unfolded, table);
  for (Variant variant : all_variants) {
    const LogMapSolver solver(cloud.graph(), {.variant = variant});
    DistanceErrors found;
    for (int s = 0; s < source_count; ++s) {
      const LogMap map = solver.solve(cloud.source(Row(sources[s])).source);
      const RowLogMap rows = cloud.to_rows(map);
      compare(cloud, rows.distance, to_rows(rows, map_quality(cloud.graph(), map)), truth[s], sources[s], near, found);
    }
    add_row(surface, noise, to_string(variant), found, table);
  }
}

}  // namespace

Table clouds(const Settings& settings) {
  Table table({"cloud", "points", "noise", "variant", "mean", "95%", "max", "bounded", "kept", "95% of kept"});
  const Index n = settings.toy ? 640 : 10000;
  for (double noise : {0.0, 0.3}) {
    measure(Surface("sphere", test::split_icosphere(n)), noise, table);
    measure(Surface("torus", torus(n)), noise, table);
    for_user_surfaces(settings, 40000, [&](const Surface& surface) { measure(surface, noise, table); });
  }
  const auto median = [&](const char* variant) {
    return quantile(table.where("noise", "0").where("variant", variant).numbers("95%"), 0.5);
  };
  table.seen = fmt::format(
      "Without noise, 95th percentile of the relative error, median over clouds: unfolded {:.3f}, heat {:.3f}.",
      median("unfolded"), median("adaptive"));
  return table;
}

}  // namespace ahm::bench
