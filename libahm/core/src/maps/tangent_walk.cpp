#include "maps/tangent_walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ahm {
namespace {

/// A line that makes no way for so many cells goes round and round a corner where cells meet.
constexpr int most_idle_cells = 20;

}  // namespace

void Walker::go_over(const Star& star, std::size_t edge, Vec2& direction) {
  const Transport R = star.transport(edge);
  const Vec2 log = log_of(star, edge), here = at - log, before = direction;
  R.apply_inverse(here.data(), at.data());
  R.apply_inverse(before.data(), direction.data());
  origin = origin + in_first(log);
  std::array<Vec2, 2> carried;
  for (std::size_t a = 0; a < 2; ++a) {
    const Vec2 axis{a == 0 ? 1.0 : 0.0, a == 1 ? 1.0 : 0.0};
    Vec2 image{};
    R.apply(axis.data(), image.data());
    carried[a] = in_first(image);
  }
  axes = carried;
  vertex = star.neighbors[edge];
}

Exit exit_of(const Star& star, const Vec2& at, const Vec2& direction, double least) {
  Exit exit;
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const Vec2 log = log_of(star, e);
    const double towards = dot(direction, log);
    if (!(towards > 0)) continue;
    const double way = std::max(0.0, (0.5 * dot(log, log) - dot(at, log)) / towards);
    if (way >= least && way < exit.way) exit = {way, e};
  }
  return exit;
}

bool is_beyond(const Star& star, const Vec2& point) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double right = -infinity, left = infinity, right_reach = 0, left_reach = 0;
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const Vec2 log = log_of(star, e);
    const double turn = std::atan2(cross(point, log), dot(point, log)), size = std::hypot(log[0], log[1]);
    const double behind = turn > 0 ? turn - 2 * std::numbers::pi : turn,
                 ahead = turn > 0 ? turn : turn + 2 * std::numbers::pi;
    if (behind > right) right = behind, right_reach = size;
    if (ahead < left) left = ahead, left_reach = size;
  }
  const double reach = std::max(right_reach, left_reach);
  return left - right > 2 * std::numbers::pi / 3 && std::hypot(point[0], point[1]) > reach;
}

Track follow(const TangentGraph& graph, Walker walker, Vec2 direction, double length) {
  Track track;
  track.walkers.push_back(walker);
  int idle = 0;
  const double least_way = 1e-6 * graph.mean_edge_length();
  while (true) {
    const Star star = graph.star(walker.vertex);
    const double rest = length - track.length;
    const double least = idle > most_idle_cells ? std::ldexp(least_way, idle - most_idle_cells) : 0.0;
    const Exit exit = exit_of(star, walker.at, direction, least);
    const double way = std::min(rest, exit.way);
    const Vec2 there = walker.at + way * direction;
    if (is_beyond(star, there)) {
      const double last = std::clamp(-dot(walker.at, direction), 0.0, way);
      walker.at = walker.at + last * direction;
      track.length += last;
      track.complete = last >= rest;
      break;
    }
    walker.at = there;
    track.length += way;
    if (way >= rest) break;
    idle = way > least_way ? 0 : idle + 1;
    track.walkers.push_back(walker);
    walker.go_over(star, exit.edge, direction);
  }
  track.walkers.push_back(walker);
  track.arrival = direction;
  return track;
}

}  // namespace ahm
