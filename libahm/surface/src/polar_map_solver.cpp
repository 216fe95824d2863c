#include "ahm/surface/polar_map_solver.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/graph/csr_graph.hpp"
#include "ahm/maps/straight_line.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

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

/// Sets the expected errors of seeds from the triangles of a cloud. These are as noisy as the points, so the seeds are not exact.
/// The error combines the error of `other`, a front from the source without windows, with the difference to it. The difference
/// is divided by the square root of 2, as for two equally good estimates.
void set_errors(std::span<Wavefront::Seed> seeds, const Wavefront& other) {
  for (Wavefront::Seed& seed : seeds) {
    const Vec2 other_direction = other.direction(seed.vertex);
    const double share = other.distance(seed.vertex) / seed.distance;
    const double apart =
        std::hypot(seed.direction[0] - share * other_direction[0], seed.direction[1] - share * other_direction[1]);
    const double error = std::hypot(apart / std::numbers::sqrt2, other.direction_error(seed.vertex));
    seed.error = std::isfinite(error) ? error : 0;
  }
}

/// The polar coordinates of a front.
/// @param arrivals  whether directions of arrival are computed; otherwise they are NaN
std::vector<Wavefront::Seed> seeds_of_front(const Wavefront& front, bool arrivals) {
  std::vector<Wavefront::Seed> seeds;
  for (const Vertex v : front.reached())
    seeds.push_back({v, front.distance(v), front.direction(v), arrivals ? front.arrival(v) : Vec2{NAN, NAN},
                     front.nearest(v), front.direction_error(v), front.is_mirrored(v)});
  return seeds;
}

}  // namespace

PolarMapSolver::PolarMapSolver(const TangentGraph& graph, const PolarSolverOptions& options) : graph_(&graph) {
  if (graph.dimension() != 2)
    throw InvalidArgument(
        "dimension_not_2",
        "a polar map needs a graph of dimension 2; this one has dimension " + std::to_string(graph.dimension()),
        "use the heat method");
  one_rings_ = detail::with_memory_check("preparing polar maps on " + std::to_string(graph.size()) + " vertices",
                                         [&] { return Wavefront::one_rings(graph, options.threads, false); });
}

PolarMapSolver::PolarMapSolver(const Surface& surface, const PolarSolverOptions& options)
    : PolarMapSolver(surface.graph(), options) {
  surface_ = &surface;
  windows_ = options.windows;
  if (windows_ && *windows_ <= 0) return;
  try {
    geodesics_.emplace(surface, surface.flat_approximation());
    if (!geodesics_->triangles().approximate) return;
    triangle_graph_ = std::make_unique<const CsrGraph>(detail::flat_graph(geodesics_->triangles()));
    triangle_one_rings_ = Wavefront::one_rings(*triangle_graph_, options.threads, false);
  } catch (const InvalidArgument&) {  // no flat triangles
  } catch (const InvalidGeometry&) {  // a face without area
  }
}

/// The fronts and windows of one thread. They are used again for each source, so that the time of a small map does not depend on
/// the size of the graph.
class PolarMapSolver::Fronts {
 public:
  explicit Fronts(const PolarMapSolver& solver) : solver_(solver), front_(*solver.graph_, solver.one_rings_, true) {}

  /// A front with final results up to the radius of the options.
  /// @param seeds   empty: the front starts at the source
  /// @param errors  whether the front has errors of directions on clouds, which takes a second front
  const Wavefront& around(const Source& source, const Seeds& seeds, const PolarMapOptions& options, bool errors) {
    return around(source, seeds, exact_seeds(source, seeds, options, 0), options, errors);
  }

  /// Polar coordinates, as `LocalPolarCoordinates`. Where windows reach all vertices, no front is needed.
  /// @param from  the coordinates may omit vertices whose straight line from here is longer than the horizon; none: they omit none
  PolarNeighbors neighbors(const Source& source, const Seeds& seeds, PolarMapOptions options, Index enough,
                           const std::optional<Vec3>& from, bool errors) {
    ExactGeodesics::Seeds exact = exact_seeds(source, seeds, options, enough);
    if (enough > 0 && std::ssize(exact.vertices) >= enough)
      options.radius = std::min({options.radius, exact.horizon, radius_of(exact.vertices, enough, from)});
    if (exact.vertices.empty() || exact.horizon < options.radius ||
        may_reach_left_out(exact.vertices, from, options.radius)) {
      neighbors_ = seeds_of_front(around(source, seeds, std::move(exact), options, errors), true);
      return {neighbors_, options.radius};
    }
    neighbors_ = std::move(exact.vertices);
    if (errors && solver_.triangle_graph_) {
      front_.clear();
      front_.add(source);
      front_.run(options.radius, options.progress.stop);
      set_errors(neighbors_, front_);
      // A front stores errors in single precision, so those of local and whole maps are equal only if both are stored in one.
      run_from(front_, source, neighbors_, false, options);
      neighbors_ = seeds_of_front(front_, true);
    }
    return {neighbors_, options.radius};
  }

 private:
  /// @param exact  the vertices that windows reach up to the radius
  const Wavefront& around(const Source& source, const Seeds& seeds, ExactGeodesics::Seeds exact,
                          const PolarMapOptions& options, bool errors) {
    const double edge = longest_edge_to_left_out(exact.vertices);
    if (edge > 0 && !std::isinf(options.radius)) {
      // Paths to vertices without triangles may cross edges whose ends are beyond the radius.
      PolarMapOptions farther = options;
      farther.radius += edge;
      exact = exact_seeds(source, seeds, farther, 0);
    }
    front_.clear();
    if (exact.vertices.empty()) {
      front_.add(source);
      front_.run(options.radius, options.progress.stop);
      return front_;
    }
    const bool is_enough = exact.horizon >= options.radius;
    const bool continues = !is_enough || edge > 0;
    if (!solver_.triangle_graph_) {
      run_from(front_, source, exact.vertices, continues, options);
      return front_;
    }
    std::vector<Wavefront::Seed> all = std::move(exact.vertices);
    const Index component = component_of(all.front().vertex.index);
    if (!is_enough) {
      if (!over_) over_.emplace(*solver_.triangle_graph_, solver_.triangle_one_rings_, true);
      run_from(*over_, source, all, true, options);
      all = seeds_of_front(*over_, options.frames);
    }
    if (errors) {
      front_.add(source);
      front_.run(options.radius, options.progress.stop);
      set_errors(all, front_);
    }
    // Vertices with triangles that windows have not reached are beyond the radius.
    const auto has_triangles = [this, component](Vertex v) { return component_of(v.index) == component; };
    run_from(front_, source, all, continues, options,
             is_enough ? std::function<bool(Vertex)>(has_triangles) : std::function<bool(Vertex)>());
    return front_;
  }

  /// The vertices that windows reach up to the radius, or at least `enough` of them if it is > 0. Empty without seeds, where windows
  /// get lost in needles, and if the source is outside of the triangles.
  ExactGeodesics::Seeds exact_seeds(const Source& source, const Seeds& seeds, const PolarMapOptions& options,
                                    Index enough) {
    if (!seeds) return {};
    if (!windows_) windows_.emplace(*solver_.geodesics_);
    const ExactMapOptions exact{.radius = options.radius,
                                .max_windows = solver_.max_windows(source.vertices().front()),
                                .max_vertices = enough,
                                .frames = options.frames || solver_.graph_->transport_layout().may_reflect(),
                                .progress = options.progress};
    try {
      return seeds(exact, *windows_);
    } catch (const InvalidGeometry&) {
      return {};
    }
  }

  /// A radius within which at least `count` seeds lie, also if distances are increased to the length of the straight line.
  double radius_of(std::span<const Wavefront::Seed> seeds, Index count, const std::optional<Vec3>& from) {
    distances_.clear();
    for (const Wavefront::Seed& seed : seeds) {
      const auto frame = from ? solver_.graph_->frame(seed.vertex.index) : std::optional<Frame>();
      distances_.push_back(frame ? bounded_distance(distance(frame->origin, *from), seed.distance) : seed.distance);
    }
    const auto last = distances_.begin() + (count - 1);
    std::nth_element(distances_.begin(), last, distances_.end());
    return *last * (1 + 1e-12);
  }

  Index component_of(Index vertex) const { return solver_.geodesics_->triangles().surface.component(vertex); }

  /// On clouds windows cannot reach vertices without triangles, or with those of another component. Calls visit(seed, neighbor) for
  /// such neighbors of seeds, until it returns true. @return whether it did
  template <class Visit>
  bool any_left_out(std::span<const Wavefront::Seed> seeds, const Visit& visit) const {
    if (!solver_.triangle_graph_) return false;
    return std::ranges::any_of(seeds, [&](const Wavefront::Seed& seed) {
      const Index vertex = seed.vertex.index, component = component_of(vertex);
      return std::ranges::any_of(solver_.graph_->star(vertex).neighbors,
                                 [&](Index j) { return component_of(j) != component && visit(vertex, j); });
    });
  }

  /// Whether a front may reach left out vertices whose straight line from the source is at most as long as the radius.
  bool may_reach_left_out(std::span<const Wavefront::Seed> seeds, const std::optional<Vec3>& from,
                          double radius) const {
    const auto is_near = [&](Index j) {
      const auto frame = from ? solver_.graph_->frame(j) : std::optional<Frame>();
      return !frame || distance(frame->origin, *from) <= radius;
    };
    return any_left_out(seeds, [&](Index vertex, Index j) {
      return is_near(j) || std::ranges::any_of(solver_.graph_->star(j).neighbors, [&](Index next) {
               return component_of(next) != component_of(vertex) && is_near(next);
             });
    });
  }

  /// The longest edge of seeds that paths to left out neighbors may cross, world units; 0: there are no such neighbors. It ends at a common
  /// neighbor of both.
  double longest_edge_to_left_out(std::span<const Wavefront::Seed> seeds) const {
    double longest = 0;
    any_left_out(seeds, [&](Index vertex, Index j) {
      const Star star = solver_.graph_->star(vertex), other = solver_.graph_->star(j);
      for (std::size_t e = 0; e < star.degree(); ++e)
        if (const Index end = star.neighbors[e];
            end == j || std::ranges::find(other.neighbors, end) != other.neighbors.end())
          longest = std::max(longest, length(star.log(e)));
      return false;
    });
    return longest * solver_.graph_->length_unit();
  }

  /// @param continues  whether the front reaches vertices that are no seeds
  static void run_from(Wavefront& front, const Source& source, std::span<const Wavefront::Seed> seeds, bool continues,
                       const PolarMapOptions& options, const std::function<bool(Vertex)>& is_closed = {}) {
    front.clear();
    if (continues) {
      front.add(source);
      // On triangulations the front needs its focusing beyond the seeds.
      if (front.graph().is_delaunay())
        front.run(std::ranges::max_element(seeds, {}, &Wavefront::Seed::distance)->distance, options.progress.stop);
    }
    front.restart(seeds, is_closed);
    if (continues) front.run(options.radius, options.progress.stop);
  }

  const PolarMapSolver& solver_;
  Wavefront front_;
  std::optional<Wavefront> over_;  ///< for clouds: over the selected triangles
  std::optional<ExactGeodesics::Workspace> windows_;
  std::vector<Wavefront::Seed> neighbors_;  ///< result of `neighbors`
  std::vector<double> distances_;
};

Offset PolarMapSolver::max_windows(Vertex source) const {
  const exact::PolyhedralSurface& triangles = geodesics_->triangles().surface;
  const Offset vertices = triangles.component_details(triangles.component(source.index)).vertices;
  return windows_.value_or(std::max(min_windows, windows_per_vertex * vertices));
}

PolarMapSolver::Seeds PolarMapSolver::seeds_of(Vertex source) const {
  if (!geodesics_) return {};
  return [this, source](const ExactMapOptions& options, ExactGeodesics::Workspace& workspace) {
    return geodesics_->seeds(source, options, workspace);
  };
}

PolarMapSolver::Seeds PolarMapSolver::seeds_of(const SurfacePoint& source, const std::optional<Vec3>& u_axis) const {
  if (!geodesics_) return {};
  return [this, source, u_axis](const ExactMapOptions& options, ExactGeodesics::Workspace& workspace) {
    return geodesics_->seeds(source, u_axis, options, workspace);
  };
}

/// @param seeds  empty: the front starts at the source
LogMap PolarMapSolver::log_map(const Source& source, const PolarMapOptions& options, const Seeds& seeds) const {
  return detail::with_memory_check("computing a polar map", [&] {
    Fronts fronts(*this);
    return polar_map(fronts.around(source, seeds, options, true), source, options);
  });
}

LogMap PolarMapSolver::log_map(const SurfacePoint& source, const std::optional<Vec3>& u_axis,
                               const PolarMapOptions& options) const {
  if (surface_ == nullptr)
    throw InvalidArgument("the solver was built for a graph; for points of a surface build it for the surface");
  return log_map(surface_->source(source, u_axis).source, options, seeds_of(source, u_axis));
}

LogMap PolarMapSolver::log_map(Vertex source, const PolarMapOptions& options) const {
  return log_map(Source::at_vertex(source), options, seeds_of(source));
}

LogMap PolarMapSolver::log_map(const Source& source, const PolarMapOptions& options) const {
  return log_map(source, options, Seeds());
}

namespace {

void check(const LocalMapOptions& options) {
  if (options.method && *options.method != Method::polar)
    throw InvalidArgument("method is " + std::string(to_string(*options.method)) +
                          "; this solver makes polar maps, use local_maps or row_local_maps");
}

/// Options of the small maps of `local_maps`.
PolarMapOptions small_map_options(const LocalMapOptions& options) {
  return {.frames = true, .progress = {{}, options.heat.progress.stop}};
}

}  // namespace

LocalMaps PolarMapSolver::local_maps(std::span<const Vertex> sources, const LocalMapOptions& options) const {
  check(options);
  std::vector<Source> from;
  from.reserve(sources.size());
  for (const Vertex vertex : sources) from.push_back(Source::at_vertex(vertex));
  return local_maps(from, options, [&](std::size_t s) { return seeds_of(sources[s]); });
}

LocalMaps PolarMapSolver::local_maps(std::span<const SurfacePoint> sources, const LocalMapOptions& options,
                                     const std::optional<Vec3>& u_axis) const {
  check(options);
  if (surface_ == nullptr)
    throw InvalidArgument("the solver was built for a graph; for points of a surface build it for the surface");
  std::vector<Source> from;
  from.reserve(sources.size());
  for (const SurfacePoint& point : sources) from.push_back(surface_->source(point, u_axis).source);
  return local_maps(from, options, [&](std::size_t s) { return seeds_of(sources[s], u_axis); });
}

LocalMaps PolarMapSolver::local_maps(std::span<const Source> sources, const LocalMapOptions& options) const {
  check(options);
  return local_maps(sources, options, [](std::size_t) { return Seeds(); });
}

LocalMaps PolarMapSolver::local_maps(std::span<const Source> sources, const LocalMapOptions& options,
                                     const std::function<Seeds(std::size_t)>& seeds) const {
  const auto make_coordinates = [&]() -> LocalPolarCoordinates {
    return [&, fronts = std::make_shared<Fronts>(*this), small = small_map_options(options)](
               std::size_t s, double radius, Index enough) mutable {
      small.radius = radius;
      const auto from =
          options.bound_by_straight_line ? straight_line_origin(*graph_, sources[s]) : std::optional<Vec3>();
      return fronts->neighbors(sources[s], seeds(s), small, enough, from, options.quality);
    };
  };
  return local_polar_maps(*graph_, sources, options, make_coordinates);
}

Method choose_method(const TangentGraph& graph) { return graph.is_delaunay() ? Method::polar : Method::heat; }

}  // namespace ahm
