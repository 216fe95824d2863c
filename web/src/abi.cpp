// The functions that web/package/index.js calls. Objects are pointers that the caller releases. A function that fails returns 0, and
// `ahm_error_kind` and `ahm_error_message` describe the error. Functions with arrays as results keep them in columns until the next
// call. The module has one thread.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/mesh_repair.hpp"
#include "ahm/surface/surface_solver.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "output/warning_text.hpp"

// NOLINTBEGIN(readability-identifier-naming)
#define AHM_EXPORT(name) extern "C" [[clang::export_name(#name)]]

namespace {

using SurfacePointer = std::shared_ptr<const ahm::Surface>;

struct {
  std::string kind, message;
} failure;

std::vector<std::vector<double>> columns;

void fail(const char* kind, const char* message) { failure = {kind, message}; }

/// The result of body(), or 0 if it throws.
template <class Body>
auto guarded(const Body& body) -> decltype(body()) {
  try {
    return body();
  } catch (const ahm::InvalidArgument& error) {
    fail("InvalidArgument", error.what());
  } catch (const ahm::InvalidGeometry& error) {
    fail("InvalidGeometry", error.what());
  } catch (const ahm::InvalidGraph& error) {
    fail("InvalidGraph", error.what());
  } catch (const ahm::NotPositiveDefinite& error) {
    fail("NotPositiveDefinite", error.what());
  } catch (const ahm::ResourceExhausted& error) {
    fail("ResourceExhausted", error.what());
  } catch (const std::bad_alloc&) {
    fail("ResourceExhausted", "out of memory: WebAssembly has at most 4 GiB");
  } catch (const std::exception& error) {
    fail("AhmError", error.what());
  }
  return {};
}

std::vector<ahm::Vec3> points(const double* numbers, std::uint32_t count) {
  std::vector<ahm::Vec3> result(count);
  for (std::uint32_t i = 0; i < count; ++i) result[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  return result;
}

template <class S>
SurfacePointer* shared(S&& surface) {
  return new SurfacePointer(std::make_shared<const S>(std::forward<S>(surface)));
}

/// Builds a mesh, or if `weld` is not negative, a mesh of merged vertices with the rows of the input.
/// @param build  build(positions, faces): the surface
template <class Build>
SurfacePointer* build_mesh(std::vector<ahm::Vec3> positions, const ahm::FaceList& faces, double weld,
                           const Build& build) {
  if (weld < 0) return shared(build(positions, faces));
  ahm::RepairedMesh mesh = ahm::repair_mesh(positions, faces, {.weld = weld});
  auto built = build(positions, mesh.faces());
  return shared(
      ahm::RepairedSurface(std::make_unique<decltype(built)>(std::move(built)), std::move(positions), std::move(mesh)));
}

/// The number of an input face on the surface.
ahm::Index face_on(const ahm::Surface& surface, ahm::Index face) {
  const auto* repaired = dynamic_cast<const ahm::RepairedSurface*>(&surface);
  if (!repaired) return face;
  if (const auto remaining = repaired->mesh().remaining(face)) return *remaining;
  throw ahm::InvalidArgument("there is no face " + std::to_string(face) +
                             ", or it has no area after welding; choose another face");
}

/// Reads places. Each is a kind and its numbers: 0 row; 1 x y z; 2 face, number of corners, weights.
std::vector<ahm::Location> read_places(const ahm::SurfaceSolver& solver, const double* numbers, std::uint32_t count) {
  std::vector<ahm::Location> places;
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto kind = static_cast<int>(*numbers++);
    if (kind == 0) {
      places.emplace_back(static_cast<std::int64_t>(*numbers++));
    } else if (kind == 1) {
      places.emplace_back(ahm::Vec3{numbers[0], numbers[1], numbers[2]});
      numbers += 3;
    } else {
      const ahm::Index face = face_on(solver.surface(), static_cast<ahm::Index>(*numbers++));
      const auto corners = static_cast<std::size_t>(*numbers++);
      places.emplace_back(ahm::FacePoint{face, std::vector<double>(numbers, numbers + corners)});
      numbers += corners;
    }
  }
  return places;
}

/// Stores a path: x y z of its points; its length, whether it is complete, its status.
int keep(const ahm::SurfacePath& path) {
  columns.assign(2, {});
  for (const ahm::Vec3& point : path.points) columns[0].insert(columns[0].end(), point.begin(), point.end());
  columns[1] = {path.length, path.complete ? 1.0 : 0.0, static_cast<double>(path.status)};
  return 1;
}

}  // namespace

AHM_EXPORT(ahm_allocate) void* ahm_allocate(std::size_t bytes) {
  void* const memory = std::malloc(bytes);
  if (!memory) fail("ResourceExhausted", "out of memory: WebAssembly has at most 4 GiB");
  return memory;
}
AHM_EXPORT(ahm_free) void ahm_free(void* memory) { std::free(memory); }

AHM_EXPORT(ahm_error_kind) const char* ahm_error_kind() { return failure.kind.c_str(); }
AHM_EXPORT(ahm_error_message) const char* ahm_error_message() { return failure.message.c_str(); }
AHM_EXPORT(ahm_version) const char* ahm_version() { return AHM_WEB_VERSION; }

AHM_EXPORT(ahm_column) const double* ahm_column(std::uint32_t k) { return columns[k].data(); }
AHM_EXPORT(ahm_column_length) std::uint32_t ahm_column_length(std::uint32_t k) {
  return static_cast<std::uint32_t>(columns[k].size());
}
AHM_EXPORT(ahm_forget_columns) void ahm_forget_columns() { columns = {}; }

/// @param weld  merges vertices at most this far apart; negative: merges none
AHM_EXPORT(ahm_triangle_mesh)
SurfacePointer* ahm_triangle_mesh(const double* positions, std::uint32_t vertices, const std::int32_t* corners,
                                  std::uint32_t faces, int split, double weld) {
  return guarded([&] {
    std::vector<ahm::Offset> begin(faces + 1);
    for (std::uint32_t f = 0; f <= faces; ++f) begin[f] = ahm::Offset{3} * f;
    ahm::trimesh::MeshOptions options;
    if (split != 0) options.non_manifold = ahm::NonManifold::split;
    return build_mesh(points(positions, vertices), {begin, {corners, std::size_t{3} * faces}}, weld,
                      [&](const std::vector<ahm::Vec3>& at, const ahm::FaceList& list) {
                        std::vector<ahm::Triangle> triangles(list.size());
                        for (std::size_t f = 0; f < list.size(); ++f)
                          std::copy_n(list.vertices.begin() + 3 * f, 3, triangles[f].begin());
                        return ahm::trimesh::TriangleMeshSurface::build(at, triangles, options);
                      });
  });
}

/// @param weld  as above
AHM_EXPORT(ahm_polygon_mesh)
SurfacePointer* ahm_polygon_mesh(const double* positions, std::uint32_t vertices, const std::int32_t* begin,
                                 std::uint32_t faces, const std::int32_t* corners, int split, double weld) {
  return guarded([&] {
    const std::vector<ahm::Offset> offsets(begin, begin + faces + 1);
    ahm::polymesh::PolygonOptions options;
    if (split != 0) options.non_manifold = ahm::NonManifold::split;
    return build_mesh(points(positions, vertices), {offsets, {corners, static_cast<std::size_t>(begin[faces])}}, weld,
                      [&](const std::vector<ahm::Vec3>& at, const ahm::FaceList& list) {
                        return ahm::polymesh::PolygonMeshSurface::build(at, list.begin, list.vertices, options);
                      });
  });
}

/// @param normals  null: estimated
AHM_EXPORT(ahm_point_cloud)
SurfacePointer* ahm_point_cloud(const double* positions, std::uint32_t count, const double* normals) {
  return guarded([&] {
    return shared(
        ahm::pointcloud::PointCloudSurface::build(points(positions, count), points(normals, normals ? count : 0)));
  });
}

AHM_EXPORT(ahm_rows) std::uint32_t ahm_rows(const SurfacePointer* surface) {
  return static_cast<std::uint32_t>((*surface)->rows().row_count());
}
/// Lines of an id and a text, with a tab between them. Valid until the next call.
AHM_EXPORT(ahm_warnings) const char* ahm_warnings(const SurfacePointer* surface) {
  static std::string lines;
  return guarded([&] {
    lines.clear();
    for (const ahm::Warning& warning : (*surface)->warnings())
      lines += std::string(warning.id) + '\t' + ahm::app::worded(warning) + '\n';
    return lines.c_str();
  });
}
AHM_EXPORT(ahm_release_surface) void ahm_release_surface(SurfacePointer* surface) { delete surface; }

/// @param method  0: automatic, 1: polar, 2: heat, 3: exact
AHM_EXPORT(ahm_solver) ahm::SurfaceSolver* ahm_solver(const SurfacePointer* surface, int method) {
  return guarded([&] {
    ahm::MethodOptions options;
    if (method == 1) options = ahm::PolarSolverOptions{};
    if (method == 2) options = ahm::HeatOptions{};
    if (method == 3) options = ahm::ExactSolverOptions{};
    return new ahm::SurfaceSolver(*surface, options);
  });
}
AHM_EXPORT(ahm_method) const char* ahm_method(const ahm::SurfaceSolver* solver) {
  return ahm::to_string(solver->method()).data();
}
AHM_EXPORT(ahm_release_solver) void ahm_release_solver(ahm::SurfaceSolver* solver) { delete solver; }

/// Columns: u, v, distance, angle, spread, error estimate or empty, status, quality if it is requested.
/// @param u_axis  null: default axis
AHM_EXPORT(ahm_log_map)
int ahm_log_map(const ahm::SurfaceSolver* solver, const double* place, const double* u_axis, double radius,
                int quality) {
  return guarded([&] {
    ahm::SurfaceMapOptions options;
    options.radius = radius;
    options.frames = false;
    if (u_axis) options.u_axis = ahm::Vec3{u_axis[0], u_axis[1], u_axis[2]};
    ahm::SurfaceLogMap map = solver->log_map(read_places(*solver, place, 1).front(), options);
    columns.assign(8, {});
    for (const ahm::Status status : map.status) columns[6].push_back(static_cast<double>(status));
    if (quality != 0) columns[7] = solver->quality(map);
    columns[0] = std::move(map.u);
    columns[1] = std::move(map.v);
    columns[2] = std::move(map.distance);
    columns[3] = std::move(map.angle);
    columns[4] = std::move(map.spread);
    columns[5] = std::move(map.error_estimate);
    return 1;
  });
}

AHM_EXPORT(ahm_distance)
int ahm_distance(const ahm::SurfaceSolver* solver, const double* places, std::uint32_t count, double radius) {
  return guarded([&] {
    ahm::SurfaceDistanceOptions options;
    options.radius = radius;
    columns = {solver->distance(read_places(*solver, places, count), options)};
    return 1;
  });
}

AHM_EXPORT(ahm_path) int ahm_path(const ahm::SurfaceSolver* solver, const double* places) {
  return guarded([&] {
    const std::vector<ahm::Location> ends = read_places(*solver, places, 2);
    return keep(solver->path(ends[0], ends[1]));
  });
}

AHM_EXPORT(ahm_trace)
int ahm_trace(const ahm::SurfaceSolver* solver, const double* place, double x, double y, double z, double length) {
  return guarded([&] { return keep(solver->trace(read_places(*solver, place, 1).front(), {x, y, z}, length)); });
}

/// Columns: begin of the entries of each source, and per entry row, u, v, distance, weight, cos and sin of the transport.
/// @param count  0: every row is a source
AHM_EXPORT(ahm_local_maps)
int ahm_local_maps(const ahm::SurfaceSolver* solver, const double* places, std::uint32_t count, double radius, int k) {
  return guarded([&] {
    ahm::LocalMapOptions options;
    options.radius = radius;
    options.k = k;
    const ahm::RowLocalMaps maps =
        count == 0 ? solver->local_maps(options) : solver->local_maps(read_places(*solver, places, count), options);
    columns.assign(8, {});
    columns[0].assign(maps.indptr.begin(), maps.indptr.end());
    for (std::size_t e = 0; e < maps.neighbors.size(); ++e) {
      columns[1].push_back(static_cast<double>(maps.neighbors[e].index));
      for (std::size_t c = 0; c < 2; ++c) {
        columns[2 + c].push_back(maps.logs[2 * e + c]);
        columns[6 + c].push_back(maps.transports[2 * e + c]);
      }
    }
    columns[4] = maps.distances;
    columns[5] = maps.weights;
    return 1;
  });
}
// NOLINTEND(readability-identifier-naming)
