// Local maps in compressed rows, by rows of the input.
#include <numeric>
#include <optional>
#include <utility>

#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/surface/row_local_maps.hpp"
#include "body.hpp"
#include "compute.hpp"
#include "map.hpp"
#include "options.hpp"
#include "parts.hpp"

namespace ahm::python {
namespace {

/// Local maps of a grid or graph, whose rows are its vertices.
RowLocalMaps by_rows(LocalMaps maps) {
  std::vector<Row> rows;
  rows.reserve(maps.neighbors.size());
  for (const Vertex j : maps.neighbors) rows.emplace_back(j.index);
  return std::move(maps).renamed(std::move(rows));
}

/// A body, and a solver for polar maps on it if there is one.
struct Given {
  explicit Given(const py::object& given) {
    if (py::isinstance<PolarSolver>(given)) polar = given.cast<PolarSolverPtr>();
    body = polar ? polar->body : given.cast<BodyPtr>();
  }

  BodyPtr body;
  PolarSolverPtr polar;
};

/// Calls use(solver) with the solver of `given`, or with a new one.
template <class Use>
RowLocalMaps with_solver(const Given& given, const LocalMapOptions& options, const Use& use) {
  if (given.polar) return use(given.polar->solver);
  const PolarSolverOptions o{.threads = options.heat.threads};
  if (const Surface* surface = given.body->surface()) return use(PolarMapSolver(*surface, o));
  return use(PolarMapSolver(given.body->graph(), o));
}

RowLocalMaps of_all_rows(const Given& given, const LocalMapOptions& options) {
  const Body& body = *given.body;
  if (body.surface() != nullptr && options.method == Method::heat) return row_local_maps(*body.surface(), options);
  if (options.method == Method::heat) return by_rows(local_maps(body.graph(), options));
  return with_solver(given, options, [&](const PolarMapSolver& solver) {
    if (body.surface() != nullptr) return row_local_maps(solver, options);
    std::vector<Vertex> vertices;
    for (Index v = 0; v < body.graph().size(); ++v) vertices.emplace_back(v);
    return by_rows(solver.local_maps(vertices, options));
  });
}

RowLocalMaps of_points(const Given& given, const Places& at, const std::optional<Vec3>& axis,
                       const LocalMapOptions& options) {
  const Body& body = *given.body;
  const std::vector<Source> sources = body.plain_sources(at, axis);  // errors name the source
  if (body.surface() == nullptr) {
    if (options.method == Method::heat) return by_rows(local_maps(body.graph(), sources, options));
    return with_solver(given, options,
                       [&](const PolarMapSolver& s) { return by_rows(s.local_maps(sources, options)); });
  }
  std::vector<SurfacePoint> points;
  for (const Place& place : at.places) points.push_back(body.point(place));
  if (options.method == Method::heat) return row_local_maps(*body.surface(), points, options, axis);
  return with_solver(given, options,
                     [&](const PolarMapSolver& solver) { return row_local_maps(solver, points, options, axis); });
}

LocalMapOptions local_options(const py::dict& options) {
  LocalMapOptions o{.method = Method::heat};
  read(options, "radius", o.radius);
  read(options, "k", o.k);
  read(options, "margin", o.margin);
  read(options, "quality", o.quality);
  read_choice(options, "method", o.method, {{"heat", Method::heat}, {"polar", Method::polar}});
  o.heat = heat_options(options).diffusion();
  return o;
}

/// @param transport  whether to keep the transports
/// @param quality    whether the quality was computed
py::dict arrays(RowLocalMaps&& maps, bool transport, bool quality) {
  using namespace py::literals;
  const auto entries = static_cast<py::ssize_t>(maps.neighbors.size());
  const py::ssize_t d = maps.dimension;
  const bool complex = maps.kind == TransportKind::rotation2;
  return py::dict(
      "indptr"_a = owned(std::move(maps.indptr)), "indices"_a = owned<Row, Index>(std::move(maps.neighbors), {entries}),
      "log"_a = owned<double>(std::move(maps.logs), {entries, d}), "distance"_a = owned(std::move(maps.distances)),
      "weight"_a = owned(std::move(maps.weights)),
      "transport"_a = transport ? py::object(owned<double>(std::move(maps.transports),
                                                           complex ? Shape{entries, 2} : Shape{entries, d, d}))
                                : py::object(py::none()),
      "quality"_a = quality ? py::object(owned(std::move(maps.quality))) : py::object(py::none()));
}

/// Local maps of points, or of all rows if `sources` is None.
/// @param on  a Body or a PolarSolver
py::dict local_maps_of(const py::object& on, const py::object& sources, const py::object& u_axis,
                       const py::dict& options, const py::object& report) {
  LocalMapOptions o = local_options(options);
  std::optional<Places> at;
  if (!sources.is_none()) at = places(sources.cast<py::tuple>());
  const auto axis = optional_vector(u_axis);
  bool transport = true;
  read(options, "transport", transport);
  const auto found = [=, given = Given(on)](const Progress& progress) mutable {
    o.heat.progress = progress;
    return at ? of_points(given, *at, axis, o) : of_all_rows(given, o);
  };
  return arrays(compute(report, py::none(), found), transport, o.quality);
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
    RowLocalMaps found = row_local_maps(body->surface_for("a curve"), std::span<const Source>(&drawn.source, 1), o);
    return std::pair(std::move(found), std::move(drawn));
  });
  return py::make_tuple(arrays(std::move(maps), false, false), owned(std::move(curve.points)), curve.length);
}

}  // namespace

void add_local_maps(py::module_& module) {
  module.def("local_maps", &local_maps_of);
  module.def("local_stroke", &local_stroke);
}

}  // namespace ahm::python
