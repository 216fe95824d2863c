// Parallel transport, extension of scalars, distances and curvature, by rows.
#include <utility>
#include <vector>

#include "ahm/cholesky/eigenpairs.hpp"
#include "ahm/error.hpp"
#include "ahm/fields/distance.hpp"
#include "ahm/fields/vector_heat.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/surface/directions.hpp"
#include "compute.hpp"
#include "heat/component_scales.hpp"
#include "map.hpp"
#include "options.hpp"
#include "parts.hpp"

namespace ahm::python {
namespace {

/// Converts a field from vertices to rows. Each row gets the value of its first vertex.
VertexField by_rows(const Body& body, VertexField field) {
  if (body.surface() == nullptr) return field;
  const auto width = static_cast<std::size_t>(field.width);
  const auto n = static_cast<std::size_t>(body.rows());
  VertexField result{field.width, std::vector<double>(n * width, nan), std::vector<Status>(n, Status::removed)};
  for (std::size_t r = 0; r < n; ++r) {
    const auto vertex = body.surface()->rows().vertex(Row(static_cast<Index>(r)));
    if (!vertex) continue;
    const auto v = static_cast<std::size_t>(vertex->index);
    for (std::size_t k = 0; k < width; ++k) result.values[r * width + k] = field.values[v * width + k];
    result.status[r] = field.status[v];
  }
  return result;
}

/// Converts vectors at all vertices from components in their frames to vectors in space.
std::vector<double> in_space(const TangentGraph& graph, const VertexField& field) {
  std::vector<double> result(3 * field.status.size(), nan);
  for (std::size_t v = 0; v < field.status.size(); ++v) {
    const auto frame = graph.frame(static_cast<Index>(v));
    if (!frame) throw InvalidArgument("vectors: the surface has no frames in space; use components in its frames");
    for (std::size_t c = 0; c < 3; ++c)
      result[3 * v + c] = field.values[2 * v] * frame->x[c] + field.values[2 * v + 1] * frame->y[c];
  }
  return result;
}

/// Converts vectors in space to components in frames.
/// @param frame_of  returns the frame of point k, or none
template <class FrameOf>
std::vector<double> in_frames(std::span<const double> vectors, const FrameOf& frame_of) {
  std::vector<double> result;
  for (std::size_t k = 0; 3 * k < vectors.size(); ++k) {
    const std::optional<Frame> frame = frame_of(k);
    if (!frame) throw InvalidArgument("vectors: the surface has no frames in space; use components in its frames");
    for (const Vec3* axis : {&frame->x, &frame->y}) {
      double sum = 0;
      for (std::size_t c = 0; c < 3; ++c) sum += (*axis)[c] * vectors[3 * k + c];
      result.push_back(sum);
    }
  }
  return result;
}

py::tuple arrays(VertexField&& field) {
  const auto n = static_cast<py::ssize_t>(field.status.size());
  const Shape shape = field.width == 1 ? Shape{n} : Shape{n, field.width};
  return py::make_tuple(owned<double>(std::move(field.values), shape),
                        owned<Status, std::uint8_t>(std::move(field.status), {n}));
}

py::tuple extend(const SolverPtr& solver, const py::tuple& points, const Doubles& values, const py::object& report) {
  const Places at = places(points);
  const auto given = numbers(values);
  return arrays(compute(report, values, [=](const Progress& progress) {
    const Body& body = *solver->body;
    return by_rows(body, in_one_step(progress, "extend", [&] {
                     return at.all_rows() ? extend_scalar(solver->solver, body.vertices_near(at), given)
                                          : extend_scalar(solver->solver, body.plain_sources(at), given);
                   }));
  }));
}

/// Parallel transports vectors from points to all vertices.
/// @param space  whether the vectors are in space; otherwise they are components in the frame of each point
VertexField carried(const Solver& by, const Places& at, std::span<const double> given, bool space) {
  const Body& body = *by.body;
  if (at.all_rows()) {
    const std::vector<Vertex> vertices = body.vertices_near(at);
    if (!space) return transport_vectors(by.solver, vertices, given);
    const auto frame = [&](std::size_t k) { return body.graph().frame(vertices[k].index); };
    return transport_vectors(by.solver, vertices, in_frames(given, frame));
  }
  const std::vector<SurfaceSource> placed = body.sources(at);
  std::vector<Source> sources;
  for (const SurfaceSource& one : placed) sources.push_back(one.source);
  if (!space) return transport_vectors(by.solver, sources, given);
  return transport_vectors(by.solver, sources, in_frames(given, [&](std::size_t k) { return placed[k].frame; }));
}

py::tuple transport(const SolverPtr& solver, const py::tuple& points, const Doubles& vectors,
                    const py::object& report) {
  const Places at = places(points);
  const auto given = numbers(vectors);
  const bool space = vectors.shape(1) == 3 && solver->body->graph().dimension() == 2;
  return arrays(compute(report, vectors, [=](const Progress& progress) {
    VertexField field = in_one_step(progress, "transport", [&] { return carried(*solver, at, given, space); });
    if (space) field = {3, in_space(solver->body->graph(), field), field.status};
    return by_rows(*solver->body, std::move(field));
  }));
}

/// Joins several sources to one.
Source together(const Body& body, const Places& at) {
  if (at.size() == 1) return body.sources(at)[0].source;
  return at.all_rows() ? Source::at_vertices(body.vertices_near(at)) : Source::joined(body.plain_sources(at));
}

py::tuple heat_distance(const SolverPtr& solver, const py::tuple& sources, const py::object& report) {
  const Places at = places(sources);
  auto found = compute(report, py::none(), [=](const Progress& progress) {
    const Body& body = *solver->body;
    DistanceField field =
        in_one_step(progress, "distance", [&] { return distance_and_gradient(solver->solver, together(body, at)); });
    if (body.surface() != nullptr && body.graph().frame(0))
      field.gradient = {3, in_space(body.graph(), field.gradient), field.gradient.status};
    return std::pair(by_rows(body, std::move(field.distance)), by_rows(body, std::move(field.gradient)));
  });
  const py::tuple distance = arrays(std::move(found.first));
  return py::make_tuple(distance[0], arrays(std::move(found.second))[0]);
}

/// @return distance of each row, and the number of its nearest source or -1
py::tuple front_distance(const BodyPtr& body, const py::tuple& sources, double radius, const py::object& report) {
  const Places at = places(sources);
  auto found = compute(report, py::none(), [=](const Progress& progress) {
    progress.step("front", 0);
    const TangentGraph& graph = body->graph();
    Wavefront front(graph, Wavefront::one_rings_within(graph, radius, 0));
    for (const SurfaceSource& source : body->sources(at)) front.add(source.source);
    front.run(radius);
    progress.step("front", 1);
    const auto n = static_cast<std::size_t>(body->rows());
    std::pair result(std::vector<double>(n, nan), std::vector<Index>(n, -1));
    const auto nearest = [&](Row row) -> std::optional<Vertex> {
      if (body->surface() == nullptr) return Vertex(row.index);
      return body->surface()->rows().least(row, [&](Vertex v) { return front.distance(v); });
    };
    for (std::size_t r = 0; r < n; ++r) {
      const auto vertex = nearest(Row(static_cast<Index>(r)));
      if (!vertex || front.nearest(*vertex) < 0 || front.distance(*vertex) > radius) continue;
      result.first[r] = front.distance(*vertex), result.second[r] = front.nearest(*vertex);
    }
    return result;
  });
  return py::make_tuple(owned(std::move(found.first)), owned(std::move(found.second)));
}

/// Diffusion time tau of each vertex, in squared graph units.
py::array taus(const BodyPtr& body, double t_coef) {
  return owned(compute([=] { return diffusion_times(ComponentScales(body->graph()), t_coef); }));
}

/// @param column_begin, rows, values  upper triangle of a symmetric matrix in compressed columns
/// @return eigenvalues, (k,), and eigenvectors, (k, n)
py::tuple smallest(const Offsets& column_begin, const Offsets& rows, const Doubles& values, const Doubles& masses,
                   Offset count, unsigned threads, const py::object& report) {
  const auto copy = [](const auto& array) { return std::vector(numbers(array).begin(), numbers(array).end()); };
  const SparseUpper L{false, copy(column_begin), copy(rows), copy(values)};
  const auto m = numbers(masses);
  Eigenpairs found = compute(
      report, masses, [=](const Progress& progress) { return smallest_eigenpairs(L, m, count, threads, progress); });
  return py::make_tuple(owned(std::move(found.values)),
                        owned<double>(std::move(found.vectors), {static_cast<py::ssize_t>(count), length(m)}));
}

py::tuple curvature(const BodyPtr& body, unsigned threads, const py::object& report) {
  if (body->graph().dimension() != 2 || !body->graph().frame(0))
    throw InvalidArgument("surface: this one has no tangent planes in space; use a mesh or a cloud");
  PrincipalCurvatures k = compute(report, py::none(), [body, threads](const Progress& progress) {
    return in_one_step(progress, "curvature", [&] { return curvature_directions(body->graph(), threads); });
  });
  VertexField values =
      by_rows(*body, {2, std::move(k.values), std::vector<Status>(static_cast<std::size_t>(body->graph().size()))});
  VertexField field{2, std::move(k.directions), std::vector<Status>(static_cast<std::size_t>(body->graph().size()))};
  VertexField directions = by_rows(*body, {3, in_space(body->graph(), field), field.status});
  return py::make_tuple(arrays(std::move(values))[0], arrays(std::move(directions))[0]);
}

}  // namespace

void add_fields(py::module_& module) {
  module.def("extend", &extend);
  module.def("transport", &transport);
  module.def("heat_distance", &heat_distance);
  module.def("front_distance", &front_distance);
  module.def("diffusion_times", &taus);
  module.def("smallest_eigenpairs", &smallest);
  module.def("curvature", &curvature);
}

}  // namespace ahm::python
