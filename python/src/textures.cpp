// Inverse maps, decals, tool paths and atlases.
#include <unordered_set>
#include <utility>

#include "ahm/applications/atlas.hpp"
#include "ahm/applications/cells.hpp"
#include "ahm/applications/coverage.hpp"
#include "ahm/applications/decal.hpp"
#include "ahm/error.hpp"
#include "ahm/surface/surface_triangles.hpp"
#include "compute.hpp"
#include "map.hpp"
#include "options.hpp"
#include "parts.hpp"

namespace ahm::python {
namespace {

using InversePtr = std::shared_ptr<InverseMap>;

InversePtr inverse(const MapPtr& map, const py::dict& options) {
  InverseMapOptions o;
  read(options, "max_stretch", o.max_stretch);
  read(options, "min_quality", o.min_quality);
  return compute(py::none(), py::none(), [=](const Progress&) {
    if (map->map.frames().empty()) throw InvalidArgument("the map was made without frames; make it with frames=True");
    return std::make_shared<InverseMap>(inverse_map(map->surface(), map->map, o));
  });
}

py::array triangles(const InversePtr& map) {
  return viewed<Index>(map->triangles(), {length(map->triangles()), 3}, map);
}

/// The points of the surface at n coordinates; NaN and -1 where there is none.
struct Found {
  explicit Found(std::size_t n)
      : position(n, none), normal(n, none), du(n, none), dv(n, none), weights(n, none), rows(n, Triangle{-1, -1, -1}) {}

  static constexpr Vec3 none{nan, nan, nan};
  std::vector<Vec3> position, normal, du, dv, weights;
  std::vector<Triangle> rows;
};

/// @return for each (u, v): position, normal, du, dv, rows of the triangle, barycentric weights
py::tuple at(const InversePtr& map, const Doubles& uv) {
  const std::span<const double> given = numbers(uv);
  Found found = compute(py::none(), uv, [map, given](const Progress& progress) {
    Found all(given.size() / 2);
    for (std::size_t k = 0; 2 * k < given.size(); ++k) {
      if (k % 1024 == 0) progress.step("inverse", 0);
      const auto point = map->at(given[2 * k], given[2 * k + 1]);
      if (!point) continue;
      all.position[k] = point->position, all.normal[k] = point->normal, all.du[k] = point->du, all.dv[k] = point->dv;
      all.rows[k] = point->vertices, all.weights[k] = point->weights;
    }
    return all;
  });
  return py::make_tuple(owned(std::move(found.position)), owned(std::move(found.normal)), owned(std::move(found.du)),
                        owned(std::move(found.dv)), owned<Triangle, Index>(std::move(found.rows), {uv.shape(0), 3}),
                        owned(std::move(found.weights)));
}

DecalOptions decal_options(const py::dict& options) {
  DecalOptions o;
  read(options, "width", o.width);
  read(options, "height", o.height);
  read(options, "angle", o.angle);
  read(options, "mirrored", o.mirrored);
  read(options, "radius", o.radius);
  read(options, "lift", o.lift);
  return o;
}

/// @return points, normals, face_begin, face_vertices, image coordinates, number of hidden triangles
py::tuple decal(const InversePtr& map, const py::dict& options) {
  const DecalOptions o = decal_options(options);
  Decal made = compute(py::none(), py::none(), [=](const Progress&) { return make_decal(*map, o); });
  const py::ssize_t n = length(made.points);
  return py::make_tuple(owned(std::move(made.points)), owned(std::move(made.normals)),
                        owned(std::move(made.face_begin)), owned(std::move(made.face_vertices)),
                        owned<double>(std::move(made.image_coordinates), {n, 2}), made.hidden);
}

py::array image_coordinates(const InversePtr& map, const py::dict& options) {
  const DecalOptions o = decal_options(options);
  const auto n = static_cast<py::ssize_t>(map->positions().size());
  return owned<double>(
      compute(py::none(), py::none(), [=](const Progress&) { return image_coordinates_of_vertices(*map, o); }), {n, 2});
}

/// @param of  the map whose inverse `map` is
/// @return per point: position, normal, heading, (u, v), piece, line, arclength, spacing, between; then the numbers of pieces
/// and of planned points
py::tuple coverage(const InversePtr& map, const MapPtr& of, const py::dict& options) {
  CoverageOptions o;
  read(options, "radius", o.radius);
  read(options, "spacing", o.spacing);
  read(options, "step", o.step);
  read(options, "angle", o.angle);
  read_choice(options, "pattern", o.pattern,
              {{"raster", CoveragePattern::raster}, {"spiral", CoveragePattern::spiral}});
  const CoveragePath path =
      compute(py::none(), py::none(), [=](const Progress&) { return coverage_path(of->surface(), *map, o); });
  std::vector<Vec3> position, normal, heading;
  std::vector<Vec2> uv;
  std::vector<Index> piece, line;
  std::vector<double> arclength, spacing;
  py::array_t<bool> between(length(path.points));
  bool* is_between = between.mutable_data();
  for (const CoveragePoint& p : path.points) {
    *is_between++ = p.between;
    position.push_back(p.position), normal.push_back(p.normal), heading.push_back(p.heading);
    uv.push_back(p.coordinates), piece.push_back(p.piece), line.push_back(p.line);
    arclength.push_back(p.arclength), spacing.push_back(p.spacing);
  }
  const py::ssize_t n = length(uv);
  return py::make_tuple(owned(std::move(position)), owned(std::move(normal)), owned(std::move(heading)),
                        owned<Vec2, double>(std::move(uv), {n, 2}), owned(std::move(piece)), owned(std::move(line)),
                        owned(std::move(arclength)), owned(std::move(spacing)), between, path.pieces, path.planned);
}

struct AtlasAndFaces {
  Atlas atlas;
  SurfaceFaces faces;
  AtlasDistortion distortion;
  TextureAtlas packed;
};

AtlasAndFaces make(const Maker& by, const std::vector<Vertex>& sources, const RefineOptions* refine,
                   const PackOptions& pack_options) {
  const Body& body = *by.body();
  const Surface& surface = body.surface_for("an atlas");
  const AnySolver maps = by.maps();
  AtlasAndFaces result;
  result.faces = by.solver() != nullptr  ? surface_faces(surface, by.solver()->solver, sources)
                 : by.polar() != nullptr ? surface_faces(surface, by.polar()->solver, sources)
                                         : surface_faces(surface);
  const SurfaceFaces& faces = result.faces;
  std::vector<Vec3> positions(static_cast<std::size_t>(body.graph().size()));
  for (std::size_t c = 0; c < faces.corner_vertices.size(); ++c)
    positions[faces.corner_vertices[c]] = faces.points[faces.corner_points[c]];
  const FaceList list = faces.of_vertices();
  result.atlas =
      refine != nullptr ? make_atlas(maps, sources, list, positions, *refine) : make_atlas(maps, sources, list);
  result.distortion = distortion(result.atlas, list, positions);
  result.packed = pack(result.atlas, list, pack_options);
  return result;
}

/// The source vertices of charts. @throws InvalidArgument (two charts with the same source)
std::vector<Vertex> charted(const Body& body, const Places& at) {
  std::vector<Vertex> vertices = body.vertices_near(at);
  std::unordered_set<Index> seen;
  for (std::size_t k = 0; k < vertices.size(); ++k)
    if (!seen.insert(vertices[k].index).second)
      throw InvalidArgument(at.where(k) + ": another chart already starts at this row");
  return vertices;
}

py::tuple atlas(const py::object& maker, const py::object& sources, Index charts, const py::dict& options,
                const py::object& report) {
  std::optional<Places> at;
  if (!sources.is_none()) at = places(sources.cast<py::tuple>());
  RefineOptions refine;
  const bool refined = read(options, "max_distortion", refine.max_distortion);
  PackOptions pack_options;
  read(options, "size", pack_options.size);
  read(options, "margin", pack_options.margin);
  const Maker by(maker);
  AtlasAndFaces made = compute(report, py::none(), [=](const Progress& progress) {
    const TangentGraph& graph = by.body()->graph();
    const std::vector<Vertex> among = by.body()->vertices_with_rows();
    const std::vector<Vertex> from =
        at ? charted(*by.body(), *at)
           : farthest_points(graph, by.body()->first(),
                             std::min(charts, among.empty() ? graph.size() : static_cast<Index>(among.size())),
                             progress, among);
    return in_one_step(progress, "charts", [&] { return make(by, from, refined ? &refine : nullptr, pack_options); });
  });
  using namespace py::literals;
  std::vector<Index> rows;
  for (const Chart& chart : made.atlas.charts) {
    const auto row = by.body()->row(made.atlas.sources[chart.source]);
    rows.push_back(row ? row->index : -1);
  }
  const auto corners = static_cast<py::ssize_t>(made.atlas.coordinates.size() / 2);
  const DistortionSummary& d = made.distortion.all;
  return py::make_tuple(
      owned(std::move(made.faces.points)), owned(std::move(made.faces.begin)),
      owned(std::move(made.faces.corner_points)), owned(std::move(made.atlas.chart_of_face)),
      owned<double>(std::move(made.atlas.coordinates), {corners, 2}),
      owned<double>(std::move(made.packed.coordinates), {corners, 2}), owned(std::move(rows)),
      py::dict("mean"_a = d.mean, "median"_a = d.median, "percentile_95"_a = d.percentile_95, "largest"_a = d.largest,
               "collapsed_area"_a = d.collapsed_area, "flipped"_a = d.flipped, "flipped_area"_a = d.flipped_area));
}

}  // namespace

void add_textures(py::module_& module) {
  py::class_<InverseMap, InversePtr>(module, "Inverse")
      .def(py::init(&inverse))
      .def("triangles", &triangles)
      .def("at", &at)
      .def("decal", &decal)
      .def("image_coordinates", &image_coordinates)
      .def("coverage", &coverage);
  module.def("atlas", &atlas);
}

}  // namespace ahm::python
