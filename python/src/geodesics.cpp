// Exact distances, shortest paths and straightest geodesics: over the flat triangles of meshes, or the tangent planes of clouds.
#include <array>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/surface/surface_paths.hpp"
#include "body.hpp"
#include "compute.hpp"
#include "errors.hpp"
#include "parts.hpp"

namespace ahm::python {
namespace {

/// The points of the surface. @throws InvalidArgument (a point that is not on the triangles)
std::vector<SurfacePoint> points_of(const Body& body, const Places& at) {
  std::vector<SurfacePoint> result;
  for (std::size_t k = 0; k < at.size(); ++k)
    naming(at.where(k), [&] {
      result.push_back(body.point(at.places[k]));
      body.geodesics().point(result.back());
    });
  return result;
}

std::vector<exact::MeshPoint> mesh_points(const Body& body, const Places& at) {
  std::vector<exact::MeshPoint> result;
  for (const SurfacePoint& point : points_of(body, at)) result.push_back(body.geodesics().point(point));
  return result;
}

/// Distances and nearest sources of targets, or of all rows.
struct Distances {
  std::vector<double> distance;  ///< world units; NaN where there is none
  std::vector<Index> source;     ///< number of the nearest source; -1: none

  void add(Status status, double value, Index nearest) {
    distance.push_back(status == Status::ok ? value : nan);
    source.push_back(status == Status::ok ? nearest : -1);
  }
};

/// Exact distances of targets, or of all rows without targets. The lengths of `exact::ExactMap` are in units of the triangles.
Distances exact_distances(const Body& body, const Places& from, const std::optional<Places>& to, double radius,
                          const Progress& progress) {
  const exact::PolyhedralSurface& flat = body.geodesics().triangles().surface;
  const double unit = body.geodesics().triangles().length_unit;
  exact::ExactOptions options{
      .radius = radius / unit, .targets = {}, .only_targets = to.has_value(), .progress = progress};
  if (to) options.targets = mesh_points(body, *to);
  const exact::ExactMap map = exact::exact_map(flat, mesh_points(body, from), options);
  Distances result;
  if (to) {
    for (std::size_t k = 0; k < to->size(); ++k) {
      const Index origin = map.target_arrival(k).origin;
      result.add(map.target_status(k), unit * map.target_distance(k),
                 origin < 0 ? -1 : map.origins()[static_cast<std::size_t>(origin)].source);
    }
    return result;
  }
  const RowMap& rows = body.surface()->rows();
  for (Index r = 0; r < rows.row_count(); ++r) {
    const auto vertex = rows.least(Row(r), [&](Vertex v) { return map.distance(v); });
    vertex ? result.add(map.status(*vertex), unit * map.distance(*vertex), map.source(*vertex))
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

/// A path for Python: points in space and in the faces of the input. Python gets None if there is no path.
struct Curve {
  bool ok = true;  ///< whether there is a path
  std::vector<Vec3> points;
  std::vector<Index> faces;          ///< face of the input of each point
  std::vector<double> weights;       ///< barycentric coordinates of all points, one point after the other
  std::vector<py::ssize_t> corners;  ///< number of barycentric coordinates of each point
  double length = 0;
  bool complete = true;

  Curve(const Body& body, const exact::GeodesicPath& path) : Curve(body, path.points, path.length) {
    ok = path.status == Status::ok;
  }
  Curve(const Body& body, std::span<const exact::MeshPoint> on, double long_) : length(long_) {
    for (const exact::MeshPoint& point : on) {
      const FacePoint inside = body.input_faces().point(point);
      points.push_back(body.geodesics().position(point));
      faces.push_back(inside.face);
      weights.insert(weights.end(), inside.barycentric.begin(), inside.barycentric.end());
      corners.push_back(length_of(inside));
    }
  }

 private:
  static py::ssize_t length_of(const FacePoint& point) { return python::length(point.barycentric); }
};

/// Barycentric coordinates: a (k, 3) array if all faces are triangles, otherwise a list of arrays.
py::object weights_of(const Body& body, Curve& curve) {
  const FaceList faces = body.surface()->faces();
  if (faces.vertices.size() == 3 * faces.size()) {
    const py::ssize_t k = length(curve.corners);
    return owned<double>(std::move(curve.weights), {k, 3});
  }
  py::list result;
  auto at = curve.weights.begin();
  for (py::ssize_t count : curve.corners) {
    result.append(owned(std::vector<double>(at, at + count)));
    at += count;
  }
  return result;
}

py::object arrays(const Body& body, Curve&& curve) {
  if (!curve.ok) return py::none();
  const py::object weights = weights_of(body, curve);
  return py::make_tuple(owned(std::move(curve.points)), owned(std::move(curve.faces)), weights, curve.length,
                        curve.complete);
}

/// Whether the surface has no faces, so that paths run over tangent planes.
bool has_planes_alone(const Body& body) { return body.surface() != nullptr && body.surface()->faces().size() == 0; }

py::object arrays(SurfacePath&& line) {
  if (line.status != Status::ok) return py::none();
  return py::make_tuple(owned(std::move(line.points)), py::none(), py::none(), line.length, line.complete);
}

std::vector<SurfacePoint> plane_points(const Body& body, const Places& at) {
  std::vector<SurfacePoint> result;
  for (std::size_t k = 0; k < at.size(); ++k) naming(at.where(k), [&] { result.push_back(body.point(at.places[k])); });
  return result;
}

/// Rejects an option that requires faces. @throws InvalidArgument if `given`
void refuse(bool given, const std::string& name) {
  if (given) throw InvalidArgument(name + ": requires faces, which a cloud does not have");
}

/// The path from stop to stop over tangent planes.
py::object plane_path(const BodyPtr& body, const Places& at, bool closed, const py::object& report) {
  return arrays(compute(report, py::none(), [=](const Progress& progress) {
    std::vector<SurfacePoint> stops = plane_points(*body, at);
    if (stops.size() < 2)
      throw InvalidArgument(at.name + ": " + std::to_string(stops.size()) + " point; a path needs at least 2");
    if (closed) stops.push_back(stops.front());
    SurfacePath whole;
    for (std::size_t k = 1; k < stops.size(); ++k) {
      progress.step("paths", static_cast<double>(k - 1) / static_cast<double>(stops.size() - 1));
      SurfacePath leg = shortest_line(*body->surface(), stops[k - 1], stops[k]);
      if (leg.status != Status::ok) return leg;
      whole.points.insert(whole.points.end(), leg.points.begin() + (k > 1 ? 1 : 0), leg.points.end());
      whole.length += leg.length;
    }
    return whole;
  }));
}

/// Paths from source k to target k over tangent planes.
py::list plane_paths(const BodyPtr& body, const Places& from, const Places& to, const py::object& report) {
  std::vector<SurfacePath> found = compute(report, py::none(), [=](const Progress& progress) {
    const std::vector<SurfacePoint> starts = plane_points(*body, from), ends = plane_points(*body, to);
    std::vector<SurfacePath> all;
    for (std::size_t k = 0; k < starts.size(); ++k) {
      progress.step("paths", static_cast<double>(k) / static_cast<double>(starts.size()));
      all.push_back(shortest_line(*body->surface(), starts[k], ends[k]));
    }
    return all;
  });
  py::list result;
  for (SurfacePath& line : found) result.append(arrays(std::move(line)));
  return result;
}

/// The path from stop to stop. If a leg does not exist, returns its status and no points.
/// @param fast  uses locally shortest paths
exact::GeodesicPath through(const ExactGeodesics& geodesics, const std::vector<SurfacePoint>& stops, bool fast,
                            const Progress& progress) {
  exact::GeodesicPath whole;
  for (std::size_t k = 1; k < stops.size(); ++k) {
    progress.step("paths", static_cast<double>(k - 1) / static_cast<double>(stops.size() - 1));
    const std::array ends{stops[k - 1], stops[k]};
    exact::GeodesicPath leg = fast ? geodesics.locally_shortest_path(ends[0], ends[1]) : geodesics.path(ends);
    if (leg.status != Status::ok) return leg;
    whole.points.insert(whole.points.end(), leg.points.begin() + (k > 1 ? 1 : 0), leg.points.end());
    whole.length += leg.length;
  }
  return whole;
}

/// @param taut  pulls the path taut: only its ends are fixed, and no point of a closed path is
py::object path(const BodyPtr& body, const py::tuple& stops, bool closed, bool fast, bool taut,
                const py::object& report) {
  const Places at = places(stops);
  if (has_planes_alone(*body)) {
    refuse(fast, "fast");
    refuse(taut, "taut");
    return plane_path(body, at, closed, report);
  }
  return arrays(*body, compute(report, py::none(), [=](const Progress& progress) {
    const ExactGeodesics& geodesics = body->geodesics();
    std::vector<SurfacePoint> points = points_of(*body, at);
    if (points.size() < 2)
      throw InvalidArgument(at.name + ": " + std::to_string(points.size()) + " point; a path needs at least 2");
    if (closed) points.push_back(points.front());
    exact::GeodesicPath found = through(geodesics, points, fast, progress);
    if (taut && found.points.size() > 1) found = geodesics.shortened(found.points, closed);  // a single point is taut
    return Curve(*body, found);
  }));
}

py::list listed(const Body& body, std::vector<Curve>&& curves) {
  py::list result;
  for (Curve& curve : curves) result.append(arrays(body, std::move(curve)));
  return result;
}

/// The path to each target from the nearest source, by one propagation.
py::list paths(const BodyPtr& body, const py::tuple& sources, const py::tuple& targets, const py::object& report) {
  const Places from = places(sources), to = places(targets);
  if (has_planes_alone(*body))
    throw InvalidArgument("pairwise: on a cloud, paths are computed per pair; use pairwise=True");
  return listed(*body, compute(report, py::none(), [=](const Progress& progress) {
    const exact::PolyhedralSurface& flat = body->geodesics().triangles().surface;
    const double unit = body->geodesics().triangles().length_unit;
    const exact::ExactMap map =
        exact::exact_map(flat, mesh_points(*body, from),
                         {.targets = mesh_points(*body, to), .only_targets = true, .progress = progress});
    std::vector<Curve> all;
    for (std::size_t k = 0; k < to.size(); ++k) {
      exact::GeodesicPath one = exact::path_to_target(flat, map, k);
      one.length *= unit;
      all.emplace_back(*body, one);
    }
    return all;
  }));
}

/// Paths from source k to target k.
py::list paired_paths(const BodyPtr& body, const py::tuple& sources, const py::tuple& targets, bool fast,
                      const py::object& report) {
  const Places from = places(sources), to = places(targets);
  if (has_planes_alone(*body)) {
    refuse(fast, "fast");
    return plane_paths(body, from, to, report);
  }
  return listed(*body, compute(report, py::none(), [=](const Progress& progress) {
    const ExactGeodesics& geodesics = body->geodesics();
    const std::vector<SurfacePoint> starts = points_of(*body, from), ends = points_of(*body, to);
    std::vector<std::array<SurfacePoint, 2>> pairs;
    for (std::size_t k = 0; k < starts.size(); ++k) pairs.push_back({starts[k], ends[k]});
    std::vector<Curve> all;
    if (!fast) {
      for (const exact::GeodesicPath& one : geodesics.paths(pairs, progress)) all.emplace_back(*body, one);
      return all;
    }
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      progress.step("paths", static_cast<double>(k) / static_cast<double>(pairs.size()));
      all.emplace_back(*body, geodesics.locally_shortest_path(pairs[k][0], pairs[k][1]));
    }
    return all;
  }));
}

py::object trace(const BodyPtr& body, const py::tuple& start, const Doubles& direction, double long_,
                 const py::object& report) {
  const Places at = places(start);
  const Vec3 along{direction.at(0), direction.at(1), direction.at(2)};
  if (has_planes_alone(*body))
    return arrays(compute(report, py::none(), [=](const Progress& progress) {
      return in_one_step(progress, "trace",
                         [&] { return trace_line(*body->surface(), plane_points(*body, at)[0], along, long_); });
    }));
  return arrays(*body, compute(report, py::none(), [=](const Progress& progress) {
    const exact::TracedPath found =
        in_one_step(progress, "trace", [&] { return body->geodesics().trace(points_of(*body, at)[0], along, long_); });
    Curve curve(*body, found.points, found.length);
    curve.complete = found.end == exact::TraceEnd::complete;
    return curve;
  }));
}

}  // namespace

void add_geodesics(py::module_& module) {
  module.def("exact_distance", &exact_distance);
  module.def("path", &path);
  module.def("paths", &paths);
  module.def("paired_paths", &paired_paths);
  module.def("trace", &trace);
}

}  // namespace ahm::python
