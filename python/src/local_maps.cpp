// Local maps in compressed rows, by rows of the input.
#include <numeric>
#include <optional>
#include <utility>

#include "ahm/surface/row_local_maps.hpp"
#include "body.hpp"
#include "compute.hpp"
#include "map.hpp"
#include "options.hpp"
#include "parts.hpp"

namespace ahm::python {
namespace {

/// Local maps of sources, with rows as neighbors. The rows of graphs and grids are their vertices.
template <class From>
RowLocalMaps to_rows(const Body& body, std::span<const From> sources, const LocalMapOptions& options) {
  if (body.surface()) return row_local_maps(*body.surface(), sources, options);
  LocalMaps maps = local_maps(body.graph(), sources, options);
  std::vector<Row> rows;
  rows.reserve(maps.neighbors.size());
  for (const Vertex j : maps.neighbors) rows.emplace_back(j.index);
  return std::move(maps).renamed(std::move(rows));
}

RowLocalMaps of_all_rows(const Body& body, const LocalMapOptions& options) {
  if (body.surface() != nullptr) return row_local_maps(*body.surface(), options);
  std::vector<Vertex> vertices;
  for (Index v = 0; v < body.graph().size(); ++v) vertices.emplace_back(v);
  return to_rows<Vertex>(body, vertices, options);
}

LocalMapOptions local_options(const py::dict& options) {
  LocalMapOptions o;
  read(options, "radius", o.radius);
  read(options, "k", o.k);
  read(options, "margin", o.margin);
  o.heat = heat_options(options).diffusion();
  return o;
}

py::dict arrays(RowLocalMaps&& maps) {
  using namespace py::literals;
  const auto entries = static_cast<py::ssize_t>(maps.neighbors.size());
  const py::ssize_t d = maps.dimension;
  const bool complex = maps.kind == TransportKind::rotation2;
  return py::dict(
      "indptr"_a = owned(std::move(maps.indptr)), "indices"_a = owned<Row, Index>(std::move(maps.neighbors), {entries}),
      "log"_a = owned<double>(std::move(maps.logs), {entries, d}), "distance"_a = owned(std::move(maps.distances)),
      "weight"_a = owned(std::move(maps.weights)),
      "transport"_a = owned<double>(std::move(maps.transports), complex ? Shape{entries, 2} : Shape{entries, d, d}));
}

/// Local maps of points, or of all rows if `sources` is None.
py::dict local_maps_of(const BodyPtr& body, const py::object& sources, const py::object& u_axis,
                       const py::dict& options, const py::object& report) {
  LocalMapOptions o = local_options(options);
  std::optional<Places> at;
  if (!sources.is_none()) at = places(sources.cast<py::tuple>());
  const auto axis = optional_vector(u_axis);
  return arrays(compute(report, py::none(), [=](const Progress& progress) mutable {
    o.heat.progress = progress;
    if (!at) return of_all_rows(*body, o);
    return to_rows<Source>(*body, body->plain_sources(*at, axis), o);
  }));
}

/// @return the local map of a curve, the corners of the curve on the surface, its length
py::tuple local_stroke(const BodyPtr& body, const py::tuple& points, bool closed, bool circle, const py::dict& options,
                       const py::object& report) {
  LocalMapOptions o = local_options(options);
  const Places at = places(points);
  const StrokeOptions shape{closed, circle ? StrokeShape::circle : StrokeShape::line};
  auto [maps, curve] = compute(report, py::none(), [=](const Progress& progress) mutable {
    o.heat.progress = progress;
    SurfaceCurve drawn = draw_stroke(*body, at, {}, shape);
    RowLocalMaps found = to_rows<Source>(*body, {&drawn.source, 1}, o);
    return std::pair(std::move(found), std::move(drawn));
  });
  return py::make_tuple(arrays(std::move(maps)), owned(std::move(curve.points)), curve.length);
}

}  // namespace

void add_local_maps(py::module_& module) {
  module.def("local_maps", &local_maps_of);
  module.def("local_stroke", &local_stroke);
}

}  // namespace ahm::python
