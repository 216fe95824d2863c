#include "strip.hpp"

#include <algorithm>
#include <string>

#include "ahm/error.hpp"
#include "check_point.hpp"

namespace ahm::exact {
namespace {

/// The corner of a face at a vertex; -1: none.
Half corner_at(const PolyhedralSurface& surface, Index face, Index vertex) {
  for (Half h = 3 * face; h < 3 * face + 3; ++h)
    if (surface.record(h).tail == vertex) return h;
  return -1;
}

/// A point of a curve: a vertex, a point of a side, or of the inside of a face.
struct Spot {
  MeshPoint point;
  Index vertex = -1;
  Half side = -1;

  Spot(const PolyhedralSurface& surface, const MeshPoint& p, std::size_t number)
      : point(checked(surface, p, "point " + std::to_string(number) + " of the curve")),
        vertex(vertex_of(surface, point)) {
    for (int s = 0; s < 3 && vertex < 0; ++s)
      if (point.barycentric[s] == 0) side = 3 * point.face + (s + 1) % 3;
  }

  bool lies_in(const PolyhedralSurface& surface, Index face) const {
    if (vertex >= 0) return corner_at(surface, face, vertex) >= 0;
    if (point.face == face) return true;
    const Half other = side < 0 ? -1 : beyond(surface, side);
    return other >= 0 && other / 3 == face;
  }

  CurveEnd in_face(const PolyhedralSurface& surface, Index face) const {
    CurveEnd end{point, vertex < 0 ? -1 : corner_at(surface, face, vertex)};
    if (point.face == face) return end;
    const Half there = vertex >= 0 ? end.corner : beyond(surface, side);
    end.point = {face, {0, 0, 0}};
    if (vertex >= 0) {
      end.point.barycentric[there % 3] = 1;
    } else {
      const bool same = mirrored_beyond(surface, side);
      end.point.barycentric[there % 3] = point.barycentric[(same ? side : next(side)) % 3];
      end.point.barycentric[next(there) % 3] = point.barycentric[(same ? next(side) : side) % 3];
    }
    return end;
  }
};

/// Faces met in one direction about a vertex up to one that holds a point.
struct Search {
  std::vector<Half> entered;
  Half corner = -1;  ///< in the face found; -1: there is none
  double angle = 0;  ///< of the faces between

  Search(const PolyhedralSurface& surface, Half from, const Spot& wanted, bool left) {
    Corner c{from, true};
    for (bool first = true;; first = false) {
      if (wanted.lies_in(surface, c.half / 3)) {
        corner = c.half;
        return;
      }
      if (!first) angle += surface.angle(c.half);
      c = left ? surface.turn_left(c) : surface.turn_right(c);
      if (c.half < 0 || c.half == from) return;
      entered.push_back(left == c.forward ? c.half : previous(c.half));
    }
  }
};

[[noreturn]] void refuse(std::size_t number) {
  throw InvalidArgument("points " + std::to_string(number) + " and " + std::to_string(number + 1) +
                        " of the curve lie in no common face");
}

}  // namespace

Place to_first_side(const PolyhedralSurface& surface, Half half, const Place& p) {
  const HalfRecord& r = surface.record(half);
  return half % 3 == 0 ? p : half % 3 == 1 ? in_previous(r, p) : in_next(r, p);
}

Place from_first_side(const PolyhedralSurface& surface, Half half, const Place& p) {
  const HalfRecord& r = surface.record(3 * (half / 3));
  return half % 3 == 0 ? p : half % 3 == 1 ? in_next(r, p) : in_previous(r, p);
}

void enter(const PolyhedralSurface& surface, std::vector<Half>& entered, Half half) {
  if (!entered.empty() && entered.back() == beyond(surface, half))
    entered.pop_back();
  else
    entered.push_back(half);
}

void trim(const PolyhedralSurface& surface, Strip& strip) {
  const auto touches = [](Half side, Half corner) { return side == corner || next(side) == corner; };
  const auto move_over = [&](CurveEnd& end, Half side) {
    const Corner here{end.corner, true};
    end.corner = (side == end.corner ? surface.turn_right(here) : surface.turn_left(here)).half;
    end.point = {end.corner / 3, {0, 0, 0}};
    end.point.barycentric[end.corner % 3] = 1;
  };
  std::size_t first = 0;
  for (; strip.start.corner >= 0 && first < strip.entered.size(); ++first) {
    const Half side = beyond(surface, strip.entered[first]);
    if (!touches(side, strip.start.corner)) break;
    move_over(strip.start, side);
  }
  strip.entered.erase(strip.entered.begin(), strip.entered.begin() + static_cast<std::ptrdiff_t>(first));
  while (strip.end.corner >= 0 && !strip.entered.empty() && touches(strip.entered.back(), strip.end.corner)) {
    move_over(strip.end, strip.entered.back());
    strip.entered.pop_back();
  }
}

std::optional<std::vector<Half>> turn(const PolyhedralSurface& surface, Half from, Half to, bool left) {
  std::vector<Half> entered;
  for (Corner c{from, true}; c.half != to;) {
    c = left ? surface.turn_left(c) : surface.turn_right(c);
    if (c.half < 0) return std::nullopt;
    entered.push_back(left == c.forward ? c.half : previous(c.half));
  }
  return entered;
}

Strip strip_along(const PolyhedralSurface& surface, std::span<const MeshPoint> curve) {
  if (curve.size() < 2) throw InvalidArgument("a curve needs two points");
  Strip strip;
  Spot at(surface, curve[0], 0);
  Index face = -1;
  for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
    const Spot to(surface, curve[k + 1], k + 1);
    Half into = -1;
    if (at.vertex >= 0) {
      const Half from = face < 0 ? surface.first_corner(at.vertex).half : corner_at(surface, face, at.vertex);
      Search left(surface, from, to, true), right(surface, from, to, false);
      if (left.corner < 0 && right.corner < 0) refuse(k);
      const bool is_left = right.corner < 0 || (left.corner >= 0 && left.angle <= right.angle);
      const Search& found = is_left ? left : right;
      if (face >= 0)
        for (Half h : found.entered) enter(surface, strip.entered, h);
      face = found.corner / 3;
    } else if (face < 0 || !to.lies_in(surface, face)) {
      if (face < 0 && to.lies_in(surface, at.point.face)) {
        face = at.point.face;
      } else {
        const Index here = face < 0 ? at.point.face : face;
        for (Half side : {at.side, at.side < 0 ? -1 : beyond(surface, at.side)})
          if (side >= 0 && side / 3 != here && to.lies_in(surface, side / 3)) into = side;
        if (into < 0) refuse(k);
        if (face >= 0) enter(surface, strip.entered, into);
        face = into / 3;
      }
    }
    if (k == 0) strip.start = at.in_face(surface, face);
    at = to;
  }
  strip.end = at.in_face(surface, face);
  return strip;
}

}  // namespace ahm::exact
