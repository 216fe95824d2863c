#include "ahm-tiles/plan_mesh.hpp"

#include <iostream>
#include <memory>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/io/read.hpp"
#include "ahm/tiles/tile_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "output/wording.hpp"

namespace ahm::tiles::program {
namespace {

/// The options that triangle meshes and polygon meshes share.
template <class Options>
Options options_of(const MeshPlan& mesh, const Progress& progress) {
  Options options;
  options.intrinsic_delaunay = mesh.flips;
  options.non_manifold = mesh.non_manifold;
  options.threads = mesh.threads;
  options.progress = progress;
  return options;
}

std::unique_ptr<const Surface> surface_of(const io::Geometry& geometry, const MeshPlan& mesh,
                                          const Progress& progress) {
  std::vector<Triangle> triangles;
  for (std::size_t f = 0; f < geometry.face_count(); ++f)
    if (const auto face = geometry.face(f); face.size() == 3) triangles.push_back({face[0], face[1], face[2]});
  if (triangles.size() < geometry.face_count()) {
    auto options = options_of<polymesh::PolygonOptions>(mesh, progress);
    options.discretization = mesh.discretization;
    return std::make_unique<polymesh::PolygonMeshSurface>(
        polymesh::PolygonMeshSurface::build(geometry.points, geometry.face_begin, geometry.face_vertices, options));
  }
  return std::make_unique<trimesh::TriangleMeshSurface>(trimesh::TriangleMeshSurface::build(
      geometry.points, triangles, options_of<trimesh::MeshOptions>(mesh, progress)));
}

}  // namespace

Manifest plan_mesh(const std::filesystem::path& input, const std::filesystem::path& folder, const TileOptions& options,
                   const MeshPlan& mesh, const Progress& progress) {
  std::unique_ptr<const Surface> surface;
  {
    const io::Geometry geometry = io::read(input);
    if (geometry.face_count() == 0 && !mesh.is_usual())
      throw InvalidArgument("--non-manifold, --discretization and --no-flips require a mesh; '" + input.string() +
                            "' has no faces");
    if (geometry.face_count() == 0)
      throw InvalidArgument(
          "'" + input.string() +
          "' has no faces; point clouds in this format cannot be cut into tiles, convert the file to .ply");
    if (options.k != 0 || options.drop_non_finite || options.ignore_normals)
      throw InvalidArgument("--k, --drop-nan and --ignore-normals require a point cloud; '" + input.string() +
                            "' is a mesh");
    surface = surface_of(geometry, mesh, progress);
  }
  for (const Warning& warning : surface->warnings())
    std::cerr << "ahm-tiles: warning: " << app::worded(warning) << '\n';
  return tile_surface(*surface, std::filesystem::absolute(input).string(), folder, options.tile_points, progress);
}

}  // namespace ahm::tiles::program
