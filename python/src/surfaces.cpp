// Builds surfaces, grids and graphs from arrays, and returns their properties.
#include <array>
#include <utility>

#include "ahm/graph/components.hpp"
#include "ahm/graph/csr_graph.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "body.hpp"
#include "compute.hpp"
#include "options.hpp"
#include "output/warning_text.hpp"
#include "parts.hpp"

namespace ahm::python {
namespace {

template <class S>
BodyPtr body_of(S&& surface) {
  return std::make_shared<Body>(std::unique_ptr<const Surface>(std::make_unique<S>(std::forward<S>(surface))));
}

BodyPtr triangle_mesh(const Doubles& points, const Indices& faces, const py::dict& options, const py::object& report) {
  trimesh::MeshOptions o;
  read(options, "delaunay", o.intrinsic_delaunay);
  read(options, "clamp_weights", o.clamp_weights);
  read(options, "threads", o.threads);
  read_choice(options, "non_manifold", o.non_manifold, {{"error", NonManifold::error}, {"split", NonManifold::split}});
  const auto positions = vectors(points);
  const std::span triangles(reinterpret_cast<const Triangle*>(faces.data()), static_cast<std::size_t>(faces.shape(0)));
  return compute(report, py::make_tuple(points, faces), [=](const Progress& progress) mutable {
    o.progress = progress;
    return body_of(trimesh::TriangleMeshSurface::build(positions, triangles, o));
  });
}

BodyPtr polygon_mesh(const Doubles& points, const Offsets& begin, const Indices& corners, const py::dict& options,
                     const py::object& report) {
  using polymesh::Discretization;
  polymesh::PolygonOptions o;
  read(options, "delaunay", o.intrinsic_delaunay);
  read(options, "clamp_weights", o.clamp_weights);
  read(options, "threads", o.threads);
  read_choice(options, "non_manifold", o.non_manifold, {{"error", NonManifold::error}, {"split", NonManifold::split}});
  read_choice(options, "discretization", o.discretization,
              {{"automatic", Discretization::automatic},
               {"polygons", Discretization::polygons},
               {"refined", Discretization::refined}});
  const auto positions = vectors(points);
  const auto face_begin = numbers(begin);
  const auto face_vertices = numbers(corners);
  return compute(report, py::make_tuple(points, begin, corners), [=](const Progress& progress) mutable {
    o.progress = progress;
    return body_of(polymesh::PolygonMeshSurface::build(positions, face_begin, face_vertices, o));
  });
}

BodyPtr point_cloud(const Doubles& points, const py::object& normals, const py::dict& options,
                    const py::object& report) {
  using pointcloud::NormalSigns;
  pointcloud::CloudOptions o;
  if (Index k = 0; read(options, "k", k)) o.k = k;
  if (Indices rows; read(options, "rows", rows)) o.rows.emplace(numbers(rows).begin(), numbers(rows).end());
  if (double smooth = 0; read(options, "smooth", smooth)) o.smooth = smooth;
  read(options, "max_edge_ratio", o.max_edge_ratio);
  read(options, "drop_non_finite", o.drop_non_finite);
  read(options, "threads", o.threads);
  read_choice(options, "normal_signs", o.normal_signs,
              {{"automatic", NormalSigns::automatic},
               {"oriented", NormalSigns::oriented},
               {"unoriented", NormalSigns::unoriented}});
  const auto positions = vectors(points);
  std::span<const Vec3> given;
  if (!normals.is_none()) given = vectors(normals.cast<Doubles>());
  return compute(report, py::make_tuple(points, normals), [=](const Progress& progress) mutable {
    o.progress = progress;
    return body_of(pointcloud::PointCloudSurface::build(positions, given, o));
  });
}

BodyPtr grid(const Indices& shape, const Doubles& spacing, const Doubles& origin, const Bytes& blocked) {
  const auto copy = [](const auto& array) { return std::vector(numbers(array).begin(), numbers(array).end()); };
  grid::Grid g{copy(shape), copy(spacing), copy(origin), copy(blocked)};
  return compute(py::none(), py::none(), [g = std::move(g)](const Progress&) mutable {
    return std::make_shared<Body>(std::make_unique<const grid::GridGraph>(std::move(g)));
  });
}

/// @param array  (n, 4, 3): origin, x axis, y axis and normal of each frame
std::vector<Frame> frames_of(const Doubles& array) {
  std::vector<Frame> result(static_cast<std::size_t>(array.size() / 12));
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto* v = reinterpret_cast<const Vec3*>(array.data() + 12 * i);
    result[i] = {v[0], v[1], v[2], v[3]};
  }
  return result;
}

BodyPtr graph(const Offsets& begin, const Indices& neighbors, const Doubles& weights, const Doubles& logs,
              const Doubles& transports, const Doubles& masses, const py::dict& options) {
  const auto copy = [](const auto& array) { return std::vector(numbers(array).begin(), numbers(array).end()); };
  CsrGraphData data;
  data.dimension = static_cast<int>(logs.shape(1));
  data.kind = transports.ndim() == 2 ? TransportKind::rotation2 : TransportKind::block;
  data.row_begin = copy(begin), data.neighbors = copy(neighbors), data.weights = copy(weights);
  data.logs = copy(logs), data.transports = copy(transports), data.masses = copy(masses);
  if (Doubles frames; read(options, "frames", frames)) data.frames = frames_of(frames);
  if (double h = 0; read(options, "mean_edge_length", h)) data.mean_edge_length = h;
  read(options, "length_unit", data.length_unit);
  read(options, "is_delaunay", data.is_delaunay);
  return compute(py::none(), py::none(), [data = std::move(data)](const Progress&) mutable {
    auto made = std::make_unique<const CsrGraph>(std::move(data));
    validate(*made);
    return std::make_shared<Body>(std::unique_ptr<const TangentGraph>(std::move(made)));
  });
}

py::object positions(const BodyPtr& body) {
  if (const Surface* s = body->surface()) return viewed<double>(s->positions(), {length(s->positions()), 3}, body);
  if (body->grid() == nullptr) return py::none();
  return owned(compute([=] {
    std::vector<Vec3> all(static_cast<std::size_t>(body->rows()));
    for (Index v = 0; v < body->rows(); ++v) all[v] = body->grid()->position(Vertex(v));
    return all;
  }));
}

py::object faces(const BodyPtr& body) {
  const FaceList faces = body->surface() == nullptr ? FaceList{} : body->surface()->faces();
  if (faces.size() == 0) return py::none();
  return py::make_tuple(viewed<Offset>(faces.begin, {length(faces.begin)}, body),
                        viewed<Index>(faces.vertices, {length(faces.vertices)}, body));
}

/// @return frames of all vertices, (n, 4, 3): origin, x axis, y axis, normal; None if a vertex has none
py::object frames(const BodyPtr& body) {
  std::vector<Frame> result = compute([=] {
    std::vector<Frame> all;
    for (Index v = 0; v < body->graph().size(); ++v) {
      const auto frame = body->graph().frame(v);
      if (!frame) return std::vector<Frame>();
      all.push_back(*frame);
    }
    return all;
  });
  if (result.empty()) return py::none();
  const py::ssize_t n = length(result);
  return owned<Frame, double>(std::move(result), {n, 4, 3});
}

py::array vertex_of_row(const BodyPtr& body) {
  std::vector<Index> result(static_cast<std::size_t>(body->rows()), -1);
  for (Index r = 0; r < body->rows(); ++r) {
    const auto vertex = body->surface() == nullptr ? Vertex(r) : body->surface()->rows().vertex(Row(r));
    if (vertex) result[r] = vertex->index;
  }
  return owned(std::move(result));
}

py::array row_of_vertex(const BodyPtr& body) {
  std::vector<Index> result(static_cast<std::size_t>(body->graph().size()), -1);
  for (Index v = 0; v < length(result); ++v)
    if (const auto row = body->row(Vertex(v))) result[v] = row->index;
  return owned(std::move(result));
}

/// Concatenates the stars of all vertices.
CsrGraphData rows_of(const TangentGraph& graph) {
  CsrGraphData all;
  all.row_begin = {0};
  for (Index v = 0; v < graph.size(); ++v) {
    const Star star = graph.star(v);
    all.neighbors.insert(all.neighbors.end(), star.neighbors.begin(), star.neighbors.end());
    all.weights.insert(all.weights.end(), star.weights.begin(), star.weights.end());
    all.logs.insert(all.logs.end(), star.logs.begin(), star.logs.end());
    all.transports.insert(all.transports.end(), star.transports.begin(), star.transports.end());
    all.row_begin.push_back(static_cast<Offset>(all.neighbors.size()));
    all.masses.push_back(graph.mass(v));
  }
  return all;
}

/// @return indptr, indices, weights, logs, transports, masses; lengths in graph units
py::tuple csr(const BodyPtr& body) {
  const TangentGraph& g = body->graph();
  CsrGraphData all = compute([body] { return rows_of(body->graph()); });
  const auto edges = static_cast<py::ssize_t>(all.neighbors.size());
  const py::ssize_t d = g.dimension();
  const Shape layout = g.transport_kind() == TransportKind::rotation2 ? Shape{edges, 2} : Shape{edges, d, d};
  return py::make_tuple(owned(std::move(all.row_begin)), owned(std::move(all.neighbors)), owned(std::move(all.weights)),
                        owned<double>(std::move(all.logs), {edges, d}),
                        owned<double>(std::move(all.transports), layout), owned(std::move(all.masses)));
}

/// Creates the triangles for exact geodesics.
void lay_out(const BodyPtr& body, const py::object& report) {
  compute(report, py::none(), [body](const Progress& progress) {
    return in_one_step(progress, "triangles", [&] { return &body->geodesics(); });
  });
}

py::object figure(const Figure& figure) {
  if (const auto* text = std::get_if<std::string_view>(&figure.value)) return py::str(std::string(*text));
  if (const auto* flag = std::get_if<bool>(&figure.value)) return py::bool_(*flag);
  if (const auto* count = std::get_if<std::int64_t>(&figure.value)) return py::int_(*count);
  return py::float_(std::get<double>(figure.value));
}

py::dict report(const Body& body) {
  py::dict result;
  if (body.surface() == nullptr) return result;
  for (const Figure& f : body.surface()->report()) result[py::str(std::string(f.id))] = figure(f);
  return result;
}

py::list warnings(const Body& body) {
  py::list result;
  if (body.surface() == nullptr) return result;
  for (const Warning& w : body.surface()->warnings()) result.append(warning(w));
  return result;
}

/// @return for the nearest point of each position: face or -1, row or -1, barycentric coordinates or None, position, distance
py::tuple closest_points(const BodyPtr& body, const Doubles& positions, const py::object& progress) {
  const auto given = vectors(positions);
  const auto found = compute(progress, positions, [body, given](const Progress& steps) {
    std::vector<ClosestPoint> all;
    for (const Vec3& p : given) {
      if (all.size() % 1024 == 0)
        steps.step("closest points", static_cast<double>(all.size()) / static_cast<double>(given.size()));
      all.push_back(body->surface_for("a position").closest_point(p));
    }
    return all;
  });
  std::vector<Index> face, row;
  std::vector<Vec3> places;
  std::vector<double> away;
  py::list weights;
  for (const ClosestPoint& point : found) {
    const auto* inside = std::get_if<FacePoint>(&point.point);
    const auto* near = std::get_if<TangentPoint>(&point.point);
    face.push_back(inside != nullptr ? inside->face : -1);
    row.push_back(near != nullptr ? near->row.index : -1);
    places.push_back(point.position);
    away.push_back(point.distance);
    weights.append(inside != nullptr ? py::object(owned(std::vector<double>(inside->barycentric))) : py::none());
  }
  return py::make_tuple(owned(std::move(face)), owned(std::move(row)), weights, owned(std::move(places)),
                        owned(std::move(away)));
}

}  // namespace

py::dict warning(const Warning& warning) {
  using namespace py::literals;
  py::list rows, values;
  for (Row row : warning.rows) rows.append(row.index);
  for (double x : warning.numbers) values.append(x);
  return py::dict("id"_a = std::string(warning.id), "numbers"_a = values, "rows"_a = rows, "name"_a = warning.name,
                  "text"_a = app::worded(warning));
}

void add_surfaces(py::module_& module) {
  py::class_<Body, std::shared_ptr<Body>>(module, "Body")
      .def_property_readonly("rows", [](const Body& b) { return b.rows(); })
      .def_property_readonly("vertices", [](const Body& b) { return b.graph().size(); })
      .def_property_readonly("dimension", [](const Body& b) { return b.graph().dimension(); })
      .def_property_readonly("edge_count", [](const Body& b) { return b.graph().edge_count(); })
      .def_property_readonly("length_unit", [](const Body& b) { return b.graph().length_unit(); })
      .def_property_readonly("mean_edge_length",
                             [](const Body& b) { return b.graph().mean_edge_length() * b.graph().length_unit(); })
      .def_property_readonly("has_surface", [](const Body& b) { return b.surface() != nullptr; })
      .def_property_readonly("has_positions",
                             [](const Body& b) { return b.surface() != nullptr || b.grid() != nullptr; })
      .def_property_readonly("is_delaunay", [](const Body& b) { return b.graph().is_delaunay(); })
      .def("positions", &positions)
      .def("faces", &faces)
      .def("normals",
           [](const BodyPtr& b) { return owned(compute([=] { return b->surface_for("normals").normals(); })); })
      .def("frames", &frames)
      .def("vertex_of_row", &vertex_of_row)
      .def("row_of_vertex", &row_of_vertex)
      .def("csr", &csr)
      .def("lay_out", &lay_out)
      .def("components",
           [](const BodyPtr& b) { return owned(compute([=] { return connected_components(b->graph()).of_vertex; })); })
      .def("report", &report)
      .def("warnings", &warnings)
      .def("closest_points", &closest_points);
  module.def("triangle_mesh", &triangle_mesh);
  module.def("polygon_mesh", &polygon_mesh);
  module.def("point_cloud", &point_cloud);
  module.def("grid", &grid);
  module.def("graph", &graph);
}

}  // namespace ahm::python
