// Strokes, farthest points and means.
#include <utility>

#include "ahm/applications/cells.hpp"
#include "ahm/applications/mean.hpp"
#include "ahm/applications/stroke.hpp"
#include "ahm/error.hpp"
#include "ahm/util/vec.hpp"
#include "compute.hpp"
#include "errors.hpp"
#include "map.hpp"
#include "options.hpp"
#include "parts.hpp"

namespace ahm::python {

SurfaceCurve draw_stroke(const Body& body, const Places& points, std::span<const Vec2> positions,
                         const StrokeOptions& shape) {
  const Surface& surface = body.surface_for("a stroke");
  for (std::size_t k = 0; k < points.size(); ++k)
    naming(points.where(k), [&] { return surface.source(body.point(points.places[k])); });  // validates the point
  return naming(points.name, [&] {
    return positions.empty() ? draw_curve(surface, points.places, shape)
                             : draw_curve(surface, points.places, positions, shape.closed);
  });
}

namespace {

LogMap solve(const Maker& maker, const SurfaceCurve& curve, const MapOptions& options) {
  if (const Solver* solver = maker.solver()) return solver->solver.solve(curve.source, options);
  const ExactMapOptions exact{
      .radius = options.radius, .frames = options.frames, .progress = options.progress.value_or(Progress{})};
  return maker.body()->geodesics().log_map(curve.samples, exact).map;
}

/// @param positions  empty, or (u, v) of every point
/// @return the log map from a curve; points, length, gap and jump of the curve on the surface (`SurfaceCurve`)
py::tuple stroke(const py::object& maker, const py::tuple& points, const Doubles& positions, bool closed, bool circle,
                 const py::dict& options, const py::object& report) {
  MapOptions o;
  read(options, "radius", o.radius);
  read(options, "frames", o.frames);
  const Places at = places(points);
  const Maker by(maker);
  const std::span uv(reinterpret_cast<const Vec2*>(positions.data()), static_cast<std::size_t>(positions.size() / 2));
  const StrokeOptions shape{closed, circle ? StrokeShape::circle : StrokeShape::line};
  auto [map, curve] = compute(report, positions, [=](const Progress& progress) mutable {
    o.progress = progress;
    SurfaceCurve drawn = draw_stroke(*by.body(), at, uv, shape);
    SurfaceSource source{drawn.source, drawn.points.front(), drawn.first, std::nullopt};
    const double radius = std::exchange(o.radius, map_radius_of_curve(drawn, o.radius));
    LogMap solved = solve(by, drawn, o);
    RowLogMap rows = rows_from_curve(by.body()->surface_for("a stroke"), solved, drawn, radius);
    const unsigned threads = by.solver() != nullptr ? by.solver()->solver.options().threads : 0;
    auto map = std::make_shared<Map>(by.body(), std::move(source), std::move(solved), threads, std::move(rows));
    return std::pair(std::move(map), std::move(drawn));
  });
  return py::make_tuple(map, owned(std::move(curve.points)), curve.length, curve.gap, curve.jump);
}

/// Farthest point sampling.
/// @param exact  exact distances; otherwise by a front
/// @return rows
py::array farthest(const BodyPtr& body, const py::tuple& first, Index count, bool exact, const py::object& report) {
  const Places at = places(first);
  return owned(compute(report, py::none(), [=](const Progress& progress) {
    std::vector<Index> rows;
    const Vertex begin = body->vertices_near(at).at(0);
    const std::vector<Vertex> among = body->vertices_with_rows();
    for (Vertex vertex : exact ? farthest_points(body->geodesics(), begin, count, {.progress = progress}, among)
                               : farthest_points(body->graph(), begin, count, progress, among))
      if (const auto row = body->row(vertex)) rows.push_back(row->index);
    return rows;
  }));
}

/// A center, its point on the surface, and a map from there.
struct FoundCenter {
  Center center;
  std::optional<Vec3> position;
  std::optional<FacePoint> face;
  std::vector<double> seen;  ///< coordinates of all points in the log map from the center, d numbers per point
};

/// Position of a center in space, world units; none if the surface has no positions.
std::optional<Vec3> position_of(const Body& body, const Center& center) {
  if (body.grid() != nullptr) {
    Vec3 p = body.grid()->position(center.vertex);
    for (std::size_t a = 0; a < center.offset.size(); ++a) p[a] += center.offset[a];
    return p;
  }
  if (body.surface() != nullptr) {
    if (body.surface()->positions().empty()) return std::nullopt;
    return center_position(*body.surface(), center);
  }
  const auto frame = body.graph().frame(center.vertex.index);
  if (!frame || center.offset.size() != 2) return std::nullopt;
  return frame->origin + center.offset[0] * frame->x + center.offset[1] * frame->y;
}

/// Projects a center to the surface, and computes the coordinates of the points in the log map from there.
void place(const Maker& by, std::span<const Source> points, double radius, FoundCenter& found) {
  const Body& body = *by.body();
  Source source = source_at(found.center);
  std::optional<SurfacePoint> point;
  found.position = position_of(body, found.center);
  if (body.surface() != nullptr && found.position) {
    const ClosestPoint closest = body.surface()->closest_point(*found.position);
    found.position = closest.position;
    point = closest.point;
    source = body.surface()->source(*point).source;
    if (const auto* inside = std::get_if<FacePoint>(&*point)) found.face = *inside;
  }
  const auto map = [&] {
    if (by.solver() != nullptr)
      return by.solver()->solver.solve(source, {.radius = radius, .frames = true, .spread = false});
    if (by.polar() == nullptr)
      return body.geodesics().log_map(point.value(), {}, {.radius = radius, .frames = true, .progress = {}});
    const PolarMapOptions options{.radius = radius, .frames = true};
    return point ? by.polar()->solver.log_map(*point, {}, options) : by.polar()->solver.log_map(source, options);
  }();
  for (const Source& p : points)
    for (double z : map.coordinates(p)) found.seen.push_back(z);
}

/// @return row or None, offset, position or None, spread, maps, converged, face or None, barycentric coordinates or None,
/// coordinates of the points in the log map from the center (k x d)
py::tuple center(const py::object& maker, const py::tuple& points, const Doubles& weights, bool median,
                 const py::object& start, const py::dict& options, const py::object& report) {
  CenterOptions o;
  read(options, "max_maps", o.max_maps);
  read(options, "radius", o.radius);
  const Places at = places(points);
  std::optional<Places> begin;
  if (!start.is_none()) begin = places(start.cast<py::tuple>());
  const auto given = numbers(weights);
  const Maker by(maker);
  FoundCenter found = compute(report, weights, [=](const Progress& progress) mutable {
    progress.step("center", 0);
    const Body& body = *by.body();
    if (begin) o.start = body.vertices_near(*begin)[0];
    const std::vector<Source> sources = body.plain_sources(at);
    const auto find = median ? geometric_median_of_points : karcher_mean_of_points;
    FoundCenter made{find(by.maps(), sources, given, o), {}, {}, {}};
    place(by, sources, o.radius, made);
    progress.step("center", 1);
    return made;
  });
  const Body& body = *by.body();
  py::object position = py::none(), row = py::none(), face = py::none(), inside = py::none();
  if (const auto& p = found.position)
    position = owned(std::vector<double>(p->begin(), p->begin() + (body.grid() ? body.graph().dimension() : 3)));
  if (const auto r = body.row(found.center.vertex)) row = py::int_(r->index);
  if (found.face) face = py::int_(found.face->face), inside = owned(std::move(found.face->barycentric));
  const py::ssize_t d = body.graph().dimension();
  const py::ssize_t k = length(found.seen) / d;
  return py::make_tuple(row, owned(std::move(found.center.offset)), position, found.center.spread, found.center.maps,
                        found.center.converged, face, inside, owned<double>(std::move(found.seen), {k, d}));
}

}  // namespace

void add_applications(py::module_& module) {
  module.def("stroke", &stroke);
  module.def("farthest", &farthest);
  module.def("center", &center);
}

}  // namespace ahm::python
