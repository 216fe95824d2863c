// Solvers, and log maps by rows.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/text.hpp"
#include "compute.hpp"
#include "errors.hpp"
#include "map.hpp"
#include "options.hpp"
#include "parts.hpp"

namespace ahm::python {

Map::Map(BodyPtr on, SurfaceSource from, LogMap made, unsigned threads, std::optional<RowLogMap> given)
    : body(std::move(on)), source(std::move(from)), map(std::move(made)), threads(threads) {
  if (body->surface() == nullptr) return;
  rows = given ? *std::move(given) : body->surface()->to_rows(map);
  uv.resize(2 * rows.u.size());
  for (std::size_t r = 0; r < rows.u.size(); ++r) uv[2 * r] = rows.u[r], uv[2 * r + 1] = rows.v[r];
  if (rows.angle.empty())  // maps from curves
    std::ranges::transform(rows.v, rows.u, std::back_inserter(rows.angle),
                           [](double v, double u) { return std::atan2(v, u); });
  rows.u = {}, rows.v = {};
}

Maker::Maker(const py::object& given) {
  if (py::isinstance<Solver>(given))
    solver_ = given.cast<SolverPtr>();
  else if (py::isinstance<PolarSolver>(given))
    polar_ = given.cast<PolarSolverPtr>();
  else
    body_ = given.cast<BodyPtr>();
}

namespace {

/// Checks the memory before any is allocated. @throws ResourceExhausted if maps need far more than the machine has
void check_memory(const TangentGraph& graph) {
  const GraphSize size{graph.size(), graph.dimension(), graph.transport_kind()};
  const double machine = machine_memory();
  const double least =
      std::min(estimate_cost(size, Strategy::global).bytes, estimate_cost(size, Strategy::march).bytes);
  constexpr double trust = 2;  // the estimate may be too large by this factor
  if (machine > 0 && least > trust * machine)
    throw ResourceExhausted("maps on " + std::to_string(size.vertices) + " vertices need about " +
                            detail::number(least / 1e9) + " GB of memory, but the machine has " +
                            detail::number(machine / 1e9) + " GB; make the surface coarser");
}

SolverPtr make_solver(const BodyPtr& body, const py::dict& options, const py::object& report) {
  HeatOptions o = heat_options(options);
  check_memory(body->graph());
  return compute(report, py::none(), [body, o](const Progress& progress) mutable {
    o.progress = progress;
    return std::make_shared<Solver>(Solver{body, LogMapSolver(body->graph(), o)});
  });
}

MapOptions map_options(const py::dict& options) {
  MapOptions o;
  if (Variant variant{}; options.contains("variant")) {
    read_variant(options, variant);
    o.variant = variant;
  }
  read(options, "radius", o.radius);
  if (unsigned threads = 0; read(options, "threads", threads)) o.threads = threads;
  read(options, "frames", o.frames);
  read(options, "spread", o.spread);
  read(options, "distances", o.distances);
  return o;
}

py::list listed(const std::vector<MapPtr>& maps) {
  py::list result;
  for (const MapPtr& map : maps) result.append(map);
  return result;
}

/// One map per source by the heat method.
py::list heat_maps(const SolverPtr& solver, const py::tuple& sources, const py::object& u_axis, const py::dict& options,
                   const py::object& report) {
  MapOptions o = map_options(options);
  const Places from = places(sources);
  const auto axis = optional_vector(u_axis);
  return listed(compute(report, py::none(), [=](const Progress& progress) mutable {
    o.progress = progress;
    std::vector<SurfaceSource> placed = solver->body->sources(from, axis);
    std::vector<Source> plain;
    for (const SurfaceSource& p : placed) plain.push_back(p.source);
    std::vector<LogMap> maps = solver->solver.solve(plain, o);
    std::vector<MapPtr> result;
    for (std::size_t k = 0; k < maps.size(); ++k)
      result.push_back(std::make_shared<Map>(solver->body, std::move(placed[k]), std::move(maps[k]),
                                             o.threads.value_or(solver->solver.options().threads)));
    return result;
  }));
}

/// One map per source, on several threads.
/// @param make  make(place, options) computes the map of one source
template <class Options, class Make>
std::vector<MapPtr> make_each(const Places& from, Options options, unsigned threads, const char* stage,
                              const Make& make) {
  const Progress progress = options.progress;
  if (from.size() > 1) options.progress.report = {};  // reports of single maps would each begin at 0
  std::vector<MapPtr> result(from.size());
  std::atomic<std::size_t> done = 0;
  detail::parallel_chunks(static_cast<Offset>(from.size()), 1, threads, [&](Offset k, Offset) {
    naming(from.where(static_cast<std::size_t>(k)), [&] { result[k] = make(from.places[k], options); });
    const auto share = static_cast<double>(++done) / static_cast<double>(from.size());
    if (from.size() > 1) progress.step(stage, share);
  });
  return result;
}

PolarSolverPtr make_polar_solver(const BodyPtr& body, const py::object& wanted, unsigned threads,
                                 const py::object& report) {
  const auto windows = wanted.is_none() ? std::nullopt : std::optional(wanted.cast<Offset>());
  return compute(report, py::none(), [=](const Progress&) {
    const PolarSolverOptions options{.windows = windows, .threads = threads};
    return body->surface() != nullptr
               ? std::make_shared<PolarSolver>(PolarSolver{body, PolarMapSolver(*body->surface(), options), threads})
               : std::make_shared<PolarSolver>(PolarSolver{body, PolarMapSolver(body->graph(), options), threads});
  });
}

py::list polar_maps(const PolarSolverPtr& solver, const py::tuple& sources, const py::object& u_axis,
                    const py::dict& options, const py::object& report) {
  PolarMapOptions o;
  read(options, "radius", o.radius);
  read(options, "frames", o.frames);
  unsigned threads = solver->threads;
  read(options, "threads", threads);
  const Places from = places(sources);
  const auto axis = optional_vector(u_axis);
  return listed(compute(report, py::none(), [=](const Progress& progress) mutable {
    o.progress = progress;
    const BodyPtr& body = solver->body;
    return make_each(from, o, threads, "polar maps", [&](const Place& place, const PolarMapOptions& options) {
      SurfaceSource placed = body->source(place, axis);
      LogMap map = body->surface() != nullptr ? solver->solver.log_map(body->point(place), axis, options)
                                              : solver->solver.log_map(placed.source, options);
      return std::make_shared<Map>(body, std::move(placed), std::move(map), threads);
    });
  }));
}

py::list exact_maps(const BodyPtr& body, const py::tuple& sources, const py::object& u_axis, const py::dict& options,
                    const py::object& report) {
  ExactMapOptions o;
  read(options, "radius", o.radius);
  read(options, "frames", o.frames);
  unsigned threads = 0;
  read(options, "threads", threads);
  const Places from = places(sources);
  const auto axis = optional_vector(u_axis);
  return listed(compute(report, py::none(), [=](const Progress& progress) mutable {
    o.progress = progress;
    const ExactGeodesics& geodesics = body->geodesics();
    return make_each(from, o, threads, "exact maps", [&](const Place& place, const ExactMapOptions& options) {
      const SurfacePoint point = body->point(place);
      return std::make_shared<Map>(body, body->surface()->source(point, axis), geodesics.log_map(point, axis, options),
                                   threads);
    });
  }));
}

/// Calls put(row, vertex) for each row, with the vertex that the row's numbers are from. Skips rows without one.
template <class Put>
void for_rows(const Map& map, const Put& put) {
  if (map.body->surface() == nullptr) {
    for (Index v = 0; v < map.map.size(); ++v) put(static_cast<std::size_t>(v), static_cast<std::size_t>(v));
    return;
  }
  for (std::size_t r = 0; r < map.rows.vertex.size(); ++r)
    if (const auto& vertex = map.rows.vertex[r]) put(r, static_cast<std::size_t>(vertex->index));
}

py::array uv(const MapPtr& m) {
  const py::ssize_t d = m->map.dimension();
  if (m->body->surface() != nullptr) return viewed<double>(std::span<const double>(m->uv), {m->body->rows(), 2}, m);
  return viewed<double>(m->map.coordinates(), {m->map.size(), d}, m);
}

/// A view of one number per row: of `rows` on meshes and clouds, otherwise of `vertices`.
py::array column(const MapPtr& m, const std::vector<double> RowLogMap::*rows, std::span<const double> vertices) {
  const std::span<const double> values =
      m->body->surface() != nullptr ? std::span<const double>(m->rows.*rows) : vertices;
  return viewed<double>(values, {length(values)}, m);
}

py::array status(const MapPtr& m) {
  const auto values = m->body->surface() != nullptr ? std::span<const Status>(m->rows.status) : m->map.status();
  return viewed<std::uint8_t>(values, {length(values)}, m);
}

py::array angle(const MapPtr& m) {
  if (m->body->surface() != nullptr) return column(m, &RowLogMap::angle, {});
  const auto d = static_cast<std::size_t>(m->map.dimension());
  if (d < 2) throw InvalidArgument("angle: the map has one dimension only");
  const auto phi = m->map.coordinates();
  std::vector<double> result;
  for (std::size_t i = 0; i < phi.size(); i += d) result.push_back(std::atan2(phi[i + 1], phi[i]));
  return owned(std::move(result));
}

/// Converts `width` numbers per vertex to numbers per row; NaN where a row has no vertex.
std::vector<double> by_rows(const Map& map, std::span<const double> values, std::size_t width) {
  std::vector<double> result(static_cast<std::size_t>(map.body->rows()) * width, nan);
  for_rows(map, [&](std::size_t row, std::size_t vertex) {
    for (std::size_t k = 0; k < width; ++k) result[row * width + k] = values[vertex * width + k];
  });
  return result;
}

py::array quality(const MapPtr& m) {
  return owned(compute([m] { return by_rows(*m, map_quality(m->body->graph(), m->map, m->threads), 1); }));
}

void require_frames(const Map& map) {
  if (map.map.frames().empty()) throw InvalidArgument("the map was made without frames; make it with frames=True");
}

py::array frames(const MapPtr& m) {
  require_frames(*m);
  const py::ssize_t d = m->map.dimension();
  return owned<double>(compute([=] { return by_rows(*m, m->map.frames(), static_cast<std::size_t>(d * d)); }),
                       {m->body->rows(), d, d});
}

/// The source's u and v axis at each row, as vectors in space.
std::vector<Vec3> axes_in_space(const Map& map) {
  const auto frames = map.map.frames();
  std::vector<Vec3> result(2 * static_cast<std::size_t>(map.surface().rows().row_count()), Vec3{nan, nan, nan});
  for_rows(map, [&](std::size_t row, std::size_t vertex) {
    const auto at = map.body->graph().frame(static_cast<Index>(vertex));
    if (!at) return;
    const double* U = frames.data() + 4 * vertex;
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t c = 0; c < 3; ++c) result[2 * row + a][c] = U[a] * at->x[c] + U[2 + a] * at->y[c];
  });
  return result;
}

/// @return the source's axes at every row, rows x 2 x 3
py::array axes(const MapPtr& m) {
  require_frames(*m);
  return owned<Vec3, double>(compute([m] { return axes_in_space(*m); }), {m->body->rows(), 2, 3});
}

py::array gradient(const MapPtr& m) {
  require_frames(*m);
  return owned(compute([m] { return distance_gradients(m->surface(), m->map, m->rows); }));
}

py::array corners(const MapPtr& m) {
  std::vector<Vec2> result = compute([m] { return m->surface().to_corners(m->map); });
  const auto n = static_cast<py::ssize_t>(result.size());
  return owned<Vec2, double>(std::move(result), {n, 2});
}

/// @return (u, v) and status at points
py::tuple sample(const MapPtr& m, const py::tuple& points) {
  const Places at = places(points);
  const auto found = compute(py::none(), py::none(), [m, at](const Progress& progress) {
    std::vector<Sample> all;
    for (std::size_t k = 0; k < at.size(); ++k) {
      if (k % 1024 == 0) progress.step("sample", static_cast<double>(k) / static_cast<double>(at.size()));
      all.push_back(naming(at.where(k), [&] { return m->surface().at(m->map, m->body->point(at.places[k])); }));
    }
    return all;
  });
  std::vector<Vec2> values;
  std::vector<std::uint8_t> statuses;
  for (const Sample& s : found) values.push_back({s.u, s.v}), statuses.push_back(static_cast<std::uint8_t>(s.status));
  const auto n = static_cast<py::ssize_t>(values.size());
  return py::make_tuple(owned<Vec2, double>(std::move(values), {n, 2}), owned(std::move(statuses)));
}

/// @return position of the source or None; its u axis, v axis and normal, or None; its row or None
py::tuple source(const MapPtr& m) {
  const SurfaceSource& s = m->source;
  py::object frame = py::none(), row = py::none();
  if (s.frame) frame = owned(std::vector<Vec3>{s.frame->x, s.frame->y, s.frame->normal});
  if (s.row) row = py::int_(s.row->index);
  const bool in_space = s.frame || m->body->surface() != nullptr || m->body->grid() != nullptr;
  py::object position = py::none();
  if (in_space) position = owned(std::vector<double>{s.position[0], s.position[1], s.position[2]});
  return py::make_tuple(position, frame, row);
}

}  // namespace

void add_maps(py::module_& module) {
  py::class_<Solver, SolverPtr>(module, "Solver")
      .def(py::init(&make_solver))
      .def("maps", &heat_maps)
      .def_property_readonly(
          "strategy", [](const Solver& s) { return s.solver.strategy() == Strategy::march ? "march" : "global"; });
  py::class_<PolarSolver, PolarSolverPtr>(module, "PolarSolver")
      .def(py::init(&make_polar_solver))
      .def("maps", &polar_maps);
  py::class_<Map, MapPtr>(module, "Map")
      .def_property_readonly("dimension", [](const Map& m) { return m.map.dimension(); })
      .def_property_readonly("method", [](const Map& m) { return std::string(to_string(m.map.method())); })
      .def_property_readonly("has_frames", [](const Map& m) { return !m.map.frames().empty(); })
      .def("source", &source)
      .def("uv", &uv)
      .def("distance", [](const MapPtr& m) { return column(m, &RowLogMap::distance, m->map.distances()); })
      .def("spread", [](const MapPtr& m) { return column(m, &RowLogMap::spread, m->map.spread()); })
      .def("bounded", [](const MapPtr& m) { return column(m, &RowLogMap::bounded, {}); })
      .def("error_estimate",
           [](const MapPtr& m) { return column(m, &RowLogMap::error_estimate, m->map.error_estimate()); })
      .def("angle", &angle)
      .def("status", &status)
      .def("quality", &quality)
      .def("frames", &frames)
      .def("axes", &axes)
      .def("gradient", &gradient)
      .def("corners", &corners)
      .def("sample", &sample);
  module.def("exact_maps", &exact_maps);
  module.def("choose_method", [](const BodyPtr& body, Index neighbors) {
    return std::string(to_string(compute([body, neighbors] {
      if (body->surface()) return suggested_method(*body->surface(), {.k = neighbors});
      return body->grid() ? body->grid()->suggested_method() : choose_method(body->graph());
    })));
  });
}

}  // namespace ahm::python
