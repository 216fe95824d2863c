#include "ahm/surface/polar_map_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/graph/csr_graph.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/util/memory.hpp"

namespace ahm::detail {

/// The edges of flat triangles as a graph, with the vertices and tangent axes of the surface's graph. All weights and masses
/// are 1: the graph is not meant for solving. Vertices without triangles have no edges.
CsrGraph flat_graph(const FlatTriangles& flat);

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
        is_clockwise_(at_tail_.size()) {
    for (Index v = 0; v < flat.surface.vertex_count(); ++v)
      for_each_corner(v, [&](exact::Corner c, double right, double left) {
        at_tail_[c.half] = c.forward ? right : left;
        at_head_[exact::previous(c.half)] = c.forward ? left : right;
        is_clockwise_[c.half] = c.forward == is_mirrored(v);
      });
  }

  /// Calls body(corner, angle of its right side, angle of its left side) counterclockwise.
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
  /// Whether the frames of the two ends of a side have opposite orientations relative to its triangle.
  bool reflects(Half side) const { return is_clockwise_[side] != is_clockwise_[exact::next(side)]; }

 private:
  bool is_mirrored(Index vertex) const { return !flat_.mirrored.empty() && flat_.mirrored[vertex] != 0; }

  const FlatTriangles& flat_;
  std::vector<double> at_tail_, at_head_;
  std::vector<char> is_clockwise_;  ///< per corner: whether its triangle is clockwise in the frame of the vertex
};

/// A directed edge in the frame of its first vertex.
struct Edge {
  Index to;
  double length, angle, angle_there;
  bool reflects;
};

void append(CsrGraphData& graph, const Edge& edge) {
  graph.neighbors.push_back(edge.to);
  graph.weights.push_back(1);
  graph.logs.insert(graph.logs.end(), {edge.length * std::cos(edge.angle), edge.length * std::sin(edge.angle)});
  // The transport maps the edge's direction in the frame of `to`, angle_there + pi, to its direction in this frame.
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

namespace ahm {
namespace {

/// At 8 windows per vertex the median map of real meshes has an error of 0.02 of the distance at the 95th percentile
/// (docs/concepts/accuracy.md). The minimum takes about 15 ms; with it, windows cover surfaces of up to a few thousand
/// vertices.
constexpr Offset windows_per_vertex = 8, min_windows = Offset{1} << 17;

/// Converts the result of a front over the triangles of a sheet to seeds of a front over the graph. The triangles are as noisy
/// as the points, so the seeds are not exact. Their expected error combines the error of `other`, a front from the source
/// without windows, with the difference to it. The difference is divided by the square root of 2, as for two equally good
/// estimates.
std::vector<Wavefront::Seed> seeds_of_front(const Wavefront& front, const Wavefront& other, bool frames) {
  std::vector<Wavefront::Seed> seeds;
  for (Index i = 0; i < front.graph().size(); ++i) {
    const Vertex v(i);
    const double distance = front.distance(v);
    if (!std::isfinite(distance)) continue;
    const Vec2 direction = front.direction(v), other_direction = other.direction(v);
    const double share = other.distance(v) / distance;
    const double apart =
        std::hypot(direction[0] - share * other_direction[0], direction[1] - share * other_direction[1]);
    const double error = std::hypot(apart / std::numbers::sqrt2, other.direction_error(v));
    seeds.push_back({v, distance, direction, frames ? front.arrival(v) : Vec2{NAN, NAN}, front.nearest(v),
                     std::isfinite(error) ? error : 0});
  }
  return seeds;
}

}  // namespace

PolarMapSolver::PolarMapSolver(const TangentGraph& graph, const PolarSolverOptions& options) : graph_(&graph) {
  if (graph.dimension() != 2)
    throw InvalidArgument(
        "dimension_not_2",
        "a polar map needs a graph of dimension 2; this one has dimension " + std::to_string(graph.dimension()),
        "use the heat method");
  one_rings_ = Wavefront::one_rings(graph, options.threads, false);
}

PolarMapSolver::PolarMapSolver(const Surface& surface, const PolarSolverOptions& options)
    : PolarMapSolver(surface.graph(), options) {
  surface_ = &surface;
  windows_ = options.windows.value_or(std::max(min_windows, windows_per_vertex * graph_->size()));
  if (windows_ <= 0) return;
  try {
    geodesics_.emplace(surface, surface.flat_approximation());
    if (!geodesics_->triangles().approximate) return;
    triangle_graph_ = std::make_unique<const CsrGraph>(detail::flat_graph(geodesics_->triangles()));
    triangle_one_rings_ = Wavefront::one_rings(*triangle_graph_, options.threads, false);
  } catch (const InvalidArgument&) {  // no flat triangles
  } catch (const InvalidGeometry&) {  // a face without area
  }
}

/// @param seeds  seeds(options) returns exact polar coordinates around the source
template <class Seeds>
LogMap PolarMapSolver::seeded_map(const Source& source, const PolarMapOptions& options, const Seeds& seeds) const {
  return detail::with_memory_check("a polar map", [&] {
    Wavefront front(*graph_, one_rings_, true);
    front.add(source);
    std::vector<Wavefront::Seed> exact;
    try {
      exact = seeds(ExactMapOptions{
          .radius = options.radius, .max_windows = windows_, .frames = options.frames, .progress = options.progress});
    } catch (
        const InvalidGeometry&) {  // windows lost in needles, or a source outside of the triangles: start at the source
    }
    const auto run_from = [&](Wavefront& over) {
      if (!exact.empty()) {
        // Beyond the seeds the front needs its focusing, and its orientation where transports may reflect.
        const double farthest = std::ranges::max_element(exact, {}, &Wavefront::Seed::distance)->distance;
        const bool front_continues = exact.size() < static_cast<std::size_t>(graph_->size());
        if (front_continues || over.graph().transport_layout().may_reflect()) over.run(farthest, options.progress.stop);
        over.restart(exact);
      }
      over.run(options.radius, options.progress.stop);
    };
    if (triangle_graph_ && !exact.empty()) {
      front.run(options.radius, options.progress.stop);
      Wavefront over(*triangle_graph_, triangle_one_rings_, true);
      over.add(source);
      run_from(over);
      exact = seeds_of_front(over, front, options.frames);
    }
    run_from(front);
    return polar_map(front, source, options);
  });
}

LogMap PolarMapSolver::log_map(const SurfacePoint& source, const std::optional<Vec3>& u_axis,
                               const PolarMapOptions& options) const {
  if (surface_ == nullptr)
    throw InvalidArgument("the solver was built for a graph; for points of a surface build it for the surface");
  return seeded_map(surface_->source(source, u_axis).source, options, [&](const ExactMapOptions& exact) {
    return geodesics_ ? geodesics_->seeds(source, u_axis, exact) : std::vector<Wavefront::Seed>();
  });
}

LogMap PolarMapSolver::log_map(Vertex source, const PolarMapOptions& options) const {
  return seeded_map(Source::at_vertex(source), options, [&](const ExactMapOptions& exact) {
    return geodesics_ ? geodesics_->seeds(source, exact) : std::vector<Wavefront::Seed>();
  });
}

LogMap PolarMapSolver::log_map(const Source& source, const PolarMapOptions& options) const {
  return seeded_map(source, options, [](const ExactMapOptions&) { return std::vector<Wavefront::Seed>(); });
}

Method choose_method(const TangentGraph& graph) { return graph.is_delaunay() ? Method::polar : Method::heat; }

}  // namespace ahm
