#include "walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ahm::exact {
namespace {

/// The line in a frame to which `place` takes points.
template <class Map>
Line mapped(const Line& line, Half half, const Map& place) {
  const Place start = place(line.start), ahead = place({0, 0});
  const Place tip = place(line.direction) - ahead;
  return {half, start, tip, line.walked};
}

/// Where the line crosses the side from a to b, which is `length` long; ends count as part of the side.
Exit crossing(const Line& line, Half side, const Place& a, const Place& b, double length) {
  const Place run = b - a;
  const double across = cross(line.direction, run);
  const double part = across != 0 ? std::clamp(cross(line.direction, line.start - a) / across, 0.0, 1.0) : 0.0;
  const Place hit = a + part * run;
  return {dot(hit - line.start, line.direction), side, part * length};
}

}  // namespace

Line in_frame_of(const PolyhedralSurface& surface, Line line, Half half) {
  while (line.half != half) {
    const HalfRecord& r = surface.record(line.half);
    line = mapped(line, next(line.half), [&](const Place& p) { return in_next(r, p); });
  }
  return line;
}

Exit leave_through(const PolyhedralSurface& surface, const Line& line, Half side) {
  const HalfRecord& r = surface.record(line.half);
  if (side == line.half) return crossing(line, side, {0, 0}, {r.length, 0}, r.length);
  return side == next(line.half) ? crossing(line, side, {r.length, 0}, apex(r), r.right)
                                 : crossing(line, side, apex(r), {0, 0}, r.left);
}

Exit leave_upwards(const PolyhedralSurface& surface, const Line& line) {
  const bool left = cross(apex(surface.record(line.half)) - line.start, line.direction) > 0;
  return leave_through(surface, line, left ? previous(line.half) : next(line.half));
}

Exit leave(const PolyhedralSurface& surface, const Line& line) {
  const HalfRecord& r = surface.record(line.half);
  const Place corner[] = {{0, 0}, {r.length, 0}, apex(r)};
  const Half side[] = {line.half, next(line.half), previous(line.half)};
  double soonest = std::numeric_limits<double>::infinity();
  int through = 0;
  for (int s = 0; s < 3; ++s) {
    const Place a = corner[s], run = corner[(s + 1) % 3] - a;
    const double outwards = cross(line.direction, run);
    if (outwards <= 1e-14 * norm(run)) continue;
    const double walked = cross(a - line.start, run) / outwards;
    if (walked >= soonest) continue;
    soonest = walked;
    through = s;
  }
  return leave_through(surface, line, side[through]);
}

Line cross_side(const PolyhedralSurface& surface, const Line& line, const Exit& exit) {
  // In the frame whose left side is the exit.
  const Line seen = in_frame_of(surface, line, next(exit.side));
  const HalfRecord& r = surface.record(seen.half);
  Line beyond = mapped(seen, r.beyond_left, [&](const Place& p) {
    const Place q = beyond_left(r, p);
    return r.mirrored & 1 ? Place{r.left - q[0], q[1]} : q;
  });
  beyond.walked = exit.walked;
  return beyond;
}

/// Beside a needle by rounding, weights may be far from those of any point nearby: then it is the nearest of its sides.
MeshPoint point_of(const PolyhedralSurface& surface, Half half, const Place& place) {
  const HalfRecord& r = surface.record(half);
  const double up = place[1] / r.apex_y, ahead = (place[0] - up * r.apex_x) / r.length;
  if (up >= 0 && ahead >= 0 && up + ahead <= 1) {
    MeshPoint point{half / 3, {}};
    point.barycentric[half % 3] = std::max(0.0, 1 - up - ahead);
    point.barycentric[next(half) % 3] = ahead;
    point.barycentric[previous(half) % 3] = up;
    return point;
  }
  const Place corner[] = {{0, 0}, {r.length, 0}, apex(r)};
  const Half side[] = {half, next(half), previous(half)};
  const double length[] = {r.length, r.right, r.left};
  double nearest = std::numeric_limits<double>::infinity(), along = 0;
  int on = 0;
  for (int s = 0; s < 3; ++s) {
    const Place run = (1 / length[s]) * (corner[(s + 1) % 3] - corner[s]);
    const double t = std::clamp(dot(place - corner[s], run), 0.0, length[s]);
    const double away = norm(place - (corner[s] + t * run));
    if (!(away < nearest)) continue;
    nearest = away;
    along = t;
    on = s;
  }
  return point_on(surface, side[on], along);
}

MeshPoint point_on(const PolyhedralSurface& surface, Half side, double along) {
  const double part = std::clamp(along / surface.record(side).length, 0.0, 1.0);
  MeshPoint point{side / 3, {0, 0, 0}};
  point.barycentric[side % 3] = 1 - part;
  point.barycentric[next(side) % 3] = part;
  return point;
}

Line line_from(Half half, const Place& place, double angle) {
  return {half, place, {std::cos(angle), std::sin(angle)}, 0};
}

Line line_from_vertex(const PolyhedralSurface& surface, Index vertex, double angle) {
  Corner c = surface.first_corner(vertex);
  for (;;) {
    const double width = surface.angle(c.half);
    const Corner left = surface.turn_left(c);
    if (angle <= width || left.half < 0 || left == surface.first_corner(vertex))
      return line_from(c.half, {0, 0}, std::clamp(c.forward ? angle : width - angle, 0.0, width));
    angle -= width;
    c = left;
  }
}

double angle_in_face(const PolyhedralSurface& surface, const Line& line) {
  const Line seen = in_frame_of(surface, line, 3 * (line.half / 3));
  return std::atan2(seen.direction[1], seen.direction[0]);
}

double angle_at_vertex(const PolyhedralSurface& surface, Half corner, const Place& towards) {
  const double width = surface.angle(corner), within = std::clamp(std::atan2(towards[1], towards[0]), 0.0, width);
  double turned = 0;
  for (Corner c = surface.first_corner(surface.record(corner).tail);; c = surface.turn_left(c)) {
    if (c.half == corner) return turned + (c.forward ? within : width - within);
    turned += surface.angle(c.half);
  }
}

}  // namespace ahm::exact
