#include "flat_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ahm/surface/gluing.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {
namespace {

using exact::Corner;
using exact::Half;

/// Triangles glued along their edges, most of them counter-clockwise about their normals.
struct GluedTriangles {
  std::vector<Index> tail;
  std::vector<Half> twin;
  std::vector<std::uint8_t> mirrored;  ///< empty: orientable

  exact::HalfEdges edges() const { return {tail, twin, mirrored}; }
};

GluedTriangles glue_triangles(std::span<const Frame> frames, std::span<const Triangle> triangles) {
  GluedTriangles result;
  std::vector<Offset> begin{0};
  for (const Triangle& t : triangles) {
    const Vec3 a = frames[t[1]].origin - frames[t[0]].origin, b = frames[t[2]].origin - frames[t[0]].origin;
    const bool up = dot(cross(a, b), frames[t[0]].normal) > 0;
    result.tail.insert(result.tail.end(), {t[0], up ? t[1] : t[2], up ? t[2] : t[1]});
    begin.push_back(static_cast<Offset>(result.tail.size()));
  }
  const detail::Gluing gluing =
      detail::glue(static_cast<Index>(frames.size()), {begin, result.tail}, NonManifold::error);
  // Turning a face over swaps its sides 0 and 2.
  const auto placed = [&](Half h) { return gluing.reversed[h / 3] ? h - h % 3 + 2 - h % 3 : h; };
  std::vector<Index> tail(result.tail.size());
  result.twin.assign(tail.size(), -1);
  Half boundary = 0;
  for (Half h = 0; h < static_cast<Half>(tail.size()); ++h) {
    const Half at = placed(h);
    tail[at] = gluing.reversed[h / 3] ? result.tail[detail::next(h)] : result.tail[h];
    result.twin[at] = gluing.partner[h] >= 0 ? placed(gluing.partner[h]) : -1 - boundary++;
  }
  result.tail = std::move(tail);
  if (gluing.orientable) return result;
  result.mirrored.assign(result.tail.size(), 0);
  for (Half h = 0; h < static_cast<Half>(result.tail.size()); ++h)
    if (result.twin[h] >= 0) result.mirrored[h] = result.tail[h] == result.tail[result.twin[h]];
  return result;
}

/// A triangle in its own plane.
exact::FaceSides lay_out(const GluedTriangles& glued, std::span<const Frame> frames, Index face) {
  const auto corner = [&](int s) { return frames[glued.tail[3 * face + s]].origin; };
  const Vec3 a = corner(1) - corner(0), b = corner(2) - corner(0);
  const double base = norm(a), along = dot(a, b) / base, height = norm(cross(a, b)) / base;
  return {Vec2{base, 0}, Vec2{along - base, height}, Vec2{-along, -height}};
}

/// One half-edge that starts at each vertex; -1: none.
std::vector<Half> corners_of(const GluedTriangles& glued, std::size_t vertices) {
  std::vector<Half> corners(vertices, -1);
  for (Half h = static_cast<Half>(glued.tail.size()); h-- > 0;) corners[glued.tail[h]] = h;
  return corners;
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
  const GluedTriangles glued = glue_triangles(frames, triangles);
  FlatTriangles flat{
      {glued.edges(), [&](Index f) { return lay_out(glued, frames, f); }, corners_of(glued, frames.size())},
      {},
      length_unit,
      true};
  flat.positions.reserve(frames.size());
  for (const Frame& frame : frames) flat.positions.push_back(length_unit * frame.origin);
  flat.angles.assign(frames.size(), 0);
  flat.mirrored.assign(frames.size(), 0);
  for (Index v = 0; v < static_cast<Index>(frames.size()); ++v) fit_direction(flat, frames, v);
  return flat;
}

}  // namespace ahm::pointcloud
