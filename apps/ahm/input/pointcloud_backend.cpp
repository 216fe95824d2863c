#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "cli/source_list.hpp"
#include "input/backend.hpp"
#include "input/cloud_preparation.hpp"
#include "input/surface_model.hpp"
#ifdef AHM_WITH_PCL
#include "ahm/pcl/search.hpp"
#endif

namespace ahm::app {
namespace {

using pointcloud::CloudOptions;
using pointcloud::NormalSigns;
using pointcloud::PointCloudSurface;

/// The cheap checks: everything about the source that needs no graph.
const std::optional<SourceSpec>& checked_source(const std::optional<SourceSpec>& source, const io::Geometry& input) {
  if (!source) return source;
  if (const auto* face = std::get_if<SourceFace>(&*source))
    throw InvalidArgument(fmt::format(
        "--source {}: a cloud has no faces (backend pointcloud); write a vertex index or x,y,z", to_string(*face)));
  position_in(input, *source, "--source");
  return source;
}

pointcloud::NeighborSearchFactory search_factory(const std::string& name) {
  if (name == "flann") return pointcloud::flann_search;
  if (name == "nanoflann") return pointcloud::nanoflann_search;
#ifdef AHM_WITH_PCL
  return pcl_bridge::kdtree_search;
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
  result.threads = options.threads;
  result.progress = progress;
  return result;
}

/// A cloud, and what was done to it before.
class PointcloudModel final : public SurfaceModel {
 public:
  PointcloudModel(const io::Geometry& input, PreparedCloud prepared, std::unique_ptr<PointCloudSurface> cloud)
      : SurfaceModel(std::move(cloud)), prepared_(std::move(prepared)), input_faces_(input.face_count()) {}

  nlohmann::ordered_json report() const override;
  std::vector<std::string> warnings() const override;

 private:
  PreparedCloud prepared_;
  std::size_t input_faces_;
};

nlohmann::ordered_json PointcloudModel::report() const {
  const nlohmann::ordered_json own = SurfaceModel::report();
  nlohmann::ordered_json j;
  for (const auto& [key, value] : own.items()) {
    j[key] = value;
    if (key == "non_finite")
      j.update({{"non_finite", prepared_.non_finite},
                {"voxel_replaced", prepared_.voxel_replaced},
                {"outliers", prepared_.outliers},
                {"beyond", prepared_.beyond}});
  }
  j["seconds"] = {{"filters", prepared_.seconds}};
  j["seconds"].update(own["seconds"]);
  return j;
}

std::vector<std::string> PointcloudModel::warnings() const {
  std::vector<std::string> result;
  if (input_faces_ > 0)
    result.push_back(fmt::format("the {} faces are ignored: the vertices are mapped as a point cloud", input_faces_));
  if (prepared_.non_finite > 0)
    result.push_back(fmt::format("{} points with nan or infinite coordinates were dropped", prepared_.non_finite));
  const std::vector<std::string> own = SurfaceModel::warnings();
  result.insert(result.end(), own.begin(), own.end());
  return result;
}

}  // namespace

std::unique_ptr<Model> build_pointcloud(const io::Geometry& input, const InputOptions& options,
                                        const std::optional<SourceSpec>& source, const Progress& progress) {
  PreparedCloud prepared = prepare_cloud(input, options, checked_source(source, input));
  CloudOptions cloud = cloud_options(options, progress);
  cloud.rows = prepared.rows;
  const std::span<const Vec3> normals = options.normals == "estimate" ? std::span<const Vec3>() : input.normals;
  auto surface = std::make_unique<PointCloudSurface>(PointCloudSurface::build(input.points, normals, cloud));
  return std::make_unique<PointcloudModel>(input, std::move(prepared), std::move(surface));
}

}  // namespace ahm::app
