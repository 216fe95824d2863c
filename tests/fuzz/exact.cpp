// Exact maps and paths on meshes with few vertices.
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "maps.hpp"

namespace ahm::fuzz {
namespace {

SurfacePoint take_point(Bytes& bytes, const Surface& surface, Index faces) {
  if (bytes.byte() % 2 == 0) return Row(bytes.number(static_cast<Index>(surface.positions().size()) - 1));
  const double a = bytes.byte() / 256.0, b = bytes.byte() / 256.0 * (1 - a);
  return FacePoint{bytes.number(faces - 1), {a, b, 1 - a - b}};
}

double span_of(const Surface& surface) {
  double span = 0;
  for (const Vec3& p : surface.positions())
    for (const double x : p) span = std::max(span, std::abs(x));
  return span;
}

void check_path(const ExactGeodesics& exact, const exact::GeodesicPath& path) {
  if (path.status != Status::ok) return require(path.points.empty(), "paths that are not ok have no points");
  require(std::isfinite(path.length) && path.length >= 0, "a path's length is finite");
  if (path.points.empty()) return;
  const Vec3 a = exact.position(path.points.front()), b = exact.position(path.points.back());
  const double straight = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  require(path.length >= straight * (1 - 1e-6) - 1e-6 * span_of(exact.surface()),
          "a path is no shorter than the straight line");
}

void run(Bytes& bytes) {
  const std::uint8_t flags = bytes.byte();
  const std::vector<Vec3> positions = bytes.points(1 + bytes.byte() % 32, (flags & 1) == 0);
  const auto faces = bytes.triangles(1 + bytes.byte() % 60, static_cast<Index>(positions.size()) - 1);
  trimesh::MeshOptions options{.threads = 1};
  options.non_manifold = NonManifold::split;
  const auto surface = trimesh::TriangleMeshSurface::build(positions, faces, options);
  const ExactGeodesics exact(surface);
  const auto count = static_cast<Index>(faces.size());
  const SurfacePoint from = take_point(bytes, surface, count), to = take_point(bytes, surface, count);
  allow_refusals([&] {
    ExactMapOptions map_options;
    if ((flags & 2) != 0) map_options.radius = bytes.byte() / 4.0;
    map_options.frames = (flags & 4) != 0;
    check_map(exact.log_map(from, std::nullopt, map_options));
  });
  allow_refusals([&] { check_path(exact, exact.path(std::array{from, to})); });
  allow_refusals([&] { check_path(exact, exact.locally_shortest_path(from, to)); });
  allow_refusals([&] {
    const SurfacePoint third = take_point(bytes, surface, count);
    check_path(exact, exact.path(std::array{from, to, third}, (flags & 8) != 0));
    const auto loop = exact.path(std::array{from, to, third}, true);
    if (loop.status == Status::ok) (void)exact.shortened(loop.points, true);
  });
  allow_refusals([&] {
    const auto traced = exact.trace(from, bytes.point(true), bytes.byte());
    require(std::isfinite(traced.length), "a traced path's length is finite");
  });
}

}  // namespace
}  // namespace ahm::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ahm::fuzz::Bytes bytes(data, size);
  return ahm::fuzz::allow_refusals([&] { ahm::fuzz::run(bytes); });
}
