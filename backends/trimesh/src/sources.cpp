#include <algorithm>
#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "impl.hpp"

namespace ahm::trimesh {
namespace {

/// A unit vector along `direction` projected to the plane of two orthonormal axes.
Vec2 project(const Vec3& x, const Vec3& y, const Vec3& direction, const std::string& where) {
  double largest = std::max({std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2])});
  if (!(largest > 0) || !std::isfinite(largest))
    throw InvalidArgument("the u direction " + where + " must be finite and not zero");
  const Vec3 scaled = 1 / largest * direction;
  const Vec2 p{dot(x, scaled), dot(y, scaled)};
  if (!(norm(p) > 1e-9)) throw InvalidArgument("the u direction is perpendicular to the surface " + where);
  return normalized(p);
}

}  // namespace

FlipHistory::Point TriangleMeshGraph::Impl::locate(const SurfacePoint& point) const {
  const auto& b = point.barycentric;
  if (point.face < 0 || point.face >= mesh.face_count())
    throw InvalidArgument("face " + std::to_string(point.face) + " is outside [0, " +
                          std::to_string(mesh.face_count()) + ")");
  const double sum = b[0] + b[1] + b[2];
  if (!(std::abs(sum - 1) <= 1e-9) || !(std::min({b[0], b[1], b[2]}) >= -1e-9))
    throw InvalidArgument("barycentric coordinates (" + detail::number(b[0]) + ", " + detail::number(b[1]) + ", " +
                          detail::number(b[2]) + ") in face " + std::to_string(point.face) +
                          " must be >= 0 and sum to 1");
  std::array<double, 3> weight;
  double total = 0;
  for (int s = 0; s < 3; ++s) total += weight[mesh.stored_corner(point.face, s)] = std::max(0.0, b[s]);
  for (double& w : weight) w /= total;
  return triangulation.history().locate(point.face, weight);
}

Vec2 TriangleMeshGraph::Impl::input_side(Index face, int from, int to) const {
  const auto layout = mesh.layout(face);
  const int a = mesh.stored_corner(face, from), b = mesh.stored_corner(face, to);
  const auto& side = layout[b == (a + 1) % 3 ? a : b];
  const Vec2 v{side[0], side[1]};
  return b == (a + 1) % 3 ? v : -v;
}

Source TriangleMeshGraph::Impl::source(const SurfacePoint& point, Vec2 u) const {
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
    const Vec2 z = conj(u_here) * offset;
    const double position[] = {mesh.length_unit() * z.x, mesh.length_unit() * (p.map.mirrored ? -z.y : z.y)};

    // Transport along the straight line to the corner: its direction has a known angle in the frame there.
    const double full = triangulation.angle(h);
    const bool at_corner = !(norm(offset) > 1e-14 * size);
    const double within = at_corner ? 0.5 * full : std::clamp(angle_between(side[s], -offset), 0.0, full);
    const Vec2 back = at_corner ? unit(within) * normalized(side[s]) : normalized(-offset);
    const Index k = edges.tail[h];
    const bool forward = frames.forward(edges, h, true);
    const double angle = frames.angle[edges.directed(h, true)] + (forward ? within : -within) * frames.scale[k];
    Vec2 axis = u_here * conj(back);
    if (!forward) axis = conj(axis);
    axis = normalized(axis * unit(angle));
    // v is u turned left in the source's layout; every change of orientation on the way turns it right.
    const bool reflects = p.map.mirrored == forward;
    const double axes[] = {axis.x, reflects ? axis.y : -axis.y, axis.y, reflects ? -axis.x : axis.x};
    source.add(Vertex(k), p.weight[s], position, axes);
  }
  return source;
}

Vertex TriangleMeshGraph::vertex(Index input_vertex) const {
  const auto map = impl_->mesh.vertex_of_input();
  if (input_vertex < 0 || static_cast<std::size_t>(input_vertex) >= map.size())
    throw InvalidArgument("source vertex " + std::to_string(input_vertex) + " is outside [0, " +
                          std::to_string(map.size()) + ")");
  if (map[input_vertex] < 0)
    throw InvalidArgument("source vertex " + std::to_string(input_vertex) + " is used by no face; choose another");
  return Vertex(map[input_vertex]);
}

std::array<double, 2> TriangleMeshGraph::direction_in_frame(Vertex vertex, const Vec3& direction) const {
  if (vertex.index < 0 || vertex.index >= impl_->graph.size())
    throw InvalidArgument("vertex " + std::to_string(vertex.index) + " is outside [0, " +
                          std::to_string(impl_->graph.size()) + ")");
  const auto frame = impl_->graph.frame(vertex.index);
  if (!frame) throw InvalidArgument("the mesh was given by edge lengths, so a direction in space has no meaning");
  const Vec2 u = project(frame->x, frame->y, direction,
                         "at vertex " + std::to_string(impl_->mesh.input_of_vertex()[vertex.index]));
  return {u.x, u.y};
}

Source TriangleMeshGraph::source_at_vertex(Index input_vertex) const { return Source::at_vertex(vertex(input_vertex)); }

Source TriangleMeshGraph::source_at_vertex(Index input_vertex, const Vec3& u_direction) const {
  const Vertex v = vertex(input_vertex);
  return Source::at_vertex(v, direction_in_frame(v, u_direction));
}

Source TriangleMeshGraph::source_at(const SurfacePoint& point) const {
  impl_->locate(point);  // checks
  const Vec2 u = impl_->input_side(point.face, 0, 1);
  return impl_->source(point, norm(u) > 0 ? normalized(u) : Vec2{1, 0});
}

std::optional<Frame> TriangleMeshGraph::frame_at(const SurfacePoint& point) const {
  impl_->locate(point);  // checks
  const TriangleMesh& mesh = impl_->mesh;
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

Source TriangleMeshGraph::source_at(const SurfacePoint& point, const Vec3& u_direction) const {
  const auto frame = frame_at(point);
  if (!frame)
    throw InvalidArgument("face " + std::to_string(point.face) +
                          " has no plane in space (no positions, or no area), so a direction "
                          "in space has no meaning");
  const Vec2 u = project(frame->x, frame->y, u_direction, "in face " + std::to_string(point.face));
  return impl_->source(point, normalized(u * normalized(impl_->input_side(point.face, 0, 1))));
}

Source TriangleMeshGraph::source_at_edge(Index from, Index to, double t) const {
  if (!(t >= 0 && t <= 1)) throw InvalidArgument("t is " + detail::number(t) + "; it must be in [0, 1]");
  const TriangleMesh& mesh = impl_->mesh;
  const HalfEdges edges(mesh);
  vertex(from), vertex(to);  // check
  auto input = [&](Half h) { return mesh.input_of_vertex()[edges.tail[h]]; };
  // The fans of all copies of `from`; only a split mesh has more than one.
  for (Index v = mesh.vertex_of_input()[from]; v < mesh.vertex_count(); ++v) {
    if (mesh.input_of_vertex()[v] != from) {
      v = std::max(v, mesh.report().vertices - mesh.report().unreferenced - 1);
      continue;
    }
    const Corner start = edges.rightmost({mesh.corners()[v], true});
    for (Corner c = start; c.half >= 0;) {
      const Index face = c.half / 3;
      const int at = c.half % 3;
      for (int other : {(at + 1) % 3, (at + 2) % 3}) {
        if (input(3 * face + other) != to) continue;
        SurfacePoint point{face, {0, 0, 0}};
        const int a = mesh.stored_corner(face, at), b = mesh.stored_corner(face, other);
        point.barycentric[a] = 1 - t;
        point.barycentric[b] = t;
        const Vec2 u = impl_->input_side(face, a, b);
        return impl_->source(point, norm(u) > 0 ? normalized(u) : Vec2{1, 0});
      }
      c = edges.turn_left(c);
      if (c == start) break;
    }
  }
  throw InvalidArgument("vertices " + std::to_string(from) + " and " + std::to_string(to) +
                        " are not joined by an edge");
}

}  // namespace ahm::trimesh
