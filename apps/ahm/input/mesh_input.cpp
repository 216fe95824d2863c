#include "input/mesh_input.hpp"

#include <fmt/format.h>

#include "ahm/error.hpp"
#include "cli/source_list.hpp"

namespace ahm::app {

void check_mesh_input(const std::string& backend, const io::Geometry& input, const InputOptions& options,
                      const std::optional<SourceSpec>& source) {
  if (input.face_count() == 0)
    throw InvalidArgument(
        fmt::format("--backend {}: the input has no faces; --backend pointcloud maps its points", backend));
  if (options.voxel || options.outliers || options.drop_nan || options.k)
    throw InvalidArgument(
        "--voxel, --outliers, --drop-nan and --k are for point clouds; add --backend pointcloud to map the vertices as "
        "one");
  if (source) position_in(input, *source, "--source");
}

}  // namespace ahm::app
