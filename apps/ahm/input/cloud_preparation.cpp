#include "input/cloud_preparation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "ahm/error.hpp"
#include "ahm/pointcloud/neighbor_search.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "cli/source_list.hpp"
#ifdef AHM_WITH_PCL
#include "input/pcl_module.hpp"
#endif

namespace ahm::app {
namespace {

std::string list_first(const std::vector<Index>& indices) {
  const std::size_t shown = std::min<std::size_t>(indices.size(), 10);
  return fmt::format("{}{}", fmt::join(indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                     indices.size() > shown ? ", ..." : "");
}

PreparedCloud finite_points(const io::Geometry& input, const InputOptions& options) {
  PreparedCloud cloud;
  std::vector<Index> bad;
  for (std::size_t i = 0; i < input.points.size(); ++i)
    (is_finite(input.points[i]) ? cloud.rows : bad).push_back(static_cast<Index>(i));
  if (!bad.empty() && !options.drop_nan)
    throw InvalidGeometry(
        fmt::format("{}: points with NaN or infinite coordinates: {} of {} (points {}); drop them with --drop-nan",
                    options.path, bad.size(), input.points.size(), list_first(bad)));
  cloud.non_finite = static_cast<Index>(bad.size());
  return cloud;
}

void require_normals(const io::Geometry& input, const InputOptions& options) {
  if (input.normals.empty() && (options.normals == "oriented" || options.normals == "unoriented"))
    throw InvalidArgument(fmt::format("--normals {}: {} has no normals; leave this option out to estimate them",
                                      options.normals, options.path));
}

/// Keeps the points within 1.5 radii of the source, or of the point nearest to it if the source is a position.
void keep_surroundings(PreparedCloud& cloud, const io::Geometry& input, double radius, const SourceSpec& source) {
  Vec3 center = position_in(input, source, "--source");
  if (std::holds_alternative<SourcePosition>(source) && !cloud.rows.empty())
    center = input.points[*std::min_element(cloud.rows.begin(), cloud.rows.end(), [&](Index a, Index b) {
      return distance(input.points[a], center) < distance(input.points[b], center);
    })];
  const std::vector<Row> near = pointcloud::radius_search(input.points, center, 1.5 * radius);
  cloud.beyond = static_cast<Index>(cloud.rows.size() - near.size());
  cloud.rows.clear();
  for (const Row row : near) cloud.rows.push_back(row.index);
  if (near.size() < 3)
    throw InvalidArgument(
        fmt::format("--local: only {} within {:.6g} of the source {}, and a surface requires 3; use a larger radius, "
                    "or leave it out",
                    detail::counted(near.size(), "point", "lie"), 1.5 * radius, to_string(source)));
}

#ifdef AHM_WITH_PCL
/// The vectors at the listed rows.
std::vector<Vec3> select_rows(const std::vector<Vec3>& all, const std::vector<Index>& rows) {
  std::vector<Vec3> result;
  for (Index row : rows) result.push_back(all[row]);
  return result;
}

std::optional<Index> row_of(const SourceSpec& spec) {
  const auto* vertex = std::get_if<SourceVertex>(&spec);
  return vertex ? std::optional(vertex->index) : std::nullopt;
}

/// The points to keep, ascending: in each voxel the points named in the command, or if there are none its representative.
/// @param rows  row of each point, ascending
std::vector<Index> representatives(const pcl_bridge::ReducedCloud& reduced, const std::vector<Index>& rows,
                                   const std::vector<SourceSpec>& named) {
  std::vector<Index> kept;
  std::vector<bool> has_named(reduced.point_of_row.size());
  for (const SourceSpec& spec : named) {
    const std::optional<Index> row = row_of(spec);
    const auto place = row ? std::lower_bound(rows.begin(), rows.end(), *row) : rows.end();
    if (place == rows.end() || *place != *row) continue;  // reported where the row is used
    kept.push_back(static_cast<Index>(place - rows.begin()));
    has_named[reduced.row_of_point[kept.back()]] = true;
  }
  for (std::size_t voxel = 0; voxel < has_named.size(); ++voxel)
    if (!has_named[voxel]) kept.push_back(reduced.point_of_row[voxel]);
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  return kept;
}

void apply_voxel_grid(PreparedCloud& cloud, const io::Geometry& input, const InputOptions& options,
                      const std::vector<SourceSpec>& named) try {
  const bool with_normals = !input.normals.empty() && options.normals != "estimate";
  const pcl_bridge::ReducedCloud reduced = pcl_functions().voxel_grid(
      select_rows(input.points, cloud.rows),
      with_normals ? select_rows(input.normals, cloud.rows) : std::vector<Vec3>(), *options.voxel);
  std::vector<Index> kept = representatives(reduced, cloud.rows, named);
  cloud.voxel_replaced = static_cast<Index>(cloud.rows.size() - kept.size());
  for (Index& point : kept) point = cloud.rows[point];
  cloud.rows = std::move(kept);
} catch (const InvalidArgument& e) {
  throw InvalidArgument(fmt::format("--voxel {}: {}", *options.voxel, e.what()));
}

void apply_outlier_removal(PreparedCloud& cloud, const io::Geometry& input, std::optional<Index> source) {
  std::vector<Index> kept = pcl_functions().outlier_removal(select_rows(input.points, cloud.rows));
  cloud.outliers = static_cast<Index>(cloud.rows.size() - kept.size());
  for (Index& point : kept) point = cloud.rows[point];
  cloud.rows = std::move(kept);
  if (source && !std::binary_search(cloud.rows.begin(), cloud.rows.end(), *source))
    throw InvalidArgument(fmt::format(
        "--source {}: --outliers removes this point; choose another source, or leave --outliers out", *source));
}
#endif

}  // namespace

PreparedCloud prepare_cloud(const io::Geometry& input, const InputOptions& options,
                            const std::optional<SourceSpec>& source) {
  const auto begin = std::chrono::steady_clock::now();
#ifndef AHM_WITH_PCL
  if (options.voxel || options.outliers)
    throw InvalidArgument("--voxel and --outliers require PCL, which this build of ahm does not have");
#endif
  PreparedCloud cloud = finite_points(input, options);
  require_normals(input, options);
  if (options.local && source) keep_surroundings(cloud, input, *options.local, *source);
#ifdef AHM_WITH_PCL
  std::vector<SourceSpec> named = options.named;
  if (source) named.push_back(*source);
  if (options.voxel) apply_voxel_grid(cloud, input, options, named);
  if (options.outliers) apply_outlier_removal(cloud, input, source ? row_of(*source) : std::nullopt);
#endif
  cloud.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return cloud;
}

}  // namespace ahm::app
