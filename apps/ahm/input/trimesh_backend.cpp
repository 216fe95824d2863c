#include <fmt/format.h>

#include "ahm/error.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "input/backend.hpp"
#include "input/open.hpp"

namespace ahm::app {
namespace {

using trimesh::MeshOptions;
using trimesh::TriangleMeshSurface;

std::vector<Triangle> triangles(const io::Geometry& input) {
  std::vector<Triangle> result;
  result.reserve(input.face_count());
  for (std::size_t f = 0; f < input.face_count(); ++f) {
    const auto face = input.face(f);
    if (face.size() != 3)
      throw InvalidGeometry(fmt::format(
          "face {} has {} corners; --backend trimesh requires triangles, use --backend polymesh", f, face.size()));
    result.push_back({face[0], face[1], face[2]});
  }
  return result;
}

MeshOptions mesh_options(const InputOptions& options, const Progress& progress) {
  MeshOptions result;
  result.intrinsic_delaunay = options.flips;
  result.non_manifold = options.non_manifold == "split" ? NonManifold::split : NonManifold::error;
  result.counts_as_reversed = options.counts_as_reversed;
  result.threads = options.threads;
  result.progress = progress;
  return result;
}

bool suits(const io::Geometry& input) {
  for (std::size_t f = 0; f < input.face_count(); ++f)
    if (input.face(f).size() != 3) return false;
  return input.face_count() > 0;
}

BuiltSurface build(const io::Geometry& input, const InputOptions& options, const std::optional<SourceSpec>& source,
                   const Progress& progress) {
  check_mesh_input("trimesh", input, options, source);
  return BuiltSurface(std::make_unique<TriangleMeshSurface>(
      TriangleMeshSurface::build(input.points, triangles(input), mesh_options(options, progress))));
}

}  // namespace

Backend trimesh_backend() { return {"trimesh", suits, trimesh::build_cost, build}; }

}  // namespace ahm::app
