#include "flat_sheet.hpp"

#include <cmath>
#include <vector>

#include "ahm/surface/glued_mesh.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {
namespace {

using exact::Corner;
using exact::Half;

/// Glued along their edges, as given counter-clockwise about the normals of their first corners.
detail::GluedMesh glued(std::span<const Frame> frames, std::span<const Triangle> triangles) {
  std::vector<Offset> begin{0};
  std::vector<Index> corners;
  for (const Triangle& t : triangles) {
    const Vec3 a = frames[t[1]].origin - frames[t[0]].origin, b = frames[t[2]].origin - frames[t[0]].origin;
    const bool up = dot(cross(a, b), frames[t[0]].normal) > 0;
    corners.insert(corners.end(), {t[0], up ? t[1] : t[2], up ? t[2] : t[1]});
    begin.push_back(static_cast<Offset>(corners.size()));
  }
  return {static_cast<Index>(frames.size()), {begin, corners}, NonManifold::error};
}

/// A triangle in its own plane.
exact::FaceSides lay_out(std::span<const Index> tails, std::span<const Frame> frames, Index face) {
  const auto corner = [&](int s) { return frames[tails[3 * face + s]].origin; };
  const Vec3 a = corner(1) - corner(0), b = corner(2) - corner(0);
  const double base = norm(a), along = dot(a, b) / base, height = norm(cross(a, b)) / base;
  return {Vec2{base, 0}, Vec2{along - base, height}, Vec2{-along, -height}};
}

/// With the vertices of the graph, of which a mesh has those alone that it uses.
exact::PolyhedralSurface surface_of(const detail::GluedMesh& mesh, std::span<const Frame> frames) {
  exact::HalfEdges edges = mesh.half_edges();
  const auto vertices = mesh.input_of_vertex();
  std::vector<Index> tails(edges.tail.begin(), edges.tail.end());
  for (Index& tail : tails) tail = vertices[tail];
  edges.tail = tails;
  std::vector<Half> corners(frames.size(), -1);
  for (Index v = 0; v < mesh.vertex_count(); ++v) corners[vertices[v]] = mesh.corners()[v];
  return {edges, [&](Index f) { return lay_out(tails, frames, f); }, corners};
}

/// Finds the angle of direction 0 in the frame of a vertex: the mean, over its edges, of what their angles differ by.
void fit_direction(FlatTriangles& flat, std::span<const Frame> frames, Index v) {
  const Corner start = flat.surface.first_corner(v);
  if (start.half < 0) return;
  const Frame& frame = frames[v];
  const exact::HalfRecord first = flat.surface.record(start.half);
  const auto to = [&](Index w) { return frames[w].origin - frame.origin; };
  const bool is_up = dot(cross(to(first.head), to(first.apex)), frame.normal) > 0;
  flat.mirrored[v] = is_up != start.forward;
  const double scale = flat.surface.angle_scale(v), side = flat.mirrored[v] ? -1 : 1;
  Vec2 sum{};
  double turned = 0;
  const auto add = [&](Index w) {
    const double angle = std::atan2(dot(frame.y, to(w)), dot(frame.x, to(w))) - side * scale * turned;
    sum = sum + Vec2{std::cos(angle), std::sin(angle)};
  };
  for (Corner c = start;;) {
    const exact::HalfRecord r = flat.surface.record(c.half);
    add(c.forward ? r.head : r.apex);
    turned += flat.surface.angle(c.half);
    const Corner left = flat.surface.turn_left(c);
    if (left.half < 0) add(c.forward ? r.apex : r.head);
    if (left.half < 0 || left == start) break;
    c = left;
  }
  flat.angles[v] = std::atan2(sum[1], sum[0]);
}

}  // namespace

FlatTriangles flat_sheet(std::span<const Frame> frames, std::span<const Triangle> triangles, double length_unit) {
  FlatTriangles flat{surface_of(glued(frames, triangles), frames), {}, length_unit, true};
  flat.positions.reserve(frames.size());
  for (const Frame& frame : frames) flat.positions.push_back(length_unit * frame.origin);
  flat.angles.assign(frames.size(), 0);
  flat.mirrored.assign(frames.size(), 0);
  for (Index v = 0; v < static_cast<Index>(frames.size()); ++v) fit_direction(flat, frames, v);
  return flat;
}

}  // namespace ahm::pointcloud
