#include "flat_graph.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace ahm::detail {
namespace {

using exact::Half;
using exact::HalfRecord;

/// Angles of the sides of all triangles in the frames of their ends.
class SideAngles {
 public:
  explicit SideAngles(const FlatTriangles& flat)
      : flat_(flat),
        at_tail_(static_cast<std::size_t>(3 * flat.surface.face_count())),
        at_head_(at_tail_.size()),
        turns_back_(at_tail_.size()) {
    for (Index v = 0; v < flat.surface.vertex_count(); ++v)
      for_each_corner(v, [&](exact::Corner c, double right, double left) {
        at_tail_[c.half] = c.forward ? right : left;
        at_head_[exact::previous(c.half)] = c.forward ? left : right;
        turns_back_[c.half] = c.forward == is_mirrored(v);
      });
  }

  /// Calls body(corner, angle of its right side, of its left side) counterclockwise.
  template <class Body>
  void for_each_corner(Index vertex, const Body& body) const {
    const exact::PolyhedralSurface& surface = flat_.surface;
    const exact::Corner start = surface.first_corner(vertex);
    if (start.half < 0) return;
    const double zero = flat_.angles.empty() ? 0 : flat_.angles[vertex];
    const double scale = (is_mirrored(vertex) ? -1 : 1) * surface.angle_scale(vertex);
    double turned = 0;
    for (exact::Corner c = start;;) {
      const double next = turned + surface.angle(c.half);
      body(c, zero + scale * turned, zero + scale * next);
      turned = next;
      c = surface.turn_left(c);
      if (c.half < 0 || c == start) return;
    }
  }

  double at_tail(Half side) const { return at_tail_[side]; }
  double at_head(Half side) const { return at_head_[side]; }
  /// Whether the frames of the ends of a side see its triangle from different sides.
  bool reflects(Half side) const { return turns_back_[side] != turns_back_[exact::next(side)]; }

 private:
  bool is_mirrored(Index vertex) const { return !flat_.mirrored.empty() && flat_.mirrored[vertex] != 0; }

  const FlatTriangles& flat_;
  std::vector<double> at_tail_, at_head_;
  std::vector<char> turns_back_;  ///< of the corner at the tail: whether its triangle is clockwise in the frame
};

/// An edge as the vertex sees it where it starts.
struct Edge {
  Index to;
  double length, angle, angle_there;
  bool reflects;
};

void append(CsrGraphData& graph, const Edge& edge) {
  graph.neighbors.push_back(edge.to);
  graph.weights.push_back(1);
  graph.logs.insert(graph.logs.end(), {edge.length * std::cos(edge.angle), edge.length * std::sin(edge.angle)});
  // Takes the direction back along the edge, there, to that along it, here.
  const double side = edge.reflects ? -1 : 1, turn = edge.angle - side * (edge.angle_there + std::numbers::pi);
  const double c = std::cos(turn), s = std::sin(turn);
  if (graph.kind == TransportKind::rotation2)
    graph.transports.insert(graph.transports.end(), {c, s});
  else
    graph.transports.insert(graph.transports.end(), {c, -side * s, s, side * c});
}

}  // namespace

CsrGraph flat_graph(const FlatTriangles& flat) {
  const exact::PolyhedralSurface& surface = flat.surface;
  const SideAngles angles(flat);
  CsrGraphData graph;
  graph.length_unit = flat.length_unit;
  graph.is_delaunay = true;
  graph.masses.assign(static_cast<std::size_t>(surface.vertex_count()), 1);
  for (Half side = 0; side < 3 * surface.face_count(); ++side)
    if (angles.reflects(side)) graph.kind = TransportKind::block;
  graph.row_begin.push_back(0);
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    const auto add_side = [&](exact::Corner c, bool is_right) {
      const HalfRecord r = surface.record(c.half);
      const Half before = exact::previous(c.half);
      if (is_right == c.forward)
        append(graph, {r.head, r.length, angles.at_tail(c.half), angles.at_head(c.half), angles.reflects(c.half)});
      else
        append(graph, {r.apex, r.left, angles.at_head(before), angles.at_tail(before), angles.reflects(before)});
    };
    angles.for_each_corner(v, [&](exact::Corner c, double, double) {
      add_side(c, true);
      if (surface.turn_left(c).half < 0) add_side(c, false);
    });
    graph.row_begin.push_back(static_cast<Offset>(graph.neighbors.size()));
  }
  return CsrGraph(std::move(graph));
}

}  // namespace ahm::detail
