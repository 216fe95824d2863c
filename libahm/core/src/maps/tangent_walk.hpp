/// \file
/// Walking over a graph from tangent plane to tangent plane. Lengths in units of the graph.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/types.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {

/// A point of a plane on its way, and how that plane unfolds into the first one.
struct Walker {
  Index vertex = 0;
  Vec2 at{};
  Vec2 origin{};                               ///< of this plane in the first
  std::array<Vec2, 2> axes{{{1, 0}, {0, 1}}};  ///< of this plane in the first

  Vec2 in_first(const Vec2& v) const { return v[0] * axes[0] + v[1] * axes[1]; }
  Vec2 from_first(const Vec2& v) const { return {dot(v, axes[0]), dot(v, axes[1])}; }

  /// Takes the place, and a direction with it, to the plane of a neighbour.
  void go_over(const Star& star, std::size_t edge, Vec2& direction);
};

/// Where a line leaves the cell of its vertex: after which way, and over which edge; none: it does not.
struct Exit {
  double way = std::numeric_limits<double>::infinity();
  std::size_t edge = 0;
};
/// @param direction  unit
/// @param least      of the ways
Exit exit_of(const Star& star, const Vec2& at, const Vec2& direction, double least = 0);

/// Whether a point lies beyond the boundary: between two neighbours more than 120 degrees apart, farther away than both.
bool is_beyond(const Star& star, const Vec2& point);

/// What a line has been through.
struct Track {
  std::vector<Walker> walkers;  ///< where it left cells
  double length = 0;
  bool complete = true;
  Vec2 arrival{};  ///< direction at the last
};

/// Straight on, as far as `length` or the boundary. @param direction  unit
Track follow(const TangentGraph& graph, Walker walker, Vec2 direction, double length);

/// The components of e_ij.
inline Vec2 log_of(const Star& star, std::size_t edge) { return {star.log(edge)[0], star.log(edge)[1]}; }

}  // namespace ahm
