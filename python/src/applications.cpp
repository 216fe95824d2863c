// Strokes, cells, spread points and means.
#include <limits>
#include <utility>

#include "ahm/applications/cells.hpp"
#include "ahm/applications/mean.hpp"
#include "ahm/applications/surface_curve.hpp"
#include "ahm/error.hpp"
#include "compute.hpp"
#include "map.hpp"
#include "options.hpp"
#include "parts.hpp"

namespace ahm::python {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A log map from a curve, and the curve as drawn: points, length.
py::tuple stroke(const SolverPtr& solver, const py::tuple& points, bool closed, bool circle, const py::dict& options,
                 const py::object& report) {
  MapOptions o;
  read(options, "radius", o.radius);
  read(options, "frames", o.frames);
  const Places at = places(points);
  const StrokeOptions shape{closed, circle ? StrokeShape::circle : StrokeShape::line};
  auto [map, curve] = compute(report, py::none(), [=](const Progress& progress) mutable {
    o.progress = progress;
    const Surface& surface = solver->body->surface_for("a stroke");
    SurfaceCurve drawn = draw_curve(surface, at.places, shape);
    PlacedSource source{drawn.source, drawn.points.front(), drawn.first, std::nullopt};
    LogMap solved = solver->solver.solve(drawn.source, o);
    return std::pair(std::make_shared<Map>(solver->body, std::move(source), std::move(solved)), std::move(drawn));
  });
  return py::make_tuple(map, owned(std::move(curve.points)), curve.length);
}

/// Label and distance by row.
py::tuple cells(const BodyPtr& body, const py::tuple& sources, const py::object& report) {
  const Places at = places(sources);
  auto found = compute(report, py::none(), [=](const Progress&) {
    const VoronoiCells all = voronoi_cells(body->graph(), body->vertices_near(at));
    if (body->surface() == nullptr) return all;
    const auto n = static_cast<std::size_t>(body->rows());
    VoronoiCells rows{std::vector<Index>(n, -1), std::vector<double>(n, nan)};
    for (std::size_t r = 0; r < n; ++r) {
      const auto vertex =
          body->surface()->rows().least(Row(static_cast<Index>(r)), [&](Vertex v) { return all.distances[v.index]; });
      if (vertex) rows.labels[r] = all.labels[vertex->index], rows.distances[r] = all.distances[vertex->index];
    }
    return rows;
  });
  return py::make_tuple(owned(std::move(found.labels)), owned(std::move(found.distances)));
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
py::tuple center(const SolverPtr& solver, const py::tuple& points, const Doubles& weights, bool median,
                 const py::object& start, const py::dict& options, const py::object& report) {
  CenterOptions o;
  read(options, "max_maps", o.max_maps);
  read(options, "radius", o.radius);
  const Places at = places(points);
  std::optional<Places> begin;
  if (!start.is_none()) begin = places(start.cast<py::tuple>());
  const auto given = numbers(weights);
  const Center found = compute(report, weights, [=](const Progress&) mutable {
    const Body& body = *solver->body;
    if (begin) o.start = body.vertices_near(*begin)[0];
    const auto find = median ? geometric_median : karcher_mean;
    return find(solver->solver, body.vertices_near(at), given, o);
  });
  const Body& body = *solver->body;
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
  module.def("cells", &cells);
  module.def("farthest", &farthest);
  module.def("center", &center);
}

}  // namespace ahm::python
