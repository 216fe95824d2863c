#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "cli/numbers.hpp"
#include "cli/option_adders.hpp"
#include "commands/commands.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"
#include "output/run_report.hpp"

namespace ahm::app {
namespace {

constexpr const char* logmap_footer =
    "SPEC is one of\n"
    "  123              a vertex of INPUT, counted from 0\n"
    "  1.5,0,-2         the vertex nearest to this position\n"
    "  face:7:.2,.3,.5  a point in face 7, by barycentric coordinates, one per corner (meshes)\n"
    "\n"
    "INPUT   .ply .pcd .xyz .txt .csv .off .obj .stl\n"
    "OUTPUT  .csv, .ply or .pcd; one row per vertex of INPUT, in its order:\n"
    "          index,x,y,z,u,v,distance,angle,status,quality, with --order 2 also error_estimate,\n"
    "          with --gradient also gx,gy,gz: unit vector in space, away from the source along the surface\n"
    "        quality is in (0, 1]; below 0.5 the vertex lies at a cut locus or in a fold.\n"
    "        The numbers are nan where status is not ok:\n"
    "          component  not connected to the source      radius   beyond --radius\n"
    "          unreached  too far for double precision     removed  dropped, replaced, or in no face\n"
    "\n"
    "Examples:\n"
    "  ahm logmap scan.ply --source 0 -o map.csv\n"
    "  ahm logmap scan.pcd --source 0.1,0.2,1.4 --drop-nan --voxel 0.01 --outliers -o map.ply --view map.html\n"
    "  ahm logmap mesh.obj --source face:7:.2,.3,.5 --u-axis 1,0,0 -o map.ply\n"
    "  ahm logmap scan.xyz --source 17 -o map.csv --json - | jq .status";

double distance(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// Something the user should know about where the source ended up.
void comment_on_source(const RunOptions& options, const Model& model, const ResolvedSource& source, Journal& journal) {
  const auto* wanted = std::get_if<SourcePosition>(&options.source);
  if (wanted == nullptr) return;
  const double away = distance(wanted->position, source.position);
  const double edge = model.graph().mean_edge_length() * model.graph().length_unit();
  if (away > 10 * edge)
    journal.add_warning(
        fmt::format("the vertex nearest to {} is {:.4g} away, at {:.6g} {:.6g} {:.6g}: {:.0f} mean edge lengths",
                    to_string(*wanted), away, source.position[0], source.position[1], source.position[2], away / edge));
}

/// What was left out because it is farther than the radius in a straight line already.
void mark_beyond(const std::vector<Vec3>& points, const Vec3& source, double radius, MapRows& rows) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (rows.status[i] == Status::removed && distance(points[i], source) > radius)
      rows.status[i] = Status::beyond_radius;
}

void write_results(const ResolvedSource& source, const MapRows& rows, const std::vector<Vec3>& away, Results& results,
                   Journal& journal) {
  io::Table table = results.table();
  table.add("u", rows.u);
  table.add("v", rows.v);
  table.add("distance", rows.distance);
  table.add("angle", rows.angle);
  table.add("status", rows.status);
  table.add("quality", rows.quality);
  if (!rows.error_estimate.empty()) table.add("error_estimate", rows.error_estimate);
  if (!away.empty()) table.add({"gx", "gy", "gz"}, away);
  view::Scene scene = results.scene();
  scene.u = rows.u;
  scene.v = rows.v;
  scene.source = source.position;
  if (source.frame) scene.source_axes = {source.frame->x, source.frame->y, source.frame->normal};
  results.write(table, scene, journal);
}

void run_logmap(const RunOptions& options) {
  if (options.estimate) return run_estimate(options);
  check_results(options);
  Journal journal(options.verbose);
  const Surface surface = open_surface(options, journal);
  const auto& [input, backend, model] = surface;
  const ResolvedSource source = resolve(options, *model);
  comment_on_source(options, *model, source, journal);

  const LogMapSolver solver = make_solver(options, *model, journal);
  const LogMap map = solve(options, solver, source.source, journal);
  MapRows rows = rows_of(map, *model, input.points.size());
  if (options.local) mark_beyond(input.points, source.position, *options.radius, rows);
  comment_on_statuses(rows.status, options.input, journal);
  Results results(options, surface);
  const std::vector<Vec3> away = options.gradient ? gradients(map, *model, rows) : std::vector<Vec3>();
  write_results(source, rows, away, results, journal);
  const Run run{options, input, backend, *model, solver, source, map, rows, journal.times(), journal.warnings()};
  write_json(options.json, run_as_json(run));
  results.keep();
  const bool stdout_taken = options.json == "-" || is_stream(options.output);
  stdout_taken ? say(run_as_text(run)) : print(run_as_text(run));
}

void add_method_options(CLI::App& app, RunOptions& o) {
  const char* group = "Method";
  add_variant(app, o)->group(group);
  add_backend(app, o)->group(group);
  add_t_coef(app, o)->group(group);
  add_parsed(app, "--radius", o.radius, parse_positive, "R", "Leave out everything farther than this from the source")
      ->group(group);
  add_u_axis(app, o)->group(group);
  add_parsed(
      app, "--ordering", o.ordering,
      [](const std::string& text) {
        return choice({"amd", "nested-dissection"})(text) == "amd" ? Ordering::amd : Ordering::nested_dissection;
      },
      "NAME", "Of the factorization: amd (default) or nested-dissection")
      ->group(group);
  add_parsed(
      app, "--strategy", o.strategy,
      [](const std::string& text) {
        const std::string name = choice({"auto", "global", "march"})(text);
        return name == "auto" ? Strategy::automatic : name == "global" ? Strategy::global : Strategy::march;
      },
      "NAME", "auto (default), global: one factorization, or march: band by band, any size and distance")
      ->group(group);
  add_parsed(app, "--order", o.order, integer_parser(1, 2), "N",
             "1 (default), or 2: extrapolate from several diffusion times, with an estimate of the error")
      ->group(group);
  add_parsed(app, "--accuracy", o.accuracy, parse_positive, "A",
             "Of a march, against a global solve, relative (default 1e-9)")
      ->group(group);
  app.add_flag("--gradient", o.gradient, "Add the direction away from the source to the rows of OUTPUT")->group(group);
  add_threads(app, o.threads)->group(group);
}

void add_local(CLI::App& app, RunOptions& o) {
  app.add_flag("--local", o.local,
               "With --radius: build the graph of the surroundings of the source only, fast on huge scans;\n"
               "the diffusion time is then that of the surroundings")
      ->group("Point clouds");
}

void add_report_options(CLI::App& app, RunOptions& o) {
  const char* group = "Reports";
  add_json(app, o)->group(group);
  add_view(app, o)->group(group);
  add_verbose(app, o)->group(group);
}

}  // namespace

Subcommand add_logmap(CLI::App& program) {
  const auto options = std::make_shared<RunOptions>();
  RunOptions& o = *options;
  CLI::App& logmap = *program.add_subcommand("logmap", "Logarithmic map of a surface from one source");
  add_input(logmap, o.input);
  auto* source = add_source(logmap, o, "Where the map starts, see below");
  auto* output = add_output(logmap, o);
  auto* estimate = logmap.add_flag("--estimate", o.estimate, "Tell what time and memory the run would take, and end");
  logmap.callback([=] {
    if (estimate->count() > 0) return;
    if (source->count() == 0) throw CLI::RequiredError("--source");
    if (output->count() == 0) throw CLI::RequiredError("--output");
  });
  add_method_options(logmap, o);
  add_cloud_options(logmap, o);
  add_local(logmap, o);
  add_mesh_options(logmap, o);
  add_polygon_options(logmap, o);
  add_report_options(logmap, o);
  logmap.footer(logmap_footer);
  return {&logmap, [options] { run_logmap(*options); }};
}

}  // namespace ahm::app
