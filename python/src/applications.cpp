// Strokes, spread points and means.
#include <utility>

#include "ahm/applications/cells.hpp"
#include "ahm/applications/mean.hpp"
#include "ahm/applications/surface_curve.hpp"
#include "ahm/error.hpp"
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
    naming(points.where(k), [&] { return surface.source(body.point(points.places[k])); });  // checks
  return naming(points.name, [&] {
    return positions.empty() ? draw_curve(surface, points.places, shape)
                             : draw_curve(surface, points.places, positions, shape.closed);
  });
}

namespace {

LogMap solve(const Maker& maker, const SurfaceCurve& curve, MapOptions options) {
  if (const Solver* solver = maker.solver()) return solver->solver.solve(curve.source, options);
  const ExactMapOptions exact{
      .radius = options.radius, .frames = options.frames, .progress = options.progress.value_or(Progress{})};
  return maker.body()->geodesics().log_map(curve.samples, exact).map;
}

/// A log map from a curve, and the curve as drawn: points, length, gap, jump.
/// @param positions  empty, or (u, v) of every point
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
    PlacedSource source{drawn.source, drawn.points.front(), drawn.first, std::nullopt};
    LogMap solved = solve(by, drawn, o);
    return std::pair(std::make_shared<Map>(by.body(), std::move(source), std::move(solved)), std::move(drawn));
  });
  return py::make_tuple(map, owned(std::move(curve.points)), curve.length, curve.gap, curve.jump);
}

/// Rows; vertices that no row has (inside refined polygons) are passed over.
py::array farthest(const BodyPtr& body, const py::tuple& first, Index count, const py::object& report) {
  const Places at = places(first);
  return owned(compute(report, py::none(), [=](const Progress& progress) {
    std::vector<Index> rows;
    for (Vertex vertex : farthest_points(body->graph(), body->vertices_near(at).at(0), count, progress))
      if (const auto row = body->row(vertex)) rows.push_back(row->index);
    return rows;
  }));
}

/// row or None, offset, position or None, spread, maps, converged.
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
  const Center found = compute(report, weights, [=](const Progress&) mutable {
    const Body& body = *by.body();
    if (begin) o.start = body.vertices_near(*begin)[0];
    const auto find = median ? geometric_median : karcher_mean;
    return find(by.maps(), body.vertices_near(at), given, o);
  });
  const Body& body = *by.body();
  py::object position = py::none(), row = py::none();
  if (const auto frame = body.graph().frame(found.vertex.index); frame && found.offset.size() == 2) {
    std::vector<double> p(frame->origin.begin(), frame->origin.end());
    for (std::size_t c = 0; c < 3; ++c) p[c] += found.offset[0] * frame->x[c] + found.offset[1] * frame->y[c];
    position = owned(std::move(p));
  }
  if (const auto r = body.row(found.vertex)) row = py::int_(r->index);
  return py::make_tuple(row, owned(std::vector<double>(found.offset)), position, found.spread, found.maps,
                        found.converged);
}

}  // namespace

void add_applications(py::module_& module) {
  module.def("stroke", &stroke);
  module.def("farthest", &farthest);
  module.def("center", &center);
}

}  // namespace ahm::python
