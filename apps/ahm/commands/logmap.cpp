#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/util/vec.hpp"
#include "cli/numbers.hpp"
#include "cli/option_adders.hpp"
#include "commands/estimate.hpp"
#include "commands/logmap_report.hpp"
#include "commands/solve.hpp"
#include "commands/subcommand.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"
#include "output/texture_output.hpp"

namespace ahm::app {
namespace {

constexpr const char* logmap_footer =
    "SPEC is one of\n"
    "  123              a vertex of INPUT, counted from 0\n"
    "  1.5,0,-2         the vertex nearest to this position\n"
    "  face:7:.2,.3,.5  a point in face 7, by barycentric coordinates, one per corner (meshes)\n"
    "\n"
    "OUTPUT  .csv, .ply or .pcd; one row per vertex of INPUT, in its order:\n"
    "          index,x,y,z,u,v,distance,angle,status,quality,spread, with --order 2 also error_estimate,\n"
    "          with --gradient also gx,gy,gz: unit vector in space, away from the source along the surface\n"
    "        u,v        the log map of heat: where heat comes along several ways they cancel, and behind a hole\n"
    "                   it is the straight line\n"
    "        distance   along the surface; on meshes round holes too, not |(u, v)|\n"
    "        quality    in (0, 1]; below 0.5 do not trust u,v: a cut locus, a shadow, or too coarse\n"
    "        spread     standard deviation of (u, v) over the ways by which heat came\n"
    "        The numbers are nan where status is not ok:\n"
    "          disconnected  from the source                beyond_radius  farther than --radius\n"
    "          unreached     too far for double precision  removed        dropped, replaced, or in no face\n"
    "CORNERS .obj (with .mtl): the faces of INPUT with the u,v of every corner as texture coordinates; where the mesh\n"
    "        is cut a vertex has several, of which OUTPUT has the nearest. Faces without are the object 'rest'\n"
    "\n"
    "Examples:\n"
    "  ahm logmap scan.ply --source 0 -o map.csv\n"
    "  ahm logmap scan.pcd --source 0.1,0.2,1.4 --drop-nan --voxel 0.01 --outliers -o map.ply --view map.html\n"
    "  ahm logmap mesh.obj --source face:7:.2,.3,.5 --u-axis 1,0,0 -o map.ply\n"
    "  ahm logmap scan.xyz --source 17 -o map.csv --json - | jq .status";

struct LogmapOptions {
  InputOptions input;
  SourceOptions source;
  SolveOptions solve;
  OutputOptions output;
  bool gradient = false;  ///< columns with the direction away from the source
  std::string corners;    ///< file for the faces with u, v at every corner
  bool local = false;     ///< build the graph of a cloud around the source only
  bool estimate = false;  ///< tell what the run would cost instead of running
};

/// Something the user should know about where the source ended up.
void comment_on_source(const SourceSpec& spec, const Input& input, const PlacedSource& source, Journal& journal) {
  const auto* wanted = std::get_if<SourcePosition>(&spec);
  if (wanted == nullptr) return;
  const double away = distance(wanted->position, source.position), edge = input.mean_edge_length();
  if (away > 10 * edge)
    journal.add_warning(
        fmt::format("the vertex nearest to {} is {:.4g} away, at {:.6g} {:.6g} {:.6g}: {:.0f} mean edge lengths",
                    to_string(*wanted), away, source.position[0], source.position[1], source.position[2], away / edge));
}

/// What was left out because it is farther than the radius in a straight line already.
void mark_beyond(const std::vector<Vec3>& points, const Vec3& source, double radius, RowLogMap& rows) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (rows.status[i] == Status::removed && distance(points[i], source) > radius)
      rows.status[i] = Status::beyond_radius;
}

double radius_of_local(const LogmapOptions& options) {
  if (!options.solve.radius) throw InvalidArgument("--local needs --radius");
  return *options.solve.radius;
}

void write_results(const LogmapOptions& options, const PlacedSource& source, const RowLogMap& rows,
                   const std::vector<double>& quality, const std::vector<Vec3>& away, Results& results,
                   Journal& journal) {
  io::Table table = results.table();
  add_map(table, rows, quality);
  if (!away.empty()) table.add({"gx", "gy", "gz"}, away);
  view::Scene scene = results.scene(rows, quality, source);
  scene.told.source = to_string(options.source.spec);
  results.write(table, scene, journal);
}

void check_corners(const LogmapOptions& options) {
  if (options.corners.empty()) return;
  const OutputPath corners{"--corners", options.corners};
  check_ending(corners, {".obj"});
  const std::string materials = std::filesystem::path(options.corners).replace_extension(".mtl").string();
  check_outputs(options.input.path, {{"--output", options.output.output},
                                     {"--json", options.output.json},
                                     {"--view", options.output.view},
                                     corners,
                                     {"--corners", materials}});
}

/// The faces as they were given, with the map at their corners.
void write_corners(const std::string& path, const Surface& surface, const LogMap& map) {
  const FaceList all = surface.faces();
  if (all.size() == 0) throw InvalidArgument("--corners " + path + ": the surface has no faces");
  const std::vector<Vec2> at = surface.on_corners(map);
  std::vector<double> coordinates;
  for (const Vec2& q : at) coordinates.insert(coordinates.end(), q.begin(), q.end());
  SurfaceFaces faces;
  faces.points.assign(surface.positions().begin(), surface.positions().end());
  faces.begin.assign(all.begin.begin(), all.begin.end());
  faces.corner_points.assign(all.vertices.begin(), all.vertices.end());
  const auto is_mapped = [&](std::size_t f) {
    return std::all_of(at.begin() + all.begin[f], at.begin() + all.begin[f + 1],
                       [](const Vec2& q) { return !std::isnan(q[0]); });
  };
  const FacesPart mapped(faces, is_mapped, coordinates);
  const FacesPart rest(faces, [&](std::size_t f) { return !is_mapped(f); });
  std::vector<io::MeshPart> parts;
  if (!mapped.empty()) parts.push_back(mapped.view("map"));
  if (!rest.empty()) parts.push_back(rest.view("rest"));
  io::write_textured(path, parts);
}

void run(const LogmapOptions& options) {
  if (options.estimate) return run_estimate(options.input, options.solve, options.output.json);
  check_results(options.input.path, options.output);
  check_corners(options);
  Journal journal(options.output.verbose);
  InputOptions opened = options.input;
  if (options.local) opened.local = radius_of_local(options);
  const Input input = open_input(opened, journal, options.source.spec);
  const PlacedSource source = resolve(options.source, input, options.input.threads);
  comment_on_source(options.source.spec, input, source, journal);

  const SolvedMap solved = solve(options.solve, input, options.source.spec, source, journal);
  const LogMap& map = solved.map;
  RowLogMap rows = input.surface().on_rows(map);
  const std::vector<double> quality = quality_of(input, map, rows, options.solve);
  if (opened.local) mark_beyond(input.geometry.points, source.position, *opened.local, rows);
  comment_on_statuses(rows.status, options.input.path, journal);
  comment_on_quality(quality, "keep to what is near with --radius, or start elsewhere", journal);

  Results results(options.output, input, options.input);
  const std::vector<Vec3> away =
      options.gradient ? distance_gradients(input.surface(), map, rows) : std::vector<Vec3>();
  write_results(options, source, rows, quality, away, results, journal);
  if (!options.corners.empty()) write_corners(options.corners, input.surface(), map);
  report({options.input.path, options.source.spec, options.solve, input, solved.solver, source, map, rows, quality},
         options.output, journal);
  results.keep();
}

void offer_method(CLI::App& app, LogmapOptions& o) {
  const char* group = "Method";
  add_method(app, o.solve)->group(group);
  add_variant(app, o.solve)->group(group);
  add_backend(app, o.input)->group(group);
  add_t_coef(app, o.solve)->group(group);
  add_parsed(app, "--radius", o.solve.radius, parse_positive, "R",
             "Leave out everything farther than this from the source")
      ->group(group);
  add_u_axis(app, o.source)->group(group);
  add_parsed(app, "--ordering", o.solve.ordering,
             choice_of<Ordering>({{"amd", Ordering::amd}, {"nested-dissection", Ordering::nested_dissection}}), "NAME",
             "Of the factorization: amd (default) or nested-dissection")
      ->group(group);
  add_parsed(
      app, "--strategy", o.solve.strategy,
      choice_of<Strategy>({{"auto", Strategy::automatic}, {"global", Strategy::global}, {"march", Strategy::march}}),
      "NAME", "auto (default), global: one factorization, or march: band by band, any size and distance")
      ->group(group);
  add_parsed(app, "--order", o.solve.order, integer_parser(1, 2), "N",
             "1 (default), or 2: extrapolate from several diffusion times, with an estimate of the error")
      ->group(group);
  add_parsed(app, "--accuracy", o.solve.accuracy, parse_positive, "A",
             "Of a march, against a global solve, relative (default 1e-9)")
      ->group(group);
  app.add_flag("--gradient", o.gradient, "Add the direction away from the source to the rows of OUTPUT")->group(group);
  add_threads(app, o.input, &o.solve)->group(group);
}

void offer_reports(CLI::App& app, OutputOptions& o) {
  const char* group = "Reports";
  add_json(app, o)->group(group);
  add_view(app, o)->group(group);
  add_map_picture(app, o.picture);
  add_verbose(app, o)->group(group);
}

void offer(CLI::App& app, LogmapOptions& o) {
  add_input(app, o.input);
  auto* source = add_source(app, o.source, "Where the map starts, see below");
  auto* output = add_output(app, o.output);
  add_parsed(app, "--corners", o.corners, non_empty, "CORNERS", "Mesh to write, with u,v at the corners of its faces");
  auto* estimate = app.add_flag("--estimate", o.estimate, "Tell what time and memory the run would take, and end");
  app.callback([=] {
    if (estimate->count() > 0) return;
    if (source->count() == 0) throw CLI::RequiredError("--source");
    if (output->count() == 0) throw CLI::RequiredError("--output");
  });
  offer_method(app, o);
  add_cloud_options(app, o.input);
  app.add_flag("--local", o.local,
               "With --radius: build the graph of the surroundings of the source only, fast on huge scans;\n"
               "the diffusion time is then that of the surroundings")
      ->group("Point clouds");
  add_mesh_options(app, o.input);
  offer_reports(app, o.output);
}

}  // namespace

Subcommand add_logmap(CLI::App& program) {
  return subcommand<LogmapOptions>(program, "logmap", "Logarithmic map of a surface from one source", logmap_footer,
                                   offer, run);
}

}  // namespace ahm::app
