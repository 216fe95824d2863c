#include "input/input_checks.hpp"

#include <fmt/format.h>

#include "ahm/error.hpp"
#include "cli/source_list.hpp"

namespace ahm::app {

void check_mesh_input(const std::string& backend, const io::Geometry& input, const InputOptions& options,
                      const std::optional<SourceSpec>& source) {
  if (input.face_count() == 0)
    throw InvalidArgument(
        fmt::format("--backend {}: the input has no faces; --backend pointcloud maps its points", backend));
  const InputOptions defaults;
  if (options.voxel || options.outliers || options.drop_nan || options.k || options.knn != defaults.knn ||
      options.normals != defaults.normals || options.smooth)
    throw InvalidArgument(
        "--voxel, --outliers, --drop-nan, --k, --knn, --normals and --smooth are for point clouds; add --backend "
        "pointcloud to map the vertices as one");
  if (source) position_in(input, *source, "--source");
}

void check_cloud_input(const io::Geometry& input, const InputOptions& options,
                       const std::optional<SourceSpec>& source) {
  if (options.repair.any())
    throw InvalidArgument(
        "--repair, --weld, --drop-degenerate, --drop-duplicates and --orient are for meshes; a cloud joins equal "
        "points by itself");
  const InputOptions defaults;
  if (options.flips != defaults.flips || options.non_manifold != defaults.non_manifold ||
      options.discretization != defaults.discretization)
    throw InvalidArgument("--no-flips, --non-manifold and --discretization are for meshes; the input is " +
                          std::string(input.face_count() == 0 ? "a point cloud" : "mapped as a point cloud"));
  if (!source) return;
  if (const auto* face = std::get_if<SourceFace>(&*source))
    throw InvalidArgument(fmt::format(
        "--source {}: a cloud has no faces (backend pointcloud); write a vertex index or x,y,z", to_string(*face)));
  position_in(input, *source, "--source");
}

}  // namespace ahm::app
