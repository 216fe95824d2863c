#include <fmt/format.h>

#include <map>

#include "ahm/error.hpp"
#include "cli/numbers.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/estimate.hpp"
#include "commands/logmap_run.hpp"
#include "commands/subcommand.hpp"
#include "output/output_names.hpp"

namespace ahm::app {
namespace {

constexpr const char* logmap_footer =
    "Several files INPUT and several sources (--source again, or --sources) make a map each.\n"
    "\n"
    "SPEC is one of\n"
    "  123              a vertex of INPUT, counted from 0\n"
    "  1.5,0,-2         the vertex nearest to this position\n"
    "  face:7:.2,.3,.5  a point in face 7, by barycentric coordinates, one per corner (meshes)\n"
    "\n"
    "SOURCES is a list of these between blanks, or a file with one on each line.\n"
    "\n"
    "OUTPUT  .csv, .jsonl, .ply, .pcd or .vtp, or - (standard output); one row per vertex of INPUT, in its order:\n"
    "          index,x,y,z,u,v,distance,angle,status,quality,spread,error_estimate,bounded,\n"
    "          with --gradient also gx,gy,gz: unit vector in space, away from the source along the surface\n"
    "        u,v             the log map. Polar and exact: length and direction of the shortest path. Heat: the\n"
    "                        mean over the paths of heat, which cancel at the cut locus; straight behind holes\n"
    "        distance        along the surface; by heat it is not |(u, v)|\n"
    "        quality         in (0, 1]; below 0.5 expect u,v to be wrong by more than a tenth of the distance\n"
    "        spread          large at the cut locus, where neighbors lie far apart in the map\n"
    "        error_estimate  expected error of (u, v); polar maps only\n"
    "        bounded         1 where distance is only a lower bound, the straight line in space; not for exact\n"
    "        The numbers are nan where status is not ok:\n"
    "          disconnected  from the source                beyond_radius  farther than --radius\n"
    "          unreached     too far for double precision  removed        dropped, replaced, or in no face\n"
    "CORNERS .obj (with .mtl), .glb or .ply: the faces of INPUT with the u,v of every corner as texture coordinates\n"
    "        (.glb: u, 1 - v; .ply: s, t and the row as point); where the mesh is cut a vertex has several, and torn\n"
    "        faces are laid out anew, so that OUTPUT's u,v may be none of them. Faces without are the object 'rest'\n"
    "        (.ply: s, t are nan)\n"
    "\n"
    "Of several maps OUTPUT, CORNERS and the FILEs of --view and --json are names in which {} stands for that of\n"
    "INPUT (with several sources followed by _0, _1, ...), or folders: DIR/ is DIR/{}_map.csv (.png, .obj, .json).\n"
    "--json - tells one line per map. What fails is told, the others are made, and the exit status is 1.\n"
    "Files that exist are replaced when the new ones are complete, inputs never; see --no-overwrite.\n"
    "\n"
    "Examples:\n"
    "  ahm logmap scan.ply --source 0 -o map.csv\n"
    "  ahm logmap *.ply --source 0 -o maps/ --view 'maps/{}.png'\n"
    "  zcat scan.ply.gz | ahm logmap - --source 0 -o - --format jsonl | jq .distance\n"
    "  ahm logmap scan.pcd --source 0.1,0.2,1.4 --drop-nan --voxel 0.01 --outliers -o map.ply --view map.html\n"
    "  ahm logmap mesh.obj --source face:7:.2,.3,.5 --u-axis 1,0,0 -o map.ply\n"
    "  ahm logmap scan.xyz --source 17 -o map.csv --json - | jq .status";

/// What the user wrote: every input is mapped from every source.
struct LogmapCommand {
  std::vector<std::string> inputs;
  std::vector<SourceSpec> sources;
  LogmapOptions map;  ///< its names of files may be patterns
};

/// The files of one of several maps. @throws InvalidArgument where one name stands for all of them
void name_outputs(LogmapOptions& map, const std::string& stem) {
  const auto fill = [&](std::string& name, const char* option, const char* ending) {
    if (name.empty()) return;
    if (!is_pattern(name))
      throw InvalidArgument(fmt::format(
          "{} {}: names one file for several maps; write a folder, or {{}} for the name of the input", option, name));
    name = filled(name, stem, ending);
  };
  const std::string ending = map.output.format.empty() ? ".csv" : map.output.format;
  fill(map.output.output, "--output", ending.c_str());
  fill(map.output.view, "--view", ".png");
  fill(map.corners, "--corners", ".obj");
  if (map.output.json != "-") fill(map.output.json, "--json", ".json");
}

bool has_pattern(const LogmapOptions& map) {
  const OutputOptions& o = map.output;
  return is_pattern(o.output) || is_pattern(o.view) || is_pattern(map.corners) || is_pattern(o.json);
}

/// No two maps may go to the same file.
void check_different(const std::vector<std::vector<LogmapOptions>>& files) {
  std::map<std::string, std::string> inputs;
  for (const auto& maps : files)
    for (const LogmapOptions& map : maps)
      for (const std::string& name : {map.output.output, map.output.view, map.corners, map.output.json}) {
        if (name.empty() || name == "-") continue;
        if (const auto [other, is_new] = inputs.emplace(name, map.input.path); !is_new)
          throw InvalidArgument(fmt::format("{} would be written for {} and for {}; give the inputs different names",
                                            name, other->second, map.input.path));
      }
}

/// All maps, by inputs, with the files that are theirs.
std::vector<std::vector<LogmapOptions>> planned(const LogmapCommand& command) {
  const bool one = command.inputs.size() * command.sources.size() == 1;
  std::vector<std::vector<LogmapOptions>> files;
  for (const std::string& path : command.inputs) {
    auto& maps = files.emplace_back();
    for (std::size_t k = 0; k < command.sources.size(); ++k) {
      LogmapOptions& map = maps.emplace_back(command.map);
      map.input.path = path;
      map.source.spec = command.sources[k];
      const std::string stem = stem_of(path) + (command.sources.size() > 1 ? fmt::format("_{}", k) : "");
      if (!one || has_pattern(map)) name_outputs(map, stem);
      map.output.json_lines = !one && map.output.json == "-";
      check_log_map(map, command.inputs);
    }
  }
  check_different(files);
  return files;
}

void run(const LogmapCommand& command) {
  if (command.map.estimate) {
    if (command.inputs.size() > 1) throw InvalidArgument("--estimate: takes one INPUT");
    LogmapOptions map = command.map;
    map.input.path = command.inputs.front();
    if (!command.sources.empty()) map.source.spec = command.sources.front();
    return run_estimate(map, !command.sources.empty());
  }
  const auto files = planned(command);
  const std::size_t count = command.inputs.size() * command.sources.size();
  std::size_t failed = 0;
  for (const auto& maps : files) {
    std::size_t failed_here = maps.size();
    attempt(maps.front().input.path, count == 1, [&] { failed_here = run_log_maps(maps, count == 1); });
    failed += failed_here;
  }
  if (failed > 0) throw Error(fmt::format("{} of {} maps were not made", failed, count));
}

void offer_method(CLI::App& app, LogmapOptions& o) {
  const char* group = "Method";
  add_method(app, o.solve, {Method::polar, Method::exact}, true)->group(group);
  add_tolerance(app, o.solve)->group(group);
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
  add_strategy(app, o.solve)->group(group);
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
  add_verbosity(app, o.verbosity, group);
}

void offer(CLI::App& app, LogmapCommand& command) {
  LogmapOptions& o = command.map;
  add_inputs(app, o.input, command.inputs);
  add_sources(app, command.sources);
  auto* output = add_table_output(app, o.output);
  add_parsed(app, "--corners", o.corners, non_empty, "CORNERS", "Mesh to write, with u,v at the corners of its faces");
  auto* estimate = app.add_flag(
      "--estimate", o.estimate,
      "Tell what time and memory a map would take, and end: from the size of INPUT (evenly sampled, no radius), or\n"
      "with --source from its graph, which is built for it, to a third. How far a march on a cloud goes on beyond\n"
      "--radius is not known before: it takes at most what it takes without");
  app.callback([=, &app, &command, &o] {
    if (o.input.around_source && !o.solve.radius) throw CLI::ValidationError("--local", "needs --radius");
    if (o.solve.strategy == Strategy::global && app.count("--accuracy") > 0)
      throw CLI::ValidationError("--accuracy", "belongs to a march; --strategy global has none");
    if (estimate->count() > 0) return;
    if (command.sources.empty()) throw CLI::RequiredError("--source");
    if (output->count() == 0) throw CLI::RequiredError("--output");
  });
  offer_method(app, o);
  add_cloud_options(app, o.input);
  add_local(app, o.input, "With --radius");
  add_mesh_options(app, o.input);
  offer_reports(app, o.output);
}

}  // namespace

Subcommand add_logmap(CLI::App& program) {
  return subcommand<LogmapCommand>(program, "logmap", "Logarithmic maps of surfaces, one from each source",
                                   logmap_footer, offer, run);
}

}  // namespace ahm::app
