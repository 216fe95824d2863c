#include "ahm/error.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "input/backend.hpp"
#include "input/open.hpp"

namespace ahm::app {
namespace {

using polymesh::Discretization;
using polymesh::PolygonMeshSurface;

polymesh::PolygonOptions polygon_options(const InputOptions& options, const Progress& progress) {
  polymesh::PolygonOptions result;
  if (options.discretization == "polygons") result.discretization = Discretization::polygons;
  if (options.discretization == "refined") result.discretization = Discretization::refined;
  result.intrinsic_delaunay = options.flips;
  result.non_manifold = options.non_manifold == "split" ? NonManifold::split : NonManifold::error;
  result.counts_as_reversed = options.counts_as_reversed;
  result.threads = options.threads;
  result.progress = progress;
  return result;
}

bool suits(const io::Geometry& input) { return input.face_count() > 0; }

BuiltSurface build(const io::Geometry& input, const InputOptions& options, const std::optional<SourceSpec>& source,
                   const Progress& progress) {
  check_mesh_input("polymesh", input, options, source);
  return BuiltSurface(std::make_unique<PolygonMeshSurface>(PolygonMeshSurface::build(
      input.points, input.face_begin, input.face_vertices, polygon_options(options, progress))));
}

/// The number of virtual vertices in faces.
std::size_t more_vertices(const io::Geometry& input, const InputOptions& options) {
  return options.discretization == "polygons" ? 0 : input.face_count();
}

}  // namespace

Backend polymesh_backend() { return {"polymesh", suits, polymesh::build_cost, build, more_vertices}; }

}  // namespace ahm::app
