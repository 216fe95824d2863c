#include "input/repair.hpp"

#include <algorithm>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/surface/mesh_repair.hpp"

namespace ahm::app {
std::optional<RepairedMesh> repair(io::Geometry& input, const InputOptions& options) {
  if (!options.repair.any()) return std::nullopt;
  if (input.face_count() == 0)
    throw InvalidArgument(
        "--repair, --weld, --drop-degenerate, --drop-duplicates and --orient require a mesh; leave them out, because " +
        options.path + " has no faces");
  RepairedMesh mesh = repair_mesh(input.points, input.faces(), options.repair);
  if (mesh.given_face.empty())
    throw InvalidGeometry(options.path +
                          ": no face remains after the repair; map its points with --backend pointcloud");
  input.face_begin = mesh.face_begin;
  input.face_vertices = mesh.face_vertices;
  return mesh;
}

SourceSpec in_kept_faces(const SourceSpec& spec, const std::vector<Index>& kept, const char* gone) {
  const auto* face = std::get_if<SourceFace>(&spec);
  if (face == nullptr) return spec;
  const auto place = std::ranges::lower_bound(kept, face->face);
  if (place == kept.end() || *place != face->face) throw InvalidArgument(gone);
  SourceFace result = *face;
  result.face = static_cast<Index>(place - kept.begin());
  return result;
}

SourceSpec in_remaining_faces(const SourceSpec& spec, const RepairedMesh& mesh) {
  return in_kept_faces(spec, mesh.given_face, "there is no such face, or the repair dropped it; choose another face");
}

BuiltSurface build_repaired(const Backend& backend, const io::Geometry& input, RepairedMesh mesh,
                            const InputOptions& options, const std::optional<SourceSpec>& source,
                            const Progress& progress) {
  BuiltSurface built = backend.build(input, options, source, progress);
  return BuiltSurface(std::make_unique<RepairedSurface>(std::move(built.surface), input.points, std::move(mesh)));
}

}  // namespace ahm::app
