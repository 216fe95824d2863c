#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/pointcloud/point_cloud_graph.hpp"
#include "ahm/surface/directions.hpp"
#include "cli/source_list.hpp"
#include "input/backend.hpp"
#include "input/cloud_preparation.hpp"
#ifdef AHM_WITH_PCL
#include "ahm/pcl/search.hpp"
#endif

namespace ahm::app {
namespace {

using pointcloud::CloudOptions;
using pointcloud::CloudReport;
using pointcloud::NormalSigns;
using pointcloud::PointCloudGraph;

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

class PointcloudModel final : public Model {
 public:
  PointcloudModel(const io::Geometry& input, const InputOptions& options, const std::optional<SourceSpec>& source,
                  const Progress& progress)
      : PointcloudModel(input, options, progress, prepare_cloud(input, options, checked_source(source, input))) {}

  const TangentGraph& graph() const override { return cloud_.graph(); }

  ResolvedSource source(const SourceSpec& spec, const std::optional<Vec3>& u_axis) const override {
    const Index point = prepared_point(spec);
    const Index vertex = cloud_.vertex_of_point()[point];
    const Index row = prepared_.input_row[point];
    if (vertex < 0)
      throw InvalidArgument(
          fmt::format("--source {}: point {} was removed, it has no tangent plane or no neighbours; choose another one",
                      to_string(spec), row));
    const Vec3& position = prepared_.points[point];
    std::optional<Frame> frame = cloud_.graph().frame(vertex);
    if (!u_axis) return {cloud_.source_at_point(point), row, position, frame};
    if (frame) frame = turned(*frame, *u_axis);
    return {turned_source(point, row, *u_axis), row, position, frame};
  }

  std::vector<RowVertex> row_vertices() const override {
    const auto vertices = cloud_.vertex_of_point();
    std::vector<RowVertex> result;
    for (std::size_t p = 0; p < vertices.size(); ++p)
      if (vertices[p] >= 0) result.push_back({prepared_.input_row[p], vertices[p]});
    return result;
  }

  std::vector<Vec3> normals() const override {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<Vec3> result(input_points_, Vec3{nan, nan, nan});
    const std::vector<Vec3> on_points = cloud_.normals_on_points();
    for (std::size_t p = 0; p < on_points.size(); ++p) result[prepared_.input_row[p]] = on_points[p];
    return result;
  }

  nlohmann::ordered_json report() const override;
  std::vector<std::string> warnings() const override;

 private:
  PointcloudModel(const io::Geometry& input, const InputOptions& options, const Progress& progress,
                  PreparedCloud prepared)
      : prepared_(std::move(prepared)),
        input_points_(input.points.size()),
        input_faces_(input.face_count()),
        normals_given_(!prepared_.normals.empty()),
        cloud_(PointCloudGraph::build(prepared_.points, prepared_.normals, cloud_options(options, progress))) {}

  Source turned_source(Index point, Index row, const Vec3& u_axis) const try {
    return cloud_.source_at_point(point, u_axis);
  } catch (const InvalidArgument&) {
    throw InvalidArgument(fmt::format("--u-axis {},{},{}: is perpendicular to the surface at the source, point {}",
                                      u_axis[0], u_axis[1], u_axis[2], row));
  }

  /// Index into the prepared cloud.
  Index prepared_point(const SourceSpec& spec) const {
    if (const auto* position = std::get_if<SourcePosition>(&spec)) return cloud_.nearest_point(position->position);
    const auto& rows = prepared_.input_row;
    const Index row = std::get<SourceVertex>(spec).index;
    const auto place = std::lower_bound(rows.begin(), rows.end(), row);
    if (place == rows.end() || *place != row)
      throw InvalidArgument(fmt::format(
          "--source {}: the point was left out (--voxel, --outliers, --drop-nan); choose another one, or write x,y,z",
          row));
    return static_cast<Index>(place - rows.begin());
  }

  PreparedCloud prepared_;
  std::size_t input_points_;
  std::size_t input_faces_;
  bool normals_given_;
  PointCloudGraph cloud_;
};

nlohmann::ordered_json PointcloudModel::report() const {
  const CloudReport& r = cloud_.report();
  nlohmann::ordered_json j;
  j["points"] = input_points_;
  j["vertices"] = r.vertices;
  j["non_finite"] = prepared_.non_finite;
  j["voxel_replaced"] = prepared_.voxel_replaced;
  j["outliers"] = prepared_.outliers;
  j["beyond"] = prepared_.beyond;
  j["duplicates"] = r.duplicates;
  j["degenerate"] = r.degenerate;
  j["k"] = r.k;
  j["components"] = r.components;
  j["triangles"] = r.triangles;
  j["flips"] = r.flips;
  j["rejected_long"] = r.rejected_long;
  j["rejected_normals"] = r.rejected_normals;
  j["reflections"] = r.reflections;
  j["normals_given"] = normals_given_;
  j["oriented"] = r.oriented;
  j["mollification"] = r.mollification;
  j["seconds"] = {{"filters", prepared_.seconds},
                  {"normals", r.seconds_normals},
                  {"delaunay", r.seconds_delaunay},
                  {"laplacian", r.seconds_laplacian},
                  {"graph", r.seconds_graph}};
  return j;
}

std::vector<std::string> PointcloudModel::warnings() const {
  std::vector<std::string> result;
  if (input_faces_ > 0)
    result.push_back(fmt::format("the {} faces are ignored: the vertices are mapped as a point cloud", input_faces_));
  if (prepared_.non_finite > 0)
    result.push_back(fmt::format("{} points with nan or infinite coordinates were dropped", prepared_.non_finite));
  const auto& own = cloud_.report().warnings;
  result.insert(result.end(), own.begin(), own.end());
  return result;
}

}  // namespace

std::unique_ptr<Model> build_pointcloud(const io::Geometry& input, const InputOptions& options,
                                        const std::optional<SourceSpec>& source, const Progress& progress) {
  return std::make_unique<PointcloudModel>(input, options, source, progress);
}

}  // namespace ahm::app
