#include "ahm/surface/exact/shortened_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shorten.hpp"
#include "walk.hpp"

namespace ahm::exact {
namespace {

using std::numbers::pi;

const Place& other_end(const Portal& portal, const Bend& bend) { return bend.left ? portal.right : portal.left; }

/// The angle at a bend on the side of the strip.
double angle_in_strip(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line, std::size_t k) {
  const Bend& bend = line.bends[k];
  const auto to_edge = [&](const Bend& neighbor, std::size_t portal) {
    return angle_between(neighbor.at - bend.at, other_end(line.portals[portal], bend) - bend.at);
  };
  double sum = to_edge(line.bends[k - 1], bend.arrives) + to_edge(line.bends[k + 1], bend.leaves);
  for (std::size_t p = bend.arrives; p < bend.leaves; ++p) sum += surface.angle(corner_after(strip, line, bend, p));
  return sum;
}

/// Takes the strip around the other side of bends where that is shorter, apart from each other.
/// @return whether there was one
bool flip_bends(const PolyhedralSurface& surface, Strip& strip, const TautLine& line) {
  std::vector<Half> entered;
  std::size_t done = 0;
  for (std::size_t k = 1; k + 1 < line.bends.size(); ++k) {
    const Bend& bend = line.bends[k];
    if (bend.arrives < done) continue;
    const Index vertex = surface.record(corner_after(strip, line, bend, bend.arrives)).tail;
    if (!(surface.angle_sum(vertex) - angle_in_strip(surface, strip, line, k) < pi - straight_margin)) continue;
    const auto around = other_side(surface, strip, line, bend);
    if (!around) continue;
    for (; done < bend.arrives; ++done) enter(surface, entered, strip.entered[done]);
    for (Half h : *around) enter(surface, entered, h);
    done = bend.leaves + 1;
  }
  if (done == 0) return false;
  for (; done < strip.entered.size(); ++done) enter(surface, entered, strip.entered[done]);
  strip.entered = std::move(entered);
  return true;
}

/// The direction in which a line leaves an end, as in `ExactMap::direction`.
/// @param towards  in the frame of side 0 of the face of the end
double direction_at(const PolyhedralSurface& surface, const CurveEnd& end, const Place& towards) {
  if (end.corner >= 0) {
    const Index vertex = surface.record(end.corner).tail;
    return angle_at_vertex(surface, end.corner, from_first_side(surface, end.corner, towards)) *
           surface.angle_scale(vertex);
  }
  const Vec2 way = towards - surface.place(end.point);
  const double angle = std::atan2(way[1], way[0]);
  return angle < 0 ? angle + 2 * pi : angle;
}

MeshPoint at_corner(Half corner) {
  MeshPoint point{corner / 3, {0, 0, 0}};
  point.barycentric[corner % 3] = 1;
  return point;
}

}  // namespace

std::optional<std::vector<Half>> other_side(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line,
                                            const Bend& bend) {
  const Half first = strip.entered[bend.arrives], side = beyond(surface, first);
  const bool at_tail = line.portals[bend.arrives].tail_left == bend.left;
  const Half from = at_tail == mirrored_beyond(surface, side) ? side : next(side);
  // As the face before sees it: the side crossed is the right one of the corner that it starts at, else the left one.
  const bool left_now = from != side;
  return turn(surface, from, corner_after(strip, line, bend, bend.leaves), !left_now);
}

Half corner_after(const Strip& strip, const TautLine& line, const Bend& bend, std::size_t portal) {
  const Half h = strip.entered[portal];
  return line.portals[portal].tail_left == bend.left ? h : next(h);
}

TautLine shorten(const PolyhedralSurface& surface, Strip& strip) {
  trim(surface, strip);
  TautLine line = pull_taut(surface, strip);
  for (;;) {
    Strip flipped = strip;
    if (!flip_bends(surface, flipped, line)) return line;
    trim(surface, flipped);
    TautLine shorter = pull_taut(surface, flipped);
    if (!(shorter.length < line.length)) return line;  // by rounding
    strip = std::move(flipped);
    line = std::move(shorter);
  }
}

GeodesicPath path_along(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line) {
  GeodesicPath path;
  path.source = 0;
  path.length = line.length;
  path.start_direction = direction_at(surface, strip.start, line.bends[1].at);
  path.end_direction = direction_at(surface, strip.end, line.arrival);
  path.points.push_back(strip.start.point);
  const std::vector<double> share = line.crossings();
  std::size_t bend = 1;
  for (std::size_t p = 0; p < share.size(); ++p) {
    while (bend + 1 < line.bends.size() && p > line.bends[bend].leaves) ++bend;
    const Bend& at = line.bends[bend];
    if (bend + 1 < line.bends.size() && p >= at.arrives) {
      if (p == at.arrives) path.points.push_back(at_corner(corner_after(strip, line, at, p)));
      // The next bend may be the other end of this portal.
      if (const Bend& then = line.bends[bend + 1]; bend + 2 < line.bends.size() && then.arrives == p)
        path.points.push_back(at_corner(corner_after(strip, line, then, p)));
      continue;
    }
    const double along = line.portals[p].tail_left ? share[p] : 1 - share[p];
    path.points.push_back(point_on(surface, strip.entered[p], along * surface.record(strip.entered[p]).length));
  }
  path.points.push_back(strip.end.point);
  return path;
}

GeodesicPath shortened_path(const PolyhedralSurface& surface, std::span<const MeshPoint> curve) {
  Strip strip = strip_along(surface, curve);
  const TautLine line = shorten(surface, strip);
  return path_along(surface, strip, line);
}

}  // namespace ahm::exact
