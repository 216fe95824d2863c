#include "program/plan_mesh.hpp"

#include <iostream>
#include <memory>
#include <vector>

#include "ahm/distributed/tile_surface.hpp"
#include "ahm/error.hpp"
#include "ahm/io/read.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::distributed::program {
namespace {

std::unique_ptr<const Surface> surface_of(const io::Geometry& geometry, const Progress& progress) {
  std::vector<Triangle> triangles;
  for (std::size_t f = 0; f < geometry.face_count(); ++f)
    if (const auto face = geometry.face(f); face.size() == 3) triangles.push_back({face[0], face[1], face[2]});
  if (triangles.size() < geometry.face_count()) {
    polymesh::PolygonOptions options;
    options.progress = progress;
    return std::make_unique<polymesh::PolygonMeshSurface>(
        polymesh::PolygonMeshSurface::build(geometry.points, geometry.face_begin, geometry.face_vertices, options));
  }
  trimesh::MeshOptions options;
  options.progress = progress;
  return std::make_unique<trimesh::TriangleMeshSurface>(
      trimesh::TriangleMeshSurface::build(geometry.points, triangles, options));
}

}  // namespace

Manifest plan_mesh(const std::filesystem::path& input, const std::filesystem::path& folder, const TileOptions& options,
                   const Progress& progress) {
  std::unique_ptr<const Surface> surface;
  {
    const io::Geometry geometry = io::read(input);
    if (geometry.face_count() == 0)
      throw InvalidArgument(
          "'" + input.string() +
          "' has no faces, and clouds are not cut into tiles from files of its kind; save it as .ply");
    if (options.k != 0 || options.drop_non_finite)
      throw InvalidArgument("--k and --drop-nan are for clouds, and '" + input.string() + "' is a mesh");
    surface = surface_of(geometry, progress);
  }
  for (const Warning& warning : surface->warnings())
    std::cerr << "ahm-tiles: warning: " << warning.id << "; 'ahm info " << input.string() << "' tells more\n";
  return tile_surface(*surface, std::filesystem::absolute(input).string(), folder, options.tile_points, progress);
}

}  // namespace ahm::distributed::program
