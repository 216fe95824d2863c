#include "ahm/surface/exact/exact_geodesics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/surface/directions.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "exact/geodesic_path.hpp"
#include "exact/propagation.hpp"

namespace ahm {
namespace {

using Axes = std::array<double, 4>;

/// u at an angle, v a quarter turn to its left; `mirrored`: to its right.
Axes axes_at(double angle, bool mirrored = false) {
  const double c = std::cos(angle), s = std::sin(angle), side = mirrored ? -1 : 1;
  return {c, -side * s, s, side * c};
}

/// Vector between two points of a face, in the plane of the face. For surfaces without positions.
Vec2 side_between(const exact::PolyhedralSurface& surface, const exact::MeshPoint& from, const exact::MeshPoint& to) {
  return surface.place(to) - surface.place(from);
}

/// How a shortest path arrives at a vertex.
struct VertexArrival {
  double angle;   ///< its direction, in the frame of the vertex
  bool mirrored;  ///< whether the last face has the opposite orientation of the frame
};

/// @param half  half-edge of the last face; the vertex is its apex
/// @param from  start of the last straight piece, in the frame of the half-edge
VertexArrival arrival_at(const FlatTriangles& flat, exact::Half half, const Vec2& from) {
  const exact::PolyhedralSurface& surface = flat.surface;
  const exact::HalfRecord& record = surface.record(half);
  const auto back = exact::angle_at_vertex(surface, exact::previous(half), exact::in_previous(record, from));
  const double angle = std::numbers::pi + back.angle * surface.angle_scale(record.apex);
  if (flat.angles.empty()) return {angle, !back.forward};
  const bool mirrored = flat.mirrored[record.apex] != 0;
  return {flat.angles[record.apex] + (mirrored ? -angle : angle), back.forward == mirrored};
}

/// Whether directions turn clockwise in the frame of a vertex.
bool mirrored_at(const FlatTriangles& flat, Index vertex) {
  return !flat.mirrored.empty() && flat.mirrored[vertex] != 0;
}

/// Converts axes from the frame of a vertex to the plane of its directions.
Axes from_frame(const FlatTriangles& flat, Index vertex, const Axes& axes) {
  if (flat.angles.empty()) return axes;
  const double c = std::cos(flat.angles[vertex]), s = std::sin(flat.angles[vertex]),
               side = flat.mirrored[vertex] ? -1 : 1;
  return {c * axes[0] + s * axes[2], c * axes[1] + s * axes[3], side * (c * axes[2] - s * axes[0]),
          side * (c * axes[3] - s * axes[1])};
}

/// The inverse of `from_frame`.
Axes in_frame(const FlatTriangles& flat, Index vertex, const Axes& axes) {
  if (flat.angles.empty()) return axes;
  const double c = std::cos(flat.angles[vertex]), s = std::sin(flat.angles[vertex]),
               side = flat.mirrored[vertex] ? -1 : 1;
  return {c * axes[0] - s * side * axes[2], c * axes[1] - s * side * axes[3], s * axes[0] + c * side * axes[2],
          s * axes[1] + c * side * axes[3]};
}

/// Converts coordinates in the face or around the vertex of a source to the axes of the source.
Vec2 in_axes(const Axes& axes, const Vec2& w) {
  return {axes[0] * w[0] + axes[2] * w[1], axes[1] * w[0] + axes[3] * w[1]};
}

}  // namespace

ExactGeodesics::ExactGeodesics(const Surface& surface)
    : surface_(&surface),
      flat_(detail::with_memory_check("laying out triangles", [&] { return surface.flat_triangles(); })) {}

ExactGeodesics::ExactGeodesics(const Surface& surface, FlatTriangles triangles)
    : surface_(&surface), flat_(std::move(triangles)) {}

exact::MeshPoint ExactGeodesics::point(const SurfacePoint& point) const {
  if (const auto* row = std::get_if<Row>(&point)) return flat_.surface.vertex_point(surface_->vertex(*row));
  if (const auto* edge = std::get_if<EdgePoint>(&point)) return surface_->flat_point(*edge);
  if (const auto* inside = std::get_if<FacePoint>(&point)) return surface_->flat_point(*inside);
  const exact::TracedPath way = trace_to(surface_->source(point));
  return way.points.back();
}

Vec3 ExactGeodesics::position(const exact::MeshPoint& point) const {
  if (flat_.positions.empty()) throw InvalidArgument("the surface has no positions");
  const exact::MeshPoint inside = exact::checked(flat_.surface, point, "point");
  Vec3 sum{};
  for (int s = 0; s < 3; ++s)
    sum = sum + inside.barycentric[s] * flat_.positions[flat_.surface.record(3 * inside.face + s).tail];
  return sum;
}

/// The angle of a source's u axis in the frame of side 0 of its face.
double ExactGeodesics::u_angle_in_face(const SurfacePoint& at, const SurfaceSource& placed, Index face) const {
  Vec2 u{};
  if (placed.frame && !flat_.positions.empty()) {
    const auto corner = [&](int s) { return flat_.positions[flat_.surface.record(3 * face + s).tail]; };
    const double scale = 1 / flat_.length_unit;
    const Vec3 side = scale * (corner(1) - corner(0)), normal = cross(side, scale * (corner(2) - corner(0)));
    const Vec3 x = normalized(side), y = normalized(cross(normal, side));
    u = projected(x, y, placed.frame->x, "in face " + std::to_string(face));
  } else if (const auto* edge = std::get_if<EdgePoint>(&at)) {
    u = side_between(flat_.surface, point(EdgePoint{edge->from, edge->to, 0}),
                     point(EdgePoint{edge->from, edge->to, 1}));
  } else {
    FacePoint from = std::get<FacePoint>(at), to = from;
    from.barycentric = {1, 0, 0};
    to.barycentric = {0, 1, 0};
    u = side_between(flat_.surface, point(from), point(to));
  }
  return std::atan2(u[1], u[0]);
}

/// The axes of a source in a face, transported along the bisector to the vertex at one of its corners.
Axes ExactGeodesics::at_corner(exact::Half corner, double u) const {
  const exact::PolyhedralSurface& surface = flat_.surface;
  const auto place = [&](exact::Half h) {
    exact::MeshPoint point{h / 3, {}};
    point.barycentric[h % 3] = 1;
    return surface.place(point);
  };
  const Vec2 side = place(exact::next(corner)) - place(corner);
  const double half = surface.angle(corner) / 2, off = u - std::atan2(side[1], side[0]) - half;
  const Index vertex = surface.record(corner).tail;
  double turned = half;
  exact::Corner c = surface.first_corner(vertex);
  for (; c.half != corner; c = surface.turn_left(c)) turned += surface.angle(c.half);
  return axes_at(turned * surface.angle_scale(vertex) + (c.forward ? off : -off), !c.forward);
}

Axes ExactGeodesics::vertex_axes(const SurfaceSource& placed) const {
  const auto own = placed.source.axes();
  return from_frame(flat_, placed.source.vertices()[0].index,
                    own.empty() ? Axes{1, 0, 0, 1} : Axes{own[0], own[1], own[2], own[3]});
}

/// Traces the straight line from the row of a source in a tangent plane to that source.
/// @throws InvalidGeometry (fault "beyond_boundary")
exact::TracedPath ExactGeodesics::trace_to(const SurfaceSource& placed) const try {
  const Axes a = vertex_axes(placed);
  const std::span<const double> back = placed.source.offsets();
  const Vec2 out{-(a[0] * back[0] + a[1] * back[1]), -(a[2] * back[0] + a[3] * back[1])};
  return exact::trace(flat_.surface, flat_.surface.vertex_point(placed.source.vertices()[0]),
                      std::atan2(out[1], out[0]), length(out) / flat_.length_unit);
} catch (const InvalidArgument& e) {  // the line leaves the triangles at once
  throw InvalidGeometry("beyond_boundary", e.what(), "choose a source inside the surface");
}

/// The angle of the u axis of a source in a tangent plane, in the frame of side 0 of the face that contains the source.
double ExactGeodesics::u_angle_beyond_row(const SurfaceSource& placed) const {
  const std::span<const double> back = placed.source.offsets();
  const Axes a = vertex_axes(placed);
  const double side = a[0] * a[3] - a[1] * a[2] < 0 ? -1 : 1;
  return trace_to(placed).direction - side * std::atan2(-back[1], -back[0]);
}

Axes ExactGeodesics::axes(const SurfacePoint& at, const SurfaceSource& placed, const exact::MeshPoint& point) const {
  if (std::holds_alternative<Row>(at)) {
    return vertex_axes(placed);
  }
  const exact::MeshPoint inside = exact::checked(flat_.surface, point, "source");
  const double u =
      std::holds_alternative<TangentPoint>(at) ? u_angle_beyond_row(placed) : u_angle_in_face(at, placed, inside.face);
  if (exact::vertex_of(flat_.surface, inside) < 0) return axes_at(u);
  const auto corner = std::max_element(inside.barycentric.begin(), inside.barycentric.end());
  return at_corner(static_cast<exact::Half>(3 * inside.face + (corner - inside.barycentric.begin())), u);
}

/// Sources in the form of the heat method, with their points and axes on the triangles.
struct ExactGeodesics::PlacedSources {
  std::vector<exact::MeshPoint> points;
  std::vector<Axes> axes;
  std::vector<Source> sources;
  std::vector<Vec2> positions;
};

ExactGeodesics::PlacedSources ExactGeodesics::placed(std::span<const ExactSource> sources) const {
  PlacedSources result;
  for (const ExactSource& s : sources) {
    SurfaceSource placed = surface_->source(s.point, s.u_axis);
    result.points.push_back(point(s.point));
    const Axes own = axes(s.point, placed, result.points.back());
    const double side = s.mirrored ? -1 : 1, c = std::cos(s.angle), t = std::sin(s.angle);
    const Vec2 u{own[0], own[2]}, v{side * own[1], side * own[3]};
    const Vec2 turned_u = c * u - t * v, turned_v = t * u + c * v;
    result.axes.push_back({turned_u[0], turned_v[0], turned_u[1], turned_v[1]});
    result.sources.push_back(std::move(placed.source));
    result.positions.push_back(s.position);
  }
  return result;
}

/// Joins several sources into one.
Source ExactGeodesics::joined(std::span<const ExactSource> given, const PlacedSources& placed) {
  if (given.size() == 1 && given[0].position == Vec2{} && given[0].angle == 0 && !given[0].mirrored)
    return placed.sources[0];
  const bool plain = std::all_of(given.begin(), given.end(), [](const ExactSource& s) {
    return std::holds_alternative<Row>(s.point) && !s.u_axis && s.position == Vec2{} && s.angle == 0 && !s.mirrored;
  });
  if (plain) {
    std::vector<Vertex> vertices;
    for (const Source& source : placed.sources) vertices.push_back(source.vertices()[0]);
    return Source::at_vertices(vertices);
  }
  Source all(2);
  for (std::size_t k = 0; k < given.size(); ++k) {
    const Source& source = placed.sources[k];
    const double side = given[k].mirrored ? -1 : 1, c = std::cos(given[k].angle), s = std::sin(given[k].angle);
    for (std::size_t i = 0; i < source.vertices().size(); ++i) {
      Vec2 z{};
      Axes axes{1, 0, 0, 1};
      if (!source.offsets().empty()) z = {source.offsets()[2 * i], side * source.offsets()[2 * i + 1]};
      if (!source.axes().empty())
        std::copy_n(source.axes().begin() + static_cast<std::ptrdiff_t>(4 * i), 4, axes.begin());
      const Vec2 u{axes[0], axes[2]}, v{side * axes[1], side * axes[3]};
      const Vec2 there = given[k].position + Vec2{c * z[0] - s * z[1], s * z[0] + c * z[1]};
      const Vec2 turned_u = c * u - s * v, turned_v = s * u + c * v;
      all.add(source.vertices()[i], source.weights()[i], there,
              Axes{turned_u[0], turned_v[0], turned_u[1], turned_v[1]},
              {static_cast<Index>(k), length(z), given[k].position});
    }
  }
  return all;
}

/// Per vertex: half of the largest amount by which a side to a neighbor is longer in the map than on the surface, world units.
/// Only neighbors of the same source, or of the same curve, are compared.
std::vector<double> ExactGeodesics::jumps(std::span<const double> coordinates, std::span<const Index> labels,
                                          bool of_curve) const {
  std::vector<double> jump(labels.size(), 0);
  for (exact::Half h = 0; h < 3 * flat_.surface.face_count(); ++h) {
    const exact::HalfRecord& r = flat_.surface.record(h);
    if (labels[r.tail] < 0 || labels[r.head] < 0) continue;
    if (!of_curve && labels[r.tail] != labels[r.head]) continue;
    const double apart = std::hypot(coordinates[2 * r.head] - coordinates[2 * r.tail],
                                    coordinates[2 * r.head + 1] - coordinates[2 * r.tail + 1]);
    const double excess = (apart - flat_.length_unit * r.length) / 2;
    // A smaller excess is rounding.
    if (!(excess > 1e-9 * apart)) continue;
    jump[r.tail] = std::max(jump[r.tail], excess);
    jump[r.head] = std::max(jump[r.head], excess);
  }
  for (std::size_t v = 0; v < labels.size(); ++v)
    if (labels[v] < 0) jump[v] = std::numeric_limits<double>::quiet_NaN();
  return jump;
}

LogMap ExactGeodesics::log_map(const SurfacePoint& source, const std::optional<Vec3>& u_axis,
                               const ExactMapOptions& options) const {
  const ExactSource one{source, u_axis};
  return log_map(std::span(&one, 1), options).map;
}

LogMap ExactGeodesics::log_map(Vertex source, const ExactMapOptions& options) const {
  return log_map(at_vertex(flat_, source), Source::at_vertex(source), options).map;
}

ExactGeodesics::PlacedSources ExactGeodesics::at_vertex(const FlatTriangles& flat, Vertex source) {
  return {{flat.surface.vertex_point(source)}, {from_frame(flat, source.index, {1, 0, 0, 1})}, {}, {Vec2{}}};
}

ExactGeodesics::Workspace::Workspace(const ExactGeodesics& geodesics)
    : windows_(std::make_unique<exact::Propagation>(geodesics.flat_.surface, exact::ExactOptions{},
                                                    std::span<const exact::MeshPoint>())) {}
ExactGeodesics::Workspace::~Workspace() = default;
ExactGeodesics::Workspace::Workspace(Workspace&&) noexcept = default;
ExactGeodesics::Workspace& ExactGeodesics::Workspace::operator=(Workspace&&) noexcept = default;

ExactGeodesics::Seeds ExactGeodesics::seeds(const SurfacePoint& source, const std::optional<Vec3>& u_axis,
                                            const ExactMapOptions& options, Workspace& workspace) const {
  const ExactSource one{source, u_axis};
  return seeds(placed(std::span(&one, 1)), options, workspace);
}

ExactGeodesics::Seeds ExactGeodesics::seeds(Vertex source, const ExactMapOptions& options, Workspace& workspace) const {
  return seeds(at_vertex(flat_, source), options, workspace);
}

ExactGeodesics::Seeds ExactGeodesics::seeds(const PlacedSources& from, const ExactMapOptions& options,
                                            Workspace& workspace) const {
  exact::Propagation& windows = *workspace.windows_;
  windows.clear(window_options(options));
  const exact::MeshPoint source = exact::checked(flat_.surface, from.points[0], "source");
  windows.add_sources(std::span(&source, 1));
  windows.run(options.progress);
  windows.check_reached();
  const Index vertex = windows.origin(0).vertex;
  const double scale = vertex >= 0 ? flat_.surface.angle_scale(vertex) : 1;
  const Axes& axes = from.axes[0];
  const bool mirrored_source = axes[0] * axes[3] < axes[1] * axes[2];
  Seeds seeds{{}, flat_.length_unit * windows.horizon()};
  for (const Index v : windows.touched()) {
    const double distance = windows.distance_of(v);
    if (!(distance <= windows.horizon())) continue;
    const exact::ArrivalRecord& in = windows.arrival_of(v);
    const VertexArrival arrival = options.frames && in.half >= 0 ? arrival_at(flat_, in.half, in.from)
                                                                 : VertexArrival{NAN, mirrored_at(flat_, v)};
    const double departure = distance > 0 ? scale * in.direction : NAN;
    seeds.vertices.push_back({.vertex = Vertex(v),
                              .distance = flat_.length_unit * distance,
                              .direction = in_axes(axes, {std::cos(departure), std::sin(departure)}),
                              .arrival = {std::cos(arrival.angle), std::sin(arrival.angle)},
                              .mirrored = (mirrored_source != in.mirrored) != arrival.mirrored});
  }
  return seeds;
}

exact::ExactOptions ExactGeodesics::window_options(const ExactMapOptions& options) const {
  exact::ExactOptions result;
  result.radius = options.radius / flat_.length_unit;
  result.max_windows = options.max_windows;
  result.max_vertices = options.max_vertices;
  result.progress = options.progress;
  return result;
}

exact::ExactMap ExactGeodesics::exact_map(const PlacedSources& from, const ExactMapOptions& options) const {
  return exact::exact_map(flat_.surface, from.points, window_options(options));
}

LabelledLogMap ExactGeodesics::log_map(std::span<const ExactSource> sources, const ExactMapOptions& options) const {
  const PlacedSources from = placed(sources);
  return log_map(from, joined(sources, from), options);
}

LabelledLogMap ExactGeodesics::log_map(const PlacedSources& from, Source source, const ExactMapOptions& options) const {
  const exact::ExactMap exact = exact_map(from, options);
  std::vector<double> coordinates;
  std::vector<Index> labels;
  MapExtras extras;
  extras.method = Method::exact;
  extras.radius = options.radius;
  const auto size = static_cast<std::size_t>(exact.size());
  coordinates.reserve(2 * size);
  labels.reserve(size);
  extras.distances.reserve(size);
  if (options.frames) extras.frames.reserve(4 * size);
  for (Index i = 0; i < exact.size(); ++i) {
    const Vertex v(i);
    const Index label = exact.source(v);
    const Axes a = label < 0 ? Axes{1, 0, 0, 1} : from.axes[label];
    const Vec2 w = flat_.length_unit * exact.coordinates(v);
    const Vec2 phi = in_axes(a, w);
    const Vec2 start = label < 0 ? Vec2{} : from.positions[label];
    coordinates.insert(coordinates.end(), {start[0] + phi[0], start[1] + phi[1]});
    extras.distances.push_back(flat_.length_unit * exact.distance(v));
    labels.push_back(label);
    if (!options.frames) continue;
    Axes frame{1, 0, 0, 1};
    if (exact.status(v) == Status::ok)
      frame = exact.arrival(v).half >= 0
                  ? axes_at(arrival_at(flat_, exact.arrival(v).half, exact.arrival(v).from).angle -
                            std::atan2(phi[1], phi[0]))
                  : in_frame(flat_, i, a);
    extras.frames.insert(extras.frames.end(), frame.begin(), frame.end());
  }
  extras.spread = jumps(coordinates, labels, source.is_curve());
  if (source.is_curve()) extras.nearest = labels;
  LogMap map(2, Variant::adaptive, Strategy::automatic, std::move(source), std::move(coordinates),
             {exact.status().begin(), exact.status().end()}, std::move(extras));
  return {std::move(map), std::move(labels)};
}

exact::GeodesicPath ExactGeodesics::path(std::span<const SurfacePoint> stops, bool closed) const {
  std::vector<exact::MeshPoint> points;
  for (const SurfacePoint& stop : stops) points.push_back(point(stop));
  exact::GeodesicPath path = exact::geodesic_path(flat_.surface, points, closed);
  path.length *= flat_.length_unit;
  return path;
}

std::vector<exact::GeodesicPath> ExactGeodesics::paths(std::span<const std::array<SurfacePoint, 2>> pairs,
                                                       const Progress& progress, unsigned threads) const {
  std::vector<exact::PointPair> ends;
  for (const auto& [from, to] : pairs) ends.push_back({point(from), point(to)});
  std::vector<exact::GeodesicPath> paths = exact::geodesic_paths(flat_.surface, ends, progress, threads);
  for (exact::GeodesicPath& path : paths) path.length *= flat_.length_unit;
  return paths;
}

exact::GeodesicPath ExactGeodesics::shortened(std::span<const exact::MeshPoint> curve, bool closed) const {
  exact::GeodesicPath path =
      closed ? exact::shortened_loop(flat_.surface, curve) : exact::shortened_path(flat_.surface, curve);
  path.length *= flat_.length_unit;
  return path;
}

exact::GeodesicPath ExactGeodesics::locally_shortest_path(const SurfacePoint& from, const SurfacePoint& to) const {
  const exact::MeshPoint start = point(from), end = point(to);
  std::function<double(Vertex)> straight;
  if (!flat_.positions.empty()) {
    // A little less than the straight line, as a margin for rounding.
    straight = [this, at = position(end), scale = (1 - 1e-12) / flat_.length_unit](Vertex v) {
      return scale * distance(flat_.positions[v.index], at);
    };
  }
  exact::GeodesicPath path = exact::locally_shortest_path(flat_.surface, start, end, straight);
  path.length *= flat_.length_unit;
  return path;
}

exact::TracedPath ExactGeodesics::trace(const SurfacePoint& from, const Vec3& direction, double length) const {
  const exact::MeshPoint start = point(from);
  const Axes a = axes(from, surface_->source(from, direction), start);
  double angle = std::atan2(a[2], a[0]);
  if (angle < 0) angle += 2 * std::numbers::pi;
  exact::TracedPath path = exact::trace(flat_.surface, start, angle, length / flat_.length_unit);
  path.length *= flat_.length_unit;
  return path;
}

LogMap exact_log_map(const Surface& surface, const SurfacePoint& source, const std::optional<Vec3>& u_axis,
                     const ExactMapOptions& options) {
  return ExactGeodesics(surface).log_map(source, u_axis, options);
}

}  // namespace ahm
