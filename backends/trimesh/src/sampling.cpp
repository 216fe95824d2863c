#include <algorithm>
#include <cmath>
#include <limits>

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

/// The faces of the input mesh with the map on them: sound ones as they are, others unfolded from the nearest sound
/// one.
class Unfolding {
 public:
  Unfolding(const TriangleMesh& mesh, const LogMap& map)
      : mesh_(mesh),
        edges_(mesh.topology().half_edges()),
        phi_(mesh.tails().size()),
        done_(static_cast<std::size_t>(mesh.face_count()), no) {
    std::vector<Index> front;
    for (Index f = 0; f < mesh.face_count(); ++f) {
      if (mesh.is_dropped(f)) continue;
      MappedFace face = mapped(f);
      bool ok = true;
      for (int s = 0; s < 3; ++s) {
        const Index v = edges_.tail[3 * f + s];
        ok = ok && map.status(Vertex(v)) == Status::ok;
        if (ok) phi_[3 * f + s] = face.phi[s] = coordinates(map, v);
      }
      if (!ok) {
        done_[f] = masked;
      } else if (face.is_sound(mesh.report().orientable)) {
        done_[f] = yes;
        front.push_back(f);
      }
    }
    for (std::size_t at = 0; at < front.size(); ++at)
      for (Half h = 3 * front[at]; h < 3 * front[at] + 3; ++h) unfold_across(h, front);
  }

  bool known(Index face) const { return done_[face] == yes; }
  Vec2 phi(Half corner) const { return phi_[corner]; }

 private:
  enum : std::uint8_t { no, yes, masked };

  MappedFace mapped(Index f) const { return MappedFace(mesh_, mesh_.layout(f).data()); }

  void unfold_across(Half h, std::vector<Index>& front) {
    const Half t = edges_.twin[h];
    if (t < 0 || done_[t / 3] != no) return;
    MappedFace face = mapped(t / 3);
    const Vec2 a = phi_[h], b = phi_[next(h)], apex = phi_[previous(h)];
    const bool same_way = edges_.is_mirrored(h);
    face.phi[t % 3] = same_way ? a : b;
    face.phi[(t + 1) % 3] = same_way ? b : a;
    if (!(norm(b - a) > 0) || !(norm(face.side[t % 3]) > 0)) return;
    // On the other side of the edge than the face it is unfolded from.
    face.follow(t % 3, (cross(b - a, apex - a) > 0) != same_way);
    for (int s = 0; s < 3; ++s) phi_[3 * (t / 3) + s] = face.phi[s];
    done_[t / 3] = yes;
    front.push_back(t / 3);
  }

  const TriangleMesh& mesh_;
  HalfEdges edges_;
  std::vector<Vec2> phi_;  ///< per half-edge: at the corner of its start
  std::vector<std::uint8_t> done_;
};

}  // namespace

std::vector<Vec2> TriangleMeshSurface::on_corners(const LogMap& map) const {
  check_map(map);
  const TriangleMesh& mesh = impl_->mesh;
  const Unfolding unfolding(mesh, map);
  std::vector<Vec2> result(mesh.tails().size(), {nan, nan});
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (!unfolding.known(f)) continue;
    for (int s = 0; s < 3; ++s) result[3 * f + mesh.stored_corner(f, s)] = unfolding.phi(3 * f + s);
  }
  for (Index f = 0; f < mesh.face_count(); ++f)
    if (mesh.is_dropped(f) && mesh.topology().stand_in(f)[0] >= 0 && unfolding.known(mesh.kept_corner(f, 0) / 3))
      for (int s = 0; s < 3; ++s) result[3 * f + s] = unfolding.phi(mesh.kept_corner(f, s));
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
