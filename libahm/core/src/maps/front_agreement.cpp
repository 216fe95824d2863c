// Whether the stars of a graph agree on its triangles, so that a front over them can be believed.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "maps/front_stars.hpp"

namespace ahm {
namespace {

/// Hubs of more neighbours are not asked for their triangles: it would take as long for each of them.
constexpr std::size_t most_neighbors = 200;
/// The third side of a triangle and the edge there differ by no more than this share, where stars agree on the triangle.
constexpr double same_side = 0.01;
/// Opposite angles of a quadrilateral on a circle sum to pi. Where they miss it by less, as those of a lattice on a bent surface, either
/// diagonal will do, and stars may choose differently.
constexpr double same_circle = 0.05;

}  // namespace

double UnfoldingFront::agreement(const TangentGraph& graph, std::span<const Vertex> vertices) {
  if (graph.dimension() != 2) return 0;
  std::vector<Neighbor> neighbors;
  std::vector<Corner> corners, others;
  const auto next = [](const std::vector<Corner>& around, std::size_t k) -> const Corner& {
    return around[k + 1 < around.size() ? k + 1 : 0];
  };
  // The corners around another vertex, until the next one is asked for.
  const auto around = [&](Index vertex) -> const std::vector<Corner>& {
    others.clear();
    Stars::append_corners(graph, vertex, neighbors, others);
    return others;
  };
  // What stands beside a neighbour, on either side, and the angle between.
  struct Seen {
    Index neighbor = -1;
    double angle = 0;
  };
  const auto beside = [&](const std::vector<Corner>& star, Index neighbor) {
    std::array<Seen, 2> found;
    for (std::size_t k = 0; k < star.size(); ++k) {
      if (std::isnan(star[k].cosine)) continue;
      const double angle = std::atan2(star[k].sine, star[k].cosine);
      if (star[k].neighbor == neighbor) found[0] = {next(star, k).neighbor, angle};
      if (next(star, k).neighbor == neighbor) found[1] = {star[k].neighbor, angle};
    }
    return found;
  };
  const auto find = [](const std::array<Seen, 2>& seen, Index neighbor) -> const Seen* {
    return seen[0].neighbor == neighbor ? &seen[0] : seen[1].neighbor == neighbor ? &seen[1] : nullptr;
  };
  // Whether the corner of three is one of a triangle, also one that others cross, as those of a polygon do, or of a square
  // without diagonals: its corners lie on a circle.
  const auto agree = [&](Index vertex, const Corner& right, const Corner& left) {
    const double angle = std::atan2(right.sine, right.cosine),
                 third = std::hypot(right.length * right.cosine - left.length, right.length * right.sine);
    const std::vector<Corner>& star = around(right.neighbor);
    for (const Corner& side : star)
      if (side.neighbor == left.neighbor && std::abs(side.length - third) <= same_side * third) return true;
    const std::array<Seen, 2> of_right = beside(star, vertex), of_left = beside(around(left.neighbor), vertex);
    if (find(of_right, left.neighbor) && find(of_left, right.neighbor)) return true;
    for (const Seen& across : of_right) {
      if (across.neighbor < 0 || across.neighbor == vertex || !find(of_left, across.neighbor)) continue;
      const std::array<Seen, 2> of_across = beside(around(across.neighbor), right.neighbor);
      const Seen* const opposite = find(of_across, left.neighbor);
      if (opposite && std::abs(angle + opposite->angle - std::numbers::pi) < same_circle) return true;
    }
    return false;
  };
  const auto is_asked = [&](Index vertex) { return graph.star(vertex).degree() <= most_neighbors; };
  Offset seen = 0, agreed = 0;
  for (const Vertex vertex : vertices) {
    if (!is_asked(vertex.index)) continue;
    corners.clear();
    Stars::append_corners(graph, vertex.index, neighbors, corners);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if (std::isnan(corners[k].cosine)) continue;
      const Corner &right = corners[k], &left = next(corners, k);
      if (!is_asked(right.neighbor) || !is_asked(left.neighbor)) continue;
      ++seen;
      agreed += agree(vertex.index, right, left);
    }
  }
  return seen > 0 ? static_cast<double>(agreed) / static_cast<double>(seen) : 0;
}

}  // namespace ahm
