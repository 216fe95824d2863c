#include <algorithm>
#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/surface/directions.hpp"
#include "impl.hpp"

namespace ahm::trimesh {

TriangleMeshSurface::Impl::StoredPoint TriangleMeshSurface::Impl::stored(const FacePoint& point) const {
  StoredPoint result{mesh.kept_corner(point.face, 0) / 3, {0, 0, 0}};
  for (int s = 0; s < 3; ++s) result.weight[mesh.kept_corner(point.face, s) % 3] += point.barycentric[s];
  return result;
}

FlipHistory::Point TriangleMeshSurface::Impl::locate(const FacePoint& point) const {
  auto [face, weight] = stored(point);
  double total = 0;
  for (double& w : weight) total += w = std::max(0.0, w);
  for (double& w : weight) w /= total;
  return triangulation.history().locate(face, weight);
}

Vec2 TriangleMeshSurface::Impl::input_side(Index face, int from, int to) const {
  const Half a = mesh.kept_corner(face, from), b = mesh.kept_corner(face, to);
  if (a == b) return {0, 0};
  const auto layout = mesh.layout(a / 3);
  return b == next(a) ? layout[a % 3] : -layout[b % 3];
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
    const double angle =
        frames.angle[edges.directed(h, true)] + (forward ? within : -within) * frames.corner_scale(h, k);
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
  const auto [face, weight] = stored(point);
  Vec3 corner[3], origin{0, 0, 0};
  for (int s = 0; s < 3; ++s) {
    const Index v = mesh.tails()[3 * face + s];
    corner[s] = mesh.position(Vertex(v));
    origin = origin + weight[s] * mesh.original_position(Vertex(v));
  }
  const int a = mesh.kept_corner(point.face, 0) % 3, b = mesh.kept_corner(point.face, 1) % 3;
  const Vec3 side = a != b ? corner[b] - corner[a] : corner[1] - corner[0];
  const Vec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
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

/// Looks through the fans of all vertices of `from`; only a split mesh has more than one.
std::optional<TriangleMeshSurface::Impl::Edge> TriangleMeshSurface::Impl::edge(Row from, Row to) const {
  const HalfEdges edges = mesh.topology().half_edges();
  const auto ends = rows.vertices(to);
  for (Vertex v : rows.vertices(from)) {
    const Corner start = edges.rightmost({mesh.corners()[v.index], true});
    for (Corner c = start; c.half >= 0;) {
      const Index face = c.half / 3;
      const int at = c.half % 3;
      for (int other : {(at + 1) % 3, (at + 2) % 3})
        if (std::find(ends.begin(), ends.end(), Vertex(edges.tail[3 * face + other])) != ends.end())
          return Edge{face, mesh.stored_corner(face, at), mesh.stored_corner(face, other)};
      c = edges.turn_left(c);
      if (c == start) break;
    }
  }
  return std::nullopt;
}

PlacedSource TriangleMeshSurface::source_on_edge(const EdgePoint& edge, const std::optional<Vec3>& u_axis) const {
  const FacePoint point = face_point(edge);
  PlacedSource result = source_in_face(point, u_axis);
  const std::optional<Impl::Edge> place = impl_->edge(edge.from, edge.to);
  if (u_axis || !place) return result;
  result.source = impl_->source(point, normalized(impl_->input_side(place->face, place->from, place->to)));
  if (result.frame) result.frame = turned(*result.frame, positions()[edge.to.index] - positions()[edge.from.index]);
  return result;
}

FacePoint TriangleMeshSurface::face_point(const EdgePoint& edge) const {
  const std::optional<Impl::Edge> place = impl_->edge(edge.from, edge.to);
  if (!place) return Surface::face_point(edge);  // contracted, or no edge
  FacePoint point{place->face, {0, 0, 0}};
  point.barycentric[place->from] = 1 - edge.t;
  point.barycentric[place->to] = edge.t;
  return point;
}

}  // namespace ahm::trimesh
