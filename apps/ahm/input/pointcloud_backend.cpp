#include <utility>

#include "ahm/error.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "input/backend.hpp"
#include "input/cloud_preparation.hpp"
#include "input/open.hpp"
#ifdef AHM_WITH_PCL
#include "input/pcl_module.hpp"
#endif

namespace ahm::app {
namespace {

using pointcloud::CloudOptions;
using pointcloud::NormalSigns;
using pointcloud::PointCloudSurface;

pointcloud::NeighborSearchFactory search_factory(const std::string& name) {
  if (name == "flann") return pointcloud::flann_search;
  if (name == "nanoflann") return pointcloud::nanoflann_search;
#ifdef AHM_WITH_PCL
  return pcl_functions().kdtree_search;
#else
  throw InvalidArgument("--knn pcl: this build of ahm has no PCL; use nanoflann or flann");
#endif
}

CloudOptions cloud_options(const InputOptions& options, const Progress& progress) {
  CloudOptions result;
  result.k = options.k;
  result.search = search_factory(options.knn);
  if (options.normals == "oriented") result.normal_signs = NormalSigns::oriented;
  if (options.normals == "unoriented") result.normal_signs = NormalSigns::unoriented;
  result.smooth = options.smooth;
  result.threads = options.threads;
  result.progress = progress;
  return result;
}

/// The report of the surface, with the figures of the filters.
Report report_of(const PreparedCloud& prepared, const Report& own) {
  Report result;
  for (const Figure& figure : own) {
    if (figure.id == "seconds.normals") result.push_back({"seconds.filters", prepared.seconds});
    if (figure.id != "non_finite") {
      result.push_back(figure);
      continue;
    }
    result.insert(result.end(), {{"non_finite", prepared.non_finite},
                                 {"voxel_replaced", prepared.voxel_replaced},
                                 {"outliers", prepared.outliers},
                                 {"beyond", prepared.beyond}});
  }
  return result;
}

std::vector<Warning> warnings_of(const PreparedCloud& prepared, std::size_t faces) {
  std::vector<Warning> result;
  if (faces > 0) result.push_back({"faces_ignored", {static_cast<double>(faces)}, {}});
  if (prepared.non_finite > 0) result.push_back({"non_finite_dropped", {static_cast<double>(prepared.non_finite)}, {}});
  return result;
}

bool suits(const io::Geometry& input) { return input.face_count() == 0; }

BuiltSurface build(const io::Geometry& input, const InputOptions& options, const std::optional<SourceSpec>& source,
                   const Progress& progress) {
  check_cloud_input(input, options, source);
  const PreparedCloud prepared = prepare_cloud(input, options, source);
  CloudOptions cloud = cloud_options(options, progress);
  cloud.rows.emplace(prepared.rows.begin(), prepared.rows.end());
  const std::span<const Vec3> normals = options.normals == "estimate" ? std::span<const Vec3>() : input.normals;
  BuiltSurface result(std::make_unique<PointCloudSurface>(PointCloudSurface::build(input.points, normals, cloud)));
  result.report = report_of(prepared, result.report);
  const std::vector<Warning> before = warnings_of(prepared, input.face_count());
  result.warnings.insert(result.warnings.begin(), before.begin(), before.end());
  return result;
}

}  // namespace

Backend pointcloud_backend() { return {"pointcloud", suits, pointcloud::build_cost, build, nullptr, false}; }

}  // namespace ahm::app
