// Exact distances, shortest paths and straightest geodesics over the flat triangles of meshes.
#include <limits>
#include <utility>

#include "ahm/error.hpp"
#include "body.hpp"
#include "compute.hpp"
#include "errors.hpp"
#include "parts.hpp"

namespace ahm::python {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<SurfacePoint> points_of(const Body& body, const Places& at) {
  std::vector<SurfacePoint> result;
  for (std::size_t k = 0; k < at.size(); ++k)
    result.push_back(naming(at.where(k), [&] { return body.point(at.places[k]); }));
  return result;
}

std::vector<exact::MeshPoint> mesh_points(const Body& body, const Places& at) {
  const ExactGeodesics& geodesics = body.geodesics();
  std::vector<exact::MeshPoint> result;
  const std::vector<SurfacePoint> points = points_of(body, at);
  for (std::size_t k = 0; k < at.size(); ++k)
    result.push_back(naming(at.where(k), [&] { return geodesics.point(points[k]); }));
  return result;
}

/// Distances and numbers of the nearest sources (-1: none), of targets or of all rows.
struct Distances {
  std::vector<double> distance;
  std::vector<Index> source;

  void add(Status status, double value, Index nearest) {
    distance.push_back(status == Status::ok ? value : nan);
    source.push_back(status == Status::ok ? nearest : -1);
  }
};

Distances exact_distances(const Body& body, const Places& from, const std::optional<Places>& to, double radius,
                          const Progress& progress) {
  const exact::PolyhedralSurface& flat = body.geodesics().triangles().surface;
  exact::ExactOptions options{.radius = radius, .targets = {}, .only_targets = to.has_value(), .progress = progress};
  if (to) options.targets = mesh_points(body, *to);
  const exact::ExactMap map = exact::exact_map(flat, mesh_points(body, from), options);
  Distances result;
  if (to) {
    for (std::size_t k = 0; k < to->size(); ++k) {
      const Index origin = map.target_arrival(k).origin;
      result.add(map.target_status(k), map.target_distance(k), origin < 0 ? -1 : map.origins()[origin].source);
    }
    return result;
  }
  const RowMap& rows = body.surface()->rows();
  for (Index r = 0; r < rows.row_count(); ++r) {
    const auto vertex = rows.least(Row(r), [&](Vertex v) { return map.distance(v); });
    vertex ? result.add(map.status(*vertex), map.distance(*vertex), map.source(*vertex))
           : result.add(Status::removed, nan, -1);
  }
  return result;
}

py::tuple exact_distance(const BodyPtr& body, const py::tuple& sources, const py::object& targets, double radius,
                         const py::object& report) {
  const Places from = places(sources);
  std::optional<Places> to;
  if (!targets.is_none()) to = places(targets.cast<py::tuple>());
  Distances found = compute(
      report, py::none(), [=](const Progress& progress) { return exact_distances(*body, from, to, radius, progress); });
  return py::make_tuple(owned(std::move(found.distance)), owned(std::move(found.source)));
}

/// A curve as Python gets it: points in space, face and weights of each, length; None where there is no way.
struct Curve {
  bool ok = true;
  std::vector<Vec3> points;
  std::vector<Index> faces;
  std::vector<Vec3> weights;
  double length = 0;
  bool complete = true;

  Curve(const ExactGeodesics& geodesics, bool found, std::span<const exact::MeshPoint> on, double long_)
      : ok(found), length(long_) {
    for (const exact::MeshPoint& point : on) {
      points.push_back(geodesics.position(point));
      faces.push_back(point.face);
      weights.push_back(point.barycentric);
    }
  }
};

py::object arrays(Curve&& curve) {
  if (!curve.ok) return py::none();
  return py::make_tuple(owned(std::move(curve.points)), owned(std::move(curve.faces)), owned(std::move(curve.weights)),
                        curve.length, curve.complete);
}

py::object path(const BodyPtr& body, const py::tuple& stops, bool closed, const py::object& report) {
  const Places at = places(stops);
  return arrays(compute(report, py::none(), [=](const Progress&) {
    const exact::GeodesicPath found = body->geodesics().path(points_of(*body, at), closed);
    return Curve(body->geodesics(), found.status == Status::ok, found.points, found.length);
  }));
}

/// One path to each target, of one propagation.
py::list paths(const BodyPtr& body, const py::tuple& sources, const py::tuple& targets, const py::object& report) {
  const Places from = places(sources), to = places(targets);
  auto found = compute(report, py::none(), [=](const Progress& progress) {
    const ExactGeodesics& geodesics = body->geodesics();
    const exact::PolyhedralSurface& flat = geodesics.triangles().surface;
    const exact::ExactMap map =
        exact::exact_map(flat, mesh_points(*body, from),
                         {.targets = mesh_points(*body, to), .only_targets = true, .progress = progress});
    std::vector<Curve> all;
    for (std::size_t k = 0; k < to.size(); ++k) {
      const exact::GeodesicPath one = exact::path_to_target(flat, map, k);
      all.emplace_back(geodesics, one.status == Status::ok, one.points, one.length);
    }
    return all;
  });
  py::list result;
  for (Curve& curve : found) result.append(arrays(std::move(curve)));
  return result;
}

py::object trace(const BodyPtr& body, const py::tuple& start, const Doubles& direction, double long_,
                 const py::object& report) {
  const Places at = places(start);
  const Vec3 along{direction.at(0), direction.at(1), direction.at(2)};
  return arrays(compute(report, py::none(), [=](const Progress&) {
    const exact::TracedPath found = body->geodesics().trace(points_of(*body, at)[0], along, long_);
    Curve curve(body->geodesics(), true, found.points, found.length);
    curve.complete = found.end == exact::TraceEnd::complete;
    return curve;
  }));
}

}  // namespace

void add_geodesics(py::module_& module) {
  module.def("exact_distance", &exact_distance);
  module.def("path", &path);
  module.def("paths", &paths);
  module.def("trace", &trace);
}

}  // namespace ahm::python
