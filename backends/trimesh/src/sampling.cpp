#include <algorithm>
#include <cmath>
#include <limits>

#include "ahm/surface/unfolded_corners.hpp"
#include "impl.hpp"

namespace ahm::trimesh {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Vec2 coordinates(const LogMap& map, Index vertex) {
  const auto phi = map.coordinates(Vertex(vertex));
  return {phi[0], phi[1]};
}

/// A face laid out in the plane, with the map at its corners.
struct MappedFace {
  Vec2 side[3];  ///< in world units
  Vec2 phi[3]{};

  MappedFace(const TriangleMesh& mesh, const Vec2* sides) {
    for (int s = 0; s < 3; ++s) side[s] = mesh.length_unit() * sides[s];
  }

  /// Whether the map keeps side s within a factor of 1.5.
  bool keeps(int s) const {
    const double mapped = norm(phi[(s + 1) % 3] - phi[s]), length = norm(side[s]);
    return mapped <= 1.5 * length && length <= 1.5 * mapped;
  }
  /// Whether the map is nearly isometric here. It turns faces over where it blends the two sides of a cut.
  bool is_sound(bool orientable) const {
    return keeps(0) && keeps(1) && keeps(2) && (!orientable || cross(phi[1] - phi[0], phi[2] - phi[0]) > 0);
  }
  /// Puts the third corner where the shape of the face asks for it, to the left or right of side s.
  void follow(int s, bool left) {
    const Vec2 a = phi[s], b = phi[(s + 1) % 3], along = normalized(b - a);
    // From the middle of the side.
    const Vec2 apex = product(conj(normalized(side[s])), -0.5 * side[s] - side[(s + 2) % 3]);
    phi[(s + 2) % 3] = 0.5 * (a + b) + product(along, left ? apex : conj(apex));
  }
};

}  // namespace

std::vector<Vec2> TriangleMeshSurface::on_corners(const LogMap& map) const {
  check_map(map);
  const TriangleMesh& mesh = impl_->mesh;
  std::vector<Vec2> places(mesh.tails().size(), {nan, nan});
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (mesh.is_dropped(f)) continue;
    const std::array<Vec2, 3> side = mesh.layout(f);
    places[3 * f] = {0, 0}, places[3 * f + 1] = side[0], places[3 * f + 2] = -side[2];
  }
  const std::vector<Vec2> stored = detail::unfolded_corners(
      mesh.topology().half_edges(), {mesh.tails(), places, mesh.length_unit(), mesh.report().orientable}, map);
  std::vector<Vec2> result(stored.size(), {nan, nan});
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (mesh.is_dropped(f) && mesh.topology().stand_in(f)[0] < 0) continue;
    for (int s = 0; s < 3; ++s) result[3 * f + s] = stored[mesh.kept_corner(f, s)];
  }
  return result;
}

Sample TriangleMeshSurface::sample_in_face(const LogMap& map, const FacePoint& point) const {
  const FlipHistory::Point p = impl_->locate(point);
  const auto tail = impl_->triangulation.half_edges().tail;
  MappedFace face(impl_->mesh, impl_->triangulation.sides(p.face));
  for (int s = 0; s < 3; ++s) {
    const Index v = tail[3 * p.face + s];
    if (map.status(Vertex(v)) != Status::ok) return {nan, nan, map.status(Vertex(v))};
    face.phi[s] = coordinates(map, v);
  }
  const bool orientable = impl_->mesh.report().orientable;
  if (!face.is_sound(orientable)) {
    int side = 0;
    while (side < 3 && !face.keeps(side)) ++side;
    if (side == 3 || !orientable) return {nan, nan, Status::unreached};
    face.follow(side, true);
  }
  const Vec2 phi = p.weight[0] * face.phi[0] + p.weight[1] * face.phi[1] + p.weight[2] * face.phi[2];
  return {phi[0], phi[1], Status::ok};
}

TriangleMeshSurface::Located TriangleMeshSurface::locate(const FacePoint& point) const {
  check(point);
  const FlipHistory::Point p = impl_->locate(point);
  const auto tail = impl_->triangulation.half_edges().tail;
  return {{tail[3 * p.face], tail[3 * p.face + 1], tail[3 * p.face + 2]}, p.weight, p.depth};
}

}  // namespace ahm::trimesh
