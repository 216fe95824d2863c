#include "input/mesh_input.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "ahm/error.hpp"
#include "cli/source_list.hpp"

namespace ahm::app {

void check_mesh_input(const std::string& backend, const io::Geometry& input, const InputOptions& options,
                      const std::optional<SourceSpec>& source) {
  if (input.face_count() == 0)
    throw InvalidArgument(
        fmt::format("--backend {}: the input has no faces; --backend pointcloud maps its points", backend));
  if (options.voxel || options.outliers || options.drop_nan || options.local)
    throw InvalidArgument(
        "--voxel, --outliers, --drop-nan and --local are for point clouds; add --backend pointcloud to map the "
        "vertices as one");
  if (source) position_in(input, *source, "--source");
}

Index nearest_row(std::span<const Vec3> points, std::span<const Index> vertex_of_row, const Vec3& position) {
  Index best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    const double distance = std::hypot(p[0] - position[0], p[1] - position[1], p[2] - position[2]);
    if (vertex_of_row[i] < 0 || !(distance < least)) continue;
    least = distance;
    best = static_cast<Index>(i);
  }
  return best;
}

std::string in_terms_of_the_program(std::string text) {
  const std::string own = "NonManifold::split";
  if (const auto place = text.find(own); place != std::string::npos)
    text.replace(place, own.size(), "--non-manifold split");
  return text;
}

}  // namespace ahm::app
