#include "input/cloud_preparation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "ahm/error.hpp"
#include "ahm/pointcloud/surroundings.hpp"
#include "cli/source_list.hpp"
#ifdef AHM_WITH_PCL
#include "ahm/pcl/filters.hpp"
#endif

namespace ahm::app {
namespace {

bool is_finite(const Vec3& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); }

std::string list_first(const std::vector<Index>& indices) {
  const std::size_t shown = std::min<std::size_t>(indices.size(), 10);
  return fmt::format("{}{}", fmt::join(indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                     indices.size() > shown ? ", ..." : "");
}

double distance(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

#ifdef AHM_WITH_PCL
/// Keeps the listed points (indices into `cloud`, ascending).
void keep(PreparedCloud& cloud, const std::vector<Index>& kept) {
  for (std::size_t i = 0; i < kept.size(); ++i) {  // kept[i] >= i: in place
    cloud.points[i] = cloud.points[kept[i]];
    if (!cloud.normals.empty()) cloud.normals[i] = cloud.normals[kept[i]];
    cloud.input_row[i] = cloud.input_row[kept[i]];
  }
  cloud.points.resize(kept.size());
  if (!cloud.normals.empty()) cloud.normals.resize(kept.size());
  cloud.input_row.resize(kept.size());
}
#endif

PreparedCloud finite_points(const io::Geometry& input, const InputOptions& options) {
  PreparedCloud cloud;
  const bool with_normals = !input.normals.empty() && options.normals != "estimate";
  std::vector<Index> bad;
  for (std::size_t i = 0; i < input.points.size(); ++i) {
    if (!is_finite(input.points[i])) {
      bad.push_back(static_cast<Index>(i));
      continue;
    }
    cloud.points.push_back(input.points[i]);
    if (with_normals) cloud.normals.push_back(input.normals[i]);
    cloud.input_row.push_back(static_cast<Index>(i));
  }
  if (!bad.empty() && !options.drop_nan)
    throw InvalidGeometry(fmt::format(
        "{}: {} of {} points have a coordinate that is nan or infinite (points {}); --drop-nan leaves them out",
        options.path, bad.size(), input.points.size(), list_first(bad)));
  cloud.non_finite = static_cast<Index>(bad.size());
  return cloud;
}

void require_normals(const io::Geometry& input, const InputOptions& options) {
  if (input.normals.empty() && (options.normals == "oriented" || options.normals == "unoriented"))
    throw InvalidArgument(fmt::format("--normals {}: {} has no normals; leave the option out to estimate them",
                                      options.normals, options.path));
}

/// Keeps what lies within one and a half radii of the source, or of the point nearest to it.
void keep_surroundings(PreparedCloud& cloud, const io::Geometry& input, double radius, const SourceSpec& source) {
  Vec3 center = position_in(input, source, "--source");
  if (std::holds_alternative<SourcePosition>(source) && !cloud.points.empty())
    center = *std::min_element(cloud.points.begin(), cloud.points.end(),
                               [&](const Vec3& a, const Vec3& b) { return distance(a, center) < distance(b, center); });
  pointcloud::Surroundings near = pointcloud::surroundings(cloud.points, cloud.normals, center, 1.5 * radius);
  cloud.beyond = static_cast<Index>(cloud.points.size() - near.points.size());
  for (Index& row : near.index) row = cloud.input_row[row];
  cloud.points = std::move(near.points);
  cloud.normals = std::move(near.normals);
  cloud.input_row = std::move(near.index);
}

#ifdef AHM_WITH_PCL
pcl_bridge::ReducedCloud reduce(const PreparedCloud& cloud, double size) try {
  return pcl_bridge::voxel_grid(cloud.points, cloud.normals, size);
} catch (const InvalidArgument& e) {
  throw InvalidArgument(fmt::format("--voxel {}: {}", size, e.what()));
}

void apply_voxel_grid(PreparedCloud& cloud, double size, std::optional<Index> source) {
  const pcl_bridge::ReducedCloud reduced = reduce(cloud, size);
  std::vector<Index> kept = reduced.point_of_row;
  if (source) {  // the source represents its voxel itself
    const auto place =
        std::lower_bound(cloud.input_row.begin(), cloud.input_row.end(), *source) - cloud.input_row.begin();
    kept[reduced.row_of_point[place]] = static_cast<Index>(place);
    std::sort(kept.begin(), kept.end());
  }
  cloud.voxel_replaced = static_cast<Index>(cloud.points.size() - kept.size());
  keep(cloud, kept);
}

void apply_outlier_removal(PreparedCloud& cloud, std::optional<Index> source) {
  const std::vector<Index> kept = pcl_bridge::outlier_removal(cloud.points);
  cloud.outliers = static_cast<Index>(cloud.points.size() - kept.size());
  keep(cloud, kept);
  if (source && !std::binary_search(cloud.input_row.begin(), cloud.input_row.end(), *source))
    throw InvalidArgument(
        fmt::format("--source {}: --outliers removes this point; choose another one or leave --outliers out", *source));
}
#endif

}  // namespace

PreparedCloud prepare_cloud(const io::Geometry& input, const InputOptions& options,
                            const std::optional<SourceSpec>& source) {
  const auto begin = std::chrono::steady_clock::now();
#ifndef AHM_WITH_PCL
  if (options.voxel || options.outliers) throw InvalidArgument("--voxel and --outliers: this build of ahm has no PCL");
#endif
  PreparedCloud cloud = finite_points(input, options);
  require_normals(input, options);
  if (options.local && source) keep_surroundings(cloud, input, *options.local, *source);
#ifdef AHM_WITH_PCL
  const auto* vertex = source ? std::get_if<SourceVertex>(&*source) : nullptr;
  const std::optional<Index> row = vertex ? std::optional(vertex->index) : std::nullopt;
  if (options.voxel) apply_voxel_grid(cloud, *options.voxel, row);
  if (options.outliers) apply_outlier_removal(cloud, row);
#endif
  cloud.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return cloud;
}

}  // namespace ahm::app
