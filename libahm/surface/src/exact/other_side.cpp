#include <algorithm>
#include <cmath>

#include "shorten.hpp"

namespace ahm::exact {
namespace {

/// A straight piece of a line that would be shorter beyond a vertex beside it.
struct Shortcut {
  Bend around;  ///< the vertex
  double gain;  ///< of length, if nothing else is in the way
};

/// What a straight piece from a to b gains on the other side of a vertex of its strip; <= 0: nothing.
double gain_beyond(double angle_sum, const Place& vertex, const Place& a, const Place& b) {
  const Vec2 back = a - vertex, ahead = b - vertex;
  const double here = angle_between(back, ahead), there = angle_sum - here;
  if (!(there < here)) return 0;
  const double p = norm(back), q = norm(ahead), sine = std::sin(there / 2);
  return distance(a, b) - std::sqrt((p - q) * (p - q) + 4 * p * q * sine * sine);
}

/// Shortcuts past the vertices on one side, along the straight piece before bend `to`.
void collect(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line, std::size_t to, bool left,
             std::vector<Shortcut>& found) {
  const Bend &from = line.bends[to - 1], &next = line.bends[to];
  const std::size_t begin = to == 1 ? 0 : from.leaves + 1;
  const std::size_t end = to + 1 == line.bends.size() ? line.portals.size() : next.arrives;
  const auto vertex_at = [&](std::size_t p) {
    return surface.record(corner_after(strip, line, {{}, left, p, p}, p)).tail;
  };
  for (std::size_t p = begin, last = p; p < end; p = last) {
    const Index vertex = vertex_at(p);
    for (last = p + 1; last < end && vertex_at(last) == vertex;) ++last;
    if (surface.on_boundary(vertex)) continue;
    const Place at = left ? line.portals[p].left : line.portals[p].right;
    const double gain = gain_beyond(surface.angle_sum(vertex), at, from.at, next.at);
    if (gain > 1e-12 * line.length) found.push_back({{at, left, p, last - 1}, gain});
  }
}

std::vector<Shortcut> shortcuts(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line) {
  std::vector<Shortcut> found;
  for (std::size_t to = 1; to < line.bends.size(); ++to)
    for (bool left : {true, false}) collect(surface, strip, line, to, left, found);
  std::stable_sort(found.begin(), found.end(), [](const Shortcut& a, const Shortcut& b) { return a.gain > b.gain; });
  return found;
}

}  // namespace

TautLine pass_other_side(const PolyhedralSurface& surface, Strip& strip, TautLine line) {
  constexpr std::size_t most_tries = 8;
  for (bool shorter = true; shorter;) {
    shorter = false;
    std::vector<Shortcut> found = shortcuts(surface, strip, line);
    if (found.size() > most_tries) found.resize(most_tries);
    for (const Shortcut& shortcut : found) {
      const auto around = other_side(surface, strip, line, shortcut.around);
      if (!around) continue;
      Strip other{strip.start, strip.end, {}};
      const auto at = [&](std::size_t p) { return strip.entered.begin() + static_cast<std::ptrdiff_t>(p); };
      for (auto h = strip.entered.begin(); h != at(shortcut.around.arrives); ++h) enter(surface, other.entered, *h);
      for (Half h : *around) enter(surface, other.entered, h);
      for (auto h = at(shortcut.around.leaves + 1); h != strip.entered.end(); ++h) enter(surface, other.entered, *h);
      TautLine beyond = shorten(surface, other);
      if (!(beyond.length < line.length * (1 - 1e-14))) continue;
      strip = std::move(other);
      line = std::move(beyond);
      shorter = true;
      break;
    }
  }
  return line;
}

}  // namespace ahm::exact
