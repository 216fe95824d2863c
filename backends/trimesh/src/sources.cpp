#include <algorithm>
#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/surface/directions.hpp"
#include "impl.hpp"

namespace ahm::trimesh {
FlipHistory::Point TriangleMeshSurface::Impl::locate(const FacePoint& point) const {
  std::array<double, 3> weight;
  double total = 0;
  for (int s = 0; s < 3; ++s) total += weight[mesh.stored_corner(point.face, s)] = std::max(0.0, point.barycentric[s]);
  for (double& w : weight) w /= total;
  return triangulation.history().locate(point.face, weight);
}

Vec2 TriangleMeshSurface::Impl::input_side(Index face, int from, int to) const {
  const auto layout = mesh.layout(face);
  const int a = mesh.stored_corner(face, from), b = mesh.stored_corner(face, to);
  return b == (a + 1) % 3 ? layout[a] : -layout[b];
}

Source TriangleMeshSurface::Impl::source(const FacePoint& point, Vec2 u) const {
  const FlipHistory::Point p = locate(point);
  const HalfEdges edges = triangulation.half_edges();
  const Vec2* side = triangulation.sides(p.face);
  const Vec2 corner[3] = {{0, 0}, side[0], -side[2]};
  const Vec2 at = p.weight[1] * corner[1] + p.weight[2] * corner[2];
  const Vec2 u_here = p.map(u);
  const double size = std::max({norm(side[0]), norm(side[1]), norm(side[2])});
  Source source(2);
  for (int s = 0; s < 3; ++s) {
    if (!(p.weight[s] > 0)) continue;
    const Half h = 3 * p.face + s;
    const Vec2 offset = corner[s] - at;
    const Vec2 z = product(conj(u_here), offset);
    const double position[] = {mesh.length_unit() * z[0], mesh.length_unit() * (p.map.mirrored ? -z[1] : z[1])};

    // Transport along the straight line to the corner: its direction has a known angle in the frame there.
    const double full = triangulation.angle(h);
    const bool at_corner = !(norm(offset) > 1e-14 * size);
    const double within = at_corner ? 0.5 * full : std::clamp(angle_between(side[s], -offset), 0.0, full);
    const Vec2 back = at_corner ? product(unit(within), normalized(side[s])) : normalized(-offset);
    const Index k = edges.tail[h];
    const bool forward = frames.forward(edges, h, true);
    const double angle = frames.angle[edges.directed(h, true)] + (forward ? within : -within) * frames.scale[k];
    Vec2 axis = product(u_here, conj(back));
    if (!forward) axis = conj(axis);
    axis = normalized(product(axis, unit(angle)));
    // v is u turned left in the source's layout; every change of orientation on the way turns it right.
    const bool reflects = p.map.mirrored == forward;
    const double axes[] = {axis[0], reflects ? axis[1] : -axis[1], axis[1], reflects ? -axis[0] : axis[0]};
    source.add(Vertex(k), p.weight[s], position, axes);
  }
  return source;
}

std::optional<Frame> TriangleMeshSurface::Impl::frame(const FacePoint& point) const {
  if (!mesh.has_positions()) return std::nullopt;
  Vec3 corner[3], origin{0, 0, 0};
  for (int s = 0; s < 3; ++s) {
    const Index v = mesh.tails()[3 * point.face + mesh.stored_corner(point.face, s)];
    corner[s] = mesh.position(v);
    origin = origin + point.barycentric[s] * mesh.original_position(v);
  }
  const Vec3 side = corner[1] - corner[0], other = corner[2] - corner[0];
  Vec3 normal = cross(side, other);
  if (mesh.reversed()[point.face]) normal = -1.0 * normal;
  if (!(norm(side) > 0) || !(norm(normal) > 0)) return std::nullopt;
  const Vec3 x = 1 / norm(side) * side, n = 1 / norm(normal) * normal;
  return Frame{origin, x, cross(n, x), n};
}

PlacedSource TriangleMeshSurface::source_in_face(const FacePoint& point, const std::optional<Vec3>& u_axis) const {
  std::optional<Frame> frame = impl_->frame(point);
  const Vec2 side = impl_->input_side(point.face, 0, 1);
  Vec2 u = norm(side) > 0 ? normalized(side) : Vec2{1, 0};
  if (u_axis) {
    const std::string where = "in face " + std::to_string(point.face);
    if (!frame)
      throw InvalidArgument(where.substr(3) +
                            " has no plane in space (no positions, or no area), so a direction in space "
                            "has no meaning");
    const auto [x, y] = projected(frame->x, frame->y, *u_axis, where);
    u = normalized(product(normalized(Vec2{x, y}), u));
    frame = turned(*frame, *u_axis);
  }
  return {impl_->source(point, u), impl_->mesh.has_positions() ? position(point) : Vec3{}, frame, std::nullopt};
}

PlacedSource TriangleMeshSurface::source_on_edge(const EdgePoint& edge, const std::optional<Vec3>& u_axis) const {
  const FacePoint point = face_point(edge);
  PlacedSource result = source_in_face(point, u_axis);
  if (u_axis) return result;
  const auto given = faces()[point.face];
  const auto corner = [&](Row row) {
    return static_cast<int>(std::find(given.begin(), given.end(), row.index) - given.begin());
  };
  const Vec2 u = impl_->input_side(point.face, corner(edge.from), corner(edge.to));
  result.source = impl_->source(point, norm(u) > 0 ? normalized(u) : Vec2{1, 0});
  if (result.frame) result.frame = turned(*result.frame, positions()[edge.to.index] - positions()[edge.from.index]);
  return result;
}

/// Looks through the fans of all copies of `from`; only a split mesh has more than one.
FacePoint TriangleMeshSurface::face_point(const EdgePoint& edge) const {
  const TriangleMesh& mesh = impl_->mesh;
  const HalfEdges edges = mesh.topology().half_edges();
  for (Vertex v : rows().vertices(edge.from)) {
    const Corner start = edges.rightmost({mesh.corners()[v.index], true});
    for (Corner c = start; c.half >= 0;) {
      const Index face = c.half / 3;
      const int at = c.half % 3;
      for (int other : {(at + 1) % 3, (at + 2) % 3}) {
        if (mesh.input_of_vertex()[edges.tail[3 * face + other]] != edge.to.index) continue;
        FacePoint point{face, {0, 0, 0}};
        point.barycentric[mesh.stored_corner(face, at)] = 1 - edge.t;
        point.barycentric[mesh.stored_corner(face, other)] = edge.t;
        return point;
      }
      c = edges.turn_left(c);
      if (c == start) break;
    }
  }
  throw InvalidArgument("rows " + std::to_string(edge.from.index) + " and " + std::to_string(edge.to.index) +
                        " are not joined by an edge");
}

}  // namespace ahm::trimesh
