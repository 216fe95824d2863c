#include "mesh_input.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "ahm/error.hpp"

namespace ahm::app {

void check_mesh_input(const std::string& backend, const io::Geometry& input, const RunOptions& options) {
  if (input.face_count() == 0)
    throw InvalidArgument(
        fmt::format("--backend {}: the input has no faces; --backend pointcloud maps its points", backend));
  if (options.voxel || options.outliers || options.drop_nan || options.local)
    throw InvalidArgument(
        "--voxel, --outliers, --drop-nan and --local are for point clouds; add --backend pointcloud to map the "
        "vertices as one");
  const auto within = [&](Index index, std::size_t count, const char* what) {
    if (static_cast<std::size_t>(index) >= count)
      throw InvalidArgument(
          fmt::format("--source {}: the input has {} {}, numbered from 0", to_string(options.source), count, what));
  };
  if (const auto* vertex = std::get_if<SourceVertex>(&options.source))
    within(vertex->index, input.points.size(), "vertices");
  if (const auto* face = std::get_if<SourceFace>(&options.source)) {
    within(face->face, input.face_count(), "faces");
    const std::size_t corners = input.face(static_cast<std::size_t>(face->face)).size();
    if (face->weights.size() != corners)
      throw InvalidArgument(fmt::format("--source {}: this face has {} corners, give as many coordinates",
                                        to_string(options.source), corners));
  }
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
