#include "input/open.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "ahm/error.hpp"
#include "ahm/heat/heat_operators.hpp"
#include "ahm/io/read.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/surface/directions.hpp"
#include "ahm/util/vec.hpp"
#include "cli/source_list.hpp"
#include "cli/system_info.hpp"
#include "input/repair.hpp"
#include "output/wording.hpp"

namespace ahm::app {

void check_mesh_input(const std::string& backend, const io::Geometry& input, const InputOptions& options,
                      const std::optional<SourceSpec>& source) {
  if (input.face_count() == 0)
    throw InvalidArgument(fmt::format("--backend {}: the input has no faces; use --backend pointcloud", backend));
  const InputOptions defaults;
  if (options.voxel || options.outliers || options.drop_nan || options.k || options.knn != defaults.knn ||
      options.normals != defaults.normals || options.smooth)
    throw InvalidArgument(
        "--voxel, --outliers, --drop-nan, --k, --knn, --normals and --smooth require a point cloud; leave them out, or "
        "map the vertices as a cloud with --backend pointcloud");
  if (source) position_in(input, *source, "--source");
}

void check_cloud_input(const io::Geometry& input, const InputOptions& options,
                       const std::optional<SourceSpec>& source) {
  if (options.repair.any())
    throw InvalidArgument(
        "--repair, --weld, --drop-degenerate, --drop-duplicates and --orient require a mesh; leave them out (equal "
        "points of a cloud are always merged)");
  const InputOptions defaults;
  if (options.flips != defaults.flips || options.non_manifold != defaults.non_manifold ||
      options.discretization != defaults.discretization)
    throw InvalidArgument(
        "--no-flips, --non-manifold and --discretization require a mesh; leave them out, because the input is " +
        std::string(input.face_count() == 0 ? "a point cloud" : "mapped as a point cloud"));
  if (!source) return;
  if (const auto* face = std::get_if<SourceFace>(&*source))
    throw InvalidArgument(
        fmt::format("--source {}: a point cloud has no faces; write a vertex index or x,y,z", to_string(*face)));
  position_in(input, *source, "--source");
}

void check_memory(const std::string& what, double bytes, Journal& journal) {
  constexpr double at_least = 0.75;
  const double memory = machine_memory();
  if (!(memory > 0 && bytes > memory)) return;
  const std::string message_text =
      fmt::format("{} requires about {} of memory, and {} are available", what,
                  bytes_as_text(static_cast<std::int64_t>(bytes)), bytes_as_text(static_cast<std::int64_t>(memory)));
  if (at_least * bytes > memory)
    throw ResourceExhausted(
        message_text +
        "; thin the input, map only the surroundings of the source (ahm logmap --local), or use ahm-tiles");
  journal.add_warning(message_text + "; the system may stop the program");
}

const Backend& choose_backend(const io::Geometry& input, const InputOptions& options) {
  const bool as_polygons = options.backend == "auto" && options.discretization == "polygons" && input.face_count() > 0;
  const std::string requested = as_polygons ? "polymesh" : options.backend;
  const auto all = backends();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Backend& b) {
    return requested == "auto" ? b.suits(input) : b.name == requested;
  });
  if (found == all.end()) throw InvalidArgument(fmt::format("--backend {}: there is no such backend", requested));
  return *found;
}

namespace {

/// `in_remaining_faces`; the messages of errors name the option.
SourceSpec in_remaining_faces(const SourceSpec& spec, const RepairedMesh& mesh, const std::string& option) try {
  return in_remaining_faces(spec, mesh);
} catch (const InvalidArgument& e) {
  throw InvalidArgument(fmt::format("{} {}: {}", option, to_string(spec), e.what()));
}

BuiltSurface build(const Backend& backend, const io::Geometry& geometry, const std::optional<RepairedMesh>& mesh,
                   const InputOptions& options, const std::optional<SourceSpec>& place, Journal& journal) {
  return mesh ? build_repaired(backend, geometry, *mesh, options, place, journal.progress())
              : backend.build(geometry, options, place, journal.progress());
}

/// The source with its face renumbered for the faces that --local keeps.
SourceSpec in_near_faces(const SourceSpec& spec, const std::vector<Index>& near) {
  return in_kept_faces(spec, near, "this face is too far from the source; leave --local out");
}

/// Reports vertices that are too far away as `beyond` instead of `unreferenced`.
void count_beyond(std::int64_t beyond, BuiltSurface& built) {
  std::int64_t unused = 0;
  for (Figure& figure : built.report)
    if (figure.id == "unreferenced") figure.value = unused = std::get<std::int64_t>(figure.value) - beyond;
  built.report.push_back({"beyond", beyond});
  for (Warning& warning : built.warnings)
    if (warning.id == "unreferenced") warning.numbers = {static_cast<double>(unused)};
  if (unused == 0) std::erase_if(built.warnings, [](const Warning& w) { return w.id == "unreferenced"; });
}

/// Builds the surface from the faces around the source. The geometry of the result has all faces.
Input open_surroundings(io::Geometry geometry, const Backend& backend, std::optional<RepairedMesh> mesh,
                        std::size_t given_faces, const InputOptions& options, const SourceSpec& place,
                        Journal& journal) {
  position_in(geometry, place, "--source");
  Surroundings near = surroundings(geometry, *options.local, place);
  const std::vector<Offset> begin = geometry.face_begin;
  const std::vector<Index> vertices = geometry.face_vertices;
  const std::int64_t beyond = keep_faces(geometry, near.faces);
  std::optional<RepairedMesh> part = mesh;
  if (part) keep_faces(*part, near.faces);
  InputOptions of_part = options;
  of_part.counts_as_reversed = near.counts_as_reversed();
  BuiltSurface built = build(backend, geometry, part, of_part, in_near_faces(place, near.faces), journal);
  count_beyond(beyond, built);
  journal.add_warnings(built.warnings);
  geometry.face_begin = begin;
  geometry.face_vertices = vertices;
  return {std::move(geometry), &backend, std::move(built), std::move(mesh), std::move(near), given_faces};
}

}  // namespace

std::optional<Vertex> Input::vertex_standing_for(Row row) const {
  const std::optional<Vertex> own = surface().rows().vertex(row);
  const Vec3& point = geometry.points[row.index];
  if (own || !voxel || !is_finite(point)) return own;
  const Row nearest = surface().nearest_row(point);
  const bool is_near = distance(point, geometry.points[nearest.index]) <= std::sqrt(3.0) * *voxel;
  return is_near ? surface().rows().vertex(nearest) : std::nullopt;
}

io::Geometry read_input(const InputOptions& options) {
  return options.path == "-" ? io::read_standard_input(options.format) : io::read(options.path, options.format);
}

io::Geometry read_input(const InputOptions& options, Journal& journal) {
  journal.start("read");
  io::Geometry input = read_input(options);
  journal.add_warnings(input.warnings);
  if (input.points.empty()) throw InvalidGeometry(options.path + ": the file contains no points");
  return input;
}

Input open_input(io::Geometry geometry, const InputOptions& options, Journal& journal,
                 const std::optional<SourceSpec>& source) {
  journal.start("graph");
  const std::size_t given_faces = geometry.face_count();
  std::optional<RepairedMesh> mesh = repair(geometry, options);
  const std::optional<SourceSpec> place =
      mesh && source ? std::optional(in_remaining_faces(*source, *mesh, "--source")) : source;
  const Backend& backend = choose_backend(geometry, options);
  if (!options.local && !options.voxel)
    check_memory("the graph", backend.cost.bytes * static_cast<double>(geometry.points.size()), journal);
  if (options.local && place && geometry.face_count() > 0 && backend.uses_faces)
    return open_surroundings(std::move(geometry), backend, std::move(mesh), given_faces, options, *place, journal);
  BuiltSurface built = build(backend, geometry, mesh, options, place, journal);
  if (options.all_components)
    std::erase_if(built.warnings, [](const Warning& w) { return w.id == "components" || w.id == "cloud_components"; });
  journal.add_warnings(built.warnings);
  return {std::move(geometry), &backend, std::move(built), std::move(mesh), std::nullopt, given_faces, options.voxel};
}

Input open_input(const InputOptions& options, Journal& journal, const std::optional<SourceSpec>& source) {
  return open_input(read_input(options, journal), options, journal, source);
}

std::vector<double> column_of(const io::Geometry& geometry, const std::string& name, const std::string& option) {
  if (auto values = io::column(geometry, name)) return *std::move(values);
  throw InvalidArgument(fmt::format("{} {}: the input has no such column; it has {}", option, name,
                                    fmt::join(io::column_names(geometry), ", ")));
}

InputOptions with_named_points(InputOptions options, const std::vector<SourceSpec>& points) {
  options.named.insert(options.named.end(), points.begin(), points.end());
  return options;
}

InputOptions around_source(const InputOptions& options, std::optional<double> radius) {
  InputOptions result = options;
  if (!options.around_source) return result;
  if (!radius || !std::isfinite(*radius)) throw InvalidArgument("--local needs --radius");
  if (!(*radius > 0)) throw InvalidArgument("--local: the radius is 0, there is nothing to map; leave it out");
  result.local = radius;
  return result;
}

Input open_around(const InputOptions& options, std::optional<double> radius, Journal& journal,
                  const SourceSpec& source) {
  return open_input(around_source(options, radius), journal, source);
}

SurfacePoint point_of(const Input& input, const SourceSpec& given) {
  SourceSpec spec = input.repaired ? in_remaining_faces(given, *input.repaired) : given;
  if (input.near) spec = in_near_faces(spec, input.near->faces);
  if (const auto* face = std::get_if<SourceFace>(&spec)) return FacePoint{face->face, face->weights};
  if (const auto* position = std::get_if<SourcePosition>(&spec)) return input.surface().nearest_row(position->position);
  return Row(std::get<SourceVertex>(spec).index);
}

SurfaceSource place(const Input& input, const SourceSpec& spec, const std::optional<Vec3>& u_axis,
                    const std::string& option) try {
  return input.surface().source(point_of(input, spec), u_axis);
} catch (const InvalidArgument& e) {
  if (u_axis && e.fault() == "axis_along_normal")
    throw InvalidArgument(fmt::format("--u-axis {},{},{}: at the source {} {}", (*u_axis)[0], (*u_axis)[1],
                                      (*u_axis)[2], to_string(spec), e.problem()));
  throw InvalidArgument(fmt::format("{} {}: {}", option, to_string(spec), worded(e)));
}

SurfaceSource resolve(const SourceOptions& options, const Input& input, unsigned threads) {
  const std::optional<UAxis>& axis = options.u_axis;
  SurfaceSource source =
      place(input, options.spec, axis && !axis->curvature ? std::optional(axis->direction) : std::nullopt);
  if (!axis || !axis->curvature) return source;
  // For a source in a face: at the corner with the largest weight.
  const auto weights = source.source.weights();
  const auto most = std::max_element(weights.begin(), weights.end()) - weights.begin();
  Vec3 direction;
  try {
    direction = bending_direction(input.graph(), source.source.vertices()[most], threads);
  } catch (const InvalidArgument& e) {
    throw InvalidArgument(fmt::format("--u-axis curvature: {}", worded(e)));
  }
  return place(input, options.spec, direction);
}

Vec3 position_of(const Input& input, const SourceSpec& spec, const std::string& option) {
  return position_in(input.geometry, input.repaired ? in_remaining_faces(spec, *input.repaired, option) : spec, option);
}

Vertex vertex_at(const Input& input, const SourceSpec& spec, const std::string& option) {
  position_of(input, spec, option);
  if (std::holds_alternative<SourceFace>(spec))
    throw InvalidArgument(fmt::format("{} {}: points in faces are not supported here; write a vertex index or x,y,z",
                                      option, to_string(spec)));
  return place(input, spec, std::nullopt, option).source.vertices().front();
}

std::vector<Vertex> vertices_at(const Input& input, const std::vector<SourceSpec>& specs, const std::string& option) {
  std::vector<Vertex> result;
  for (const SourceSpec& spec : specs) result.push_back(vertex_at(input, spec, option));
  return result;
}

void comment_on_positions(const Input& input, std::span<const SourceSpec> specs, const std::string& option,
                          Journal& journal) {
  constexpr double far = 10, outside = 0.01;  // mean edge lengths
  const double edge = input.mean_edge_length();
  const SourcePosition* farthest = nullptr;
  double away = far * edge;
  Index count = 0;
  for (const SourceSpec& spec : specs) {
    if (std::holds_alternative<SourceFace>(spec)) {
      const Vec3 wanted = position_of(input, spec, option), found = place(input, spec, std::nullopt, option).position;
      if (const double off = distance(wanted, found); off > outside * edge)
        journal.add_warning(fmt::format(
            "{} {}: outside of its face; the nearest point of the face is used, {:.4g} away, at {:.6g} {:.6g} "
            "{:.6g}",
            option, to_string(spec), off, found[0], found[1], found[2]));
    }
    const auto* position = std::get_if<SourcePosition>(&spec);
    if (position == nullptr) continue;
    const double off = input.surface().closest_point(position->position).distance;
    count += off > far * edge;
    if (off > away) away = off, farthest = position;
  }
  if (farthest == nullptr) return;
  const bool may_be_rows =
      std::ranges::all_of(farthest->position, [](double x) { return x >= 0 && x == std::floor(x); });
  journal.add_warning(
      fmt::format("{} {}: {:.4g} ({:.3g} mean edge lengths) off the surface{}; the nearest point is used{}", option,
                  to_string(*farthest), away, away / edge,
                  count > 1 ? fmt::format(", other positions that are too far: {}", count - 1) : "",
                  may_be_rows ? "; if these are rows, separate them by blanks" : ""));
}

}  // namespace ahm::app
