#include "commands/logmap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "ahm/cholmod/cholmod_solver.hpp"
#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "ahm/io/formats.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/quantile.hpp"
#include "ahm/util/vec.hpp"
#include "cli/console.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "cli/system_info.hpp"
#include "commands/estimate.hpp"
#include "commands/solve.hpp"
#include "commands/subcommand.hpp"
#include "input/left_out.hpp"
#include "input/open.hpp"
#include "input/surroundings.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"
#include "output/texture_output.hpp"
#include "output/wording.hpp"

namespace ahm::app {

/// The parts of a finished run. The references are valid during one call.
struct LogmapRun {
  const std::string& path;
  const SourceSpec& spec;
  const SolveOptions& options;
  const Input& input;
  const std::optional<LogMapSolver>& solver;  ///< for heat only
  const SurfaceSource& source;
  const LogMap& map;
  const RowLogMap& rows;
  const std::vector<double>& quality;  ///< quality of each row
  bool is_named = false;               ///< the text begins with the input and the source
};

/// Writes the summaries, for programs and for users.
void report(const LogmapRun& run, const OutputOptions& output, Journal& journal);

/// Checks before the work that the files of a map can be written and do not replace an input.
/// @throws IoError, InvalidArgument
void check_log_map(const LogmapOptions& options, const std::vector<std::string>& inputs);

/// Runs a part of the work. If it fails, prints the error where `reports_error` is set, and continues.
/// @param what   input, for the message
/// @param alone  this is all the work: exceptions are passed on
/// @return whether it succeeded
bool attempt(const std::string& what, bool alone, const std::function<void()>& work, bool reports_error = true);

/// Reads one file and makes its maps. The graph is built and factored once for all maps, unless it depends on the source. With
/// several maps the first ten failures are printed, and the other maps are made.
/// @param maps   options of the maps of one file; they differ only in sources and outputs
/// @param alone  as for `attempt`
/// @return number of maps that failed
/// @throws Cancelled; errors of reading and opening; with `alone` also errors of solving and writing
std::size_t run_log_maps(const std::vector<LogmapOptions>& maps, bool alone);

namespace {

constexpr std::array all_statuses = {Status::ok, Status::disconnected, Status::beyond_radius, Status::unreached,
                                     Status::removed};

std::size_t count(const RowLogMap& rows, Status status) {
  return static_cast<std::size_t>(std::count(rows.status.begin(), rows.status.end(), status));
}

double largest_distance(const RowLogMap& rows) {
  double largest = 0;
  for (double d : rows.distance)
    if (d > largest) largest = d;  // false if d is NaN
  return largest;
}

/// Median of the numbers that are not NaN; NaN if there are none.
double median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  return values.empty() ? NAN : detail::median(values);
}

nlohmann::ordered_json source_as_json(const LogmapRun& run) {
  nlohmann::ordered_json j;
  j["spec"] = to_string(run.spec);
  j["index"] = run.source.row ? nlohmann::ordered_json(run.source.row->index) : nlohmann::ordered_json(nullptr);
  j["position"] = run.source.position;
  if (run.source.frame)
    j["frame"] = {{"u", run.source.frame->x}, {"v", run.source.frame->y}, {"normal", run.source.frame->normal}};
  return j;
}

nlohmann::ordered_json factor_as_json(const std::string& factorization, const FactorStatistics& s) {
  return {{"factorization", factorization},
          {"assemble_seconds", s.assemble_seconds},
          {"analyze_seconds", s.analyze_seconds},
          {"factor_seconds", s.factor_seconds},
          {"nonzeros_A", s.nonzeros_A},
          {"nonzeros_B", s.nonzeros_B},
          {"bytes", s.bytes}};
}

nlohmann::ordered_json as_json(const LogmapRun& run, const OutputOptions& output, std::optional<double> reliable) {
  nlohmann::ordered_json j = summary("ahm logmap", run.path, output, run.input);
  j["input"]["normals"] = !run.input.geometry.normals.empty();
  j["n"] = run.rows.status.size();
  j["method"] = to_string(run.map.method());
  if (run.map.method() == Method::heat) {
    j["variant"] = to_string(run.map.variant());
    j["strategy"] = to_string(run.map.strategy());
    j["t_coef"] = run.options.t_coef;
  }
  j["mean_edge_length"] = run.input.mean_edge_length();
  j["largest_distance"] = largest_distance(run.rows);
  for (Status s : all_statuses) j["status"][std::string(to_string(s))] = count(run.rows, s);
  add_quality(j, run.quality, reliable);
  if (!run.rows.bounded.empty()) j["bounded"] = std::ranges::count(run.rows.bounded, 1);
  if (!run.rows.error_estimate.empty()) j["median_error_estimate"] = median(run.rows.error_estimate);
  j["source"] = source_as_json(run);
  j[std::string(run.input.backend->name)] = app::as_json(run.input.built.report);
  if (run.solver && run.solver->strategy() == Strategy::global)
    j["factor"] = factor_as_json(run.options.factor, run.solver->operators().statistics());
  if (const MarchStatistics& m = run.map.march(); m.bands > 0)
    j["march"] = {{"bands", m.bands}, {"largest_band", m.largest_band}, {"solved_vertices", m.solved}};
  return j;
}

std::string as_text(const LogmapRun& run, std::optional<double> reliable) {
  std::string text = run.is_named ? fmt::format("{}, source {}: ", run.path, to_string(run.spec)) : "";
  text += counted(run.rows.status.size(), "vertex");
  for (Status s : all_statuses)
    if (const std::size_t c = count(run.rows, s); c > 0 || s == Status::ok)
      text += fmt::format(", {} {}", c, to_string(s));
  const Vec3& p = run.source.position;
  text +=
      fmt::format("\nsource {} at {:.6g} {:.6g} {:.6g}, largest distance {:.6g}, mean edge length {:.4g}, method {}\n",
                  run.source.row ? fmt::format("{}", run.source.row->index) : to_string(run.spec), p[0], p[1], p[2],
                  largest_distance(run.rows), run.input.mean_edge_length(), to_string(run.map.method()));
  text += quality_as_text(run.rows.distance, run.quality, reliable);
  if (!run.rows.error_estimate.empty())
    text += fmt::format(", median error of (u, v) about {:.2g}", median(run.rows.error_estimate));
  if (const auto bounded = std::ranges::count(run.rows.bounded, 1); bounded > 0)
    text += fmt::format(", {} only a lower bound (the straight line)", counted(bounded, "distance", "are"));
  return text + "\n";
}

}  // namespace

void report(const LogmapRun& run, const OutputOptions& output, Journal& journal) {
  const std::optional<double> reliable = reliable_distance(run.rows.distance, run.quality);
  deliver(as_json(run, output, reliable), as_text(run, reliable), output, journal, {{"versions", versions()}});
}

namespace {

/// Number of failed maps per file that are reported one by one.
constexpr std::size_t most_reported = 10;

void write_results(const LogmapOptions& options, const SurfaceSource& source, const RowLogMap& rows,
                   const std::vector<double>& quality, const std::vector<Vec3>& away, Results& results,
                   Journal& journal) {
  io::Table table = results.table();
  add_map(table, rows, quality);
  if (!away.empty()) table.add({"gx", "gy", "gz"}, away);
  render::Scene scene = results.scene(rows, quality, source);
  scene.details.source = to_string(options.source.spec);
  results.write(table, scene, journal);
}

/// Writes the faces of the input with the map at their corners.
void write_corners(const std::string& path, const Input& input, const LogMap& map) {
  const Surface& surface = input.surface();
  if (surface.faces().size() == 0)
    throw InvalidArgument("--corners " + path + ": requires a mesh, the surface has no faces");
  const SurfaceFaces faces = given_faces(input.geometry);
  const std::vector<double> coordinates = at_given_corners(input, surface.to_corners(map));
  const auto is_mapped = [&](std::size_t f) {
    return std::all_of(coordinates.begin() + 2 * faces.begin[f], coordinates.begin() + 2 * faces.begin[f + 1],
                       [](double x) { return !std::isnan(x); });
  };
  const FacesPart mapped(faces, is_mapped, coordinates);
  const FacesPart rest(faces, [&](std::size_t f) { return !is_mapped(f); });
  std::vector<io::MeshPart> parts;
  if (!mapped.empty()) parts.push_back(mapped.view("map"));
  if (!rest.empty()) parts.push_back(rest.view("rest"));
  std::vector<io::Property> properties = input.geometry.properties;
  for (io::Property& property : properties) property.name = input_column(property.name);
  for (io::MeshPart& part : parts) part.colors = input.geometry.colors, part.properties = properties;
  io::write_textured(path, parts);
}

/// @throws InvalidArgument (OUTPUT is a format for textured meshes)
void check_for_rows(const OutputOptions& output) {
  const std::string extension = io::lower_extension(output.output);
  const auto is_in = [&](io::Use use) {
    const std::vector<std::string> all = io::extensions(use);
    return std::find(all.begin(), all.end(), extension) != all.end();
  };
  if (output.format.empty() && is_in(io::Use::write_textured) && !is_in(io::Use::write))
    throw InvalidArgument(fmt::format(
        "--output {0}: {1} files cannot store one row per vertex; use --corners {0} for the faces with u,v at corners",
        output.output, extension));
}

/// Makes the map of one source on an open input, and writes its files and summary.
/// @param maps      solvers for the input; made if there are none yet
/// @param count     number of maps that `maps` will make
/// @param is_named  the summary names the input
void map_from_source(const LogmapOptions& options, const Input& input, std::optional<Maps>& maps, std::size_t count,
                     bool is_named, Journal& journal) {
  const SurfaceSource source = resolve(options.source, input, options.input.threads);
  comment_on_positions(input, std::span(&options.source.spec, 1), "--source", journal);
  if (!maps) maps.emplace(options.solve, input, journal, static_cast<int>(count));
  std::optional<LogMap> solved;
  std::optional<ReferenceFront> front;
  const auto solve = [&] { solved = maps->map(options.solve, input, options.source.spec, source, journal); };
  const std::stop_token stop = journal.progress().stop;
  const auto unfold = [&] {
    if (maps->solver) front.emplace(input.graph(), source.source, map_options(options.solve).radius, stop);
  };
  detail::run_both(options.solve.threads, solve, unfold);
  const LogMap& map = *solved;
  RowLogMap rows = input.surface().to_rows(map, options.solve.threads);
  const std::vector<double> quality =
      to_rows(rows, front ? map_quality(input.graph(), map, *front, options.solve.threads)
                          : map_quality(input.graph(), map, options.solve.threads));
  front.reset();
  if (options.input.around_source) set_left_out_statuses(input, source, *options.solve.radius, rows);
  comment_on_statuses(rows.status, options.input.path, journal);
  comment_on_quality(quality, "limit the map with --radius, or choose another source", journal);

  Results results(options.output, input, options.input);
  const std::vector<Vec3> away =
      options.gradient ? distance_gradients(input.surface(), map, rows) : std::vector<Vec3>();
  write_results(options, source, rows, quality, away, results, journal);
  if (!options.corners.empty()) write_corners(options.corners, input, map);
  report({options.input.path, options.source.spec, options.solve, input, maps->solver, source, map, rows, quality,
          is_named},
         options.output, journal);
}

/// Whether the surface is built for the source, so that each source requires its own.
bool is_made_for_source(const LogmapOptions& options) {
  return options.input.around_source || options.input.voxel || options.input.outliers;
}

}  // namespace

void check_log_map(const LogmapOptions& options, const std::vector<std::string>& inputs) {
  check_for_rows(options.output);
  check_results(options.input.path, options.output);
  around_source(options.input, options.solve.radius);  // checks --local and --radius
  const OutputOptions& output = options.output;
  std::vector<OutputPath> files{{"--output", output.output}, {"--json", output.json}, {"--view", output.view}};
  if (!options.corners.empty()) {
    files.push_back({"--corners", options.corners});
    check_ending(files.back(), io::extensions(io::Use::write_textured));
    if (io::lower_extension(options.corners) == ".obj")
      files.push_back({"--corners", std::filesystem::path(options.corners).replace_extension(".mtl").string()});
  }
  check_outputs(inputs, files, output.keep_existing);
}

bool attempt(const std::string& what, bool alone, const std::function<void()>& work, bool reports_error) {
  if (alone) return work(), true;
  try {
    io::FileSet files;
    work();
    return true;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& e) {
    if (reports_error) print_to_stderr(fmt::format("ahm: error: {}: {}\n", what, worded(e)));
    return false;
  }
}

std::size_t run_log_maps(const std::vector<LogmapOptions>& maps, bool alone) {
  const LogmapOptions& first = maps.front();
  std::optional<Journal> journal(std::in_place, first.output.verbosity);
  io::Geometry geometry = read_input(first.input, *journal);
  std::optional<Input> input;
  std::optional<Maps> solvers;
  const bool for_source = is_made_for_source(first), one = maps.size() == 1;
  if (!for_source)
    input.emplace(open_input(std::exchange(geometry, {}), first.input, *journal,
                             one ? std::optional(first.source.spec) : std::nullopt));
  std::size_t failed = 0;
  for (const LogmapOptions& map : maps) {
    if (!journal) journal.emplace(map.output.verbosity);
    const auto work = [&] {
      if (for_source) {
        solvers.reset();
        input.emplace(open_input(geometry, around_source(map.input, map.solve.radius), *journal, map.source.spec));
      }
      map_from_source(map, *input, solvers, for_source ? 1 : maps.size(), !alone, *journal);
    };
    failed += !attempt(map.input.path, alone, work, failed < most_reported);
    journal.reset();
  }
  if (failed > most_reported)
    print_to_stderr(fmt::format("ahm: error: {}: more failed maps: {}\n", first.input.path, failed - most_reported));
  return failed;
}

namespace {

constexpr const char* logmap_footer =
    "Each INPUT file is mapped from each source (--source, which can be repeated, and --sources).\n"
    "\n"
    "SPEC is one of\n"
    "  123                 a vertex of INPUT, counted from 0\n"
    "  1.5,0,-2            the vertex nearest to this position\n"
    "  face:7:0.2,0.3,0.5  a point in face 7 in barycentric coordinates, one per corner (meshes)\n"
    "\n"
    "SOURCES is a list of SPECs separated by blanks, or a file with one SPEC per line.\n"
    "\n"
    "OUTPUT  .csv, .jsonl, .ply, .pcd, .vtp or - (standard output); one row per vertex of INPUT, in the same order:\n"
    "          index,x,y,z,u,v,distance,angle,status,quality,spread,error_estimate,bounded,\n"
    "          with --gradient also gx,gy,gz: unit vector in space, away from the source along the surface\n"
    "        u,v             the log map. Polar and exact: length and direction of the shortest path. Heat: a mean\n"
    "                        over paths, which shrinks to zero at the cut locus and goes straight across flat holes\n"
    "        distance        length of the shortest path along the surface; for heat it differs from |(u, v)|\n"
    "        quality         reliability of u,v in (0, 1]; below 0.5 errors may exceed a tenth of the distance\n"
    "        spread          uncertainty of u,v as a length; large at the cut locus, where the map tears\n"
    "        error_estimate  expected error of (u, v); polar maps only\n"
    "        bounded         1 where distance is only a lower bound, the straight line in space; not for exact maps\n"
    "        The numbers are nan where status is not ok:\n"
    "          disconnected   not connected to the source\n"
    "          beyond_radius  farther than --radius\n"
    "          unreached      too far for double precision\n"
    "          removed        dropped, replaced by another point, or in no face\n"
    "CORNERS .obj (with .mtl), .glb or .ply: the faces of INPUT with the u,v of every corner as texture coordinates\n"
    "        (.glb: u, 1 - v; .ply: s, t, and the row as point). A vertex where the mesh is cut has several u,v.\n"
    "        Faces that the map tears are unfolded separately, so their u,v may differ from those in OUTPUT.\n"
    "        Faces without u,v form the object 'rest' (.ply: s, t are nan)\n"
    "\n"
    "For several maps, OUTPUT, CORNERS and the FILEs of --view and --json are patterns or folders. {} in a pattern is\n"
    "replaced by the name of INPUT, with _0, _1, ... appended for several sources. A folder DIR/ means\n"
    "DIR/{}_map.csv (.png, .obj, .json). --json - prints one line per map. If a map fails, the program reports the\n"
    "error, makes the other maps, and exits with status 1.\n"
    "Existing files are replaced once the new ones are complete (see --no-overwrite). Inputs are never replaced.\n"
    "\n"
    "Examples:\n"
    "  ahm logmap scan.ply --source 0 -o map.csv\n"
    "  ahm logmap *.ply --source 0 -o maps/ --view 'maps/{}.png'\n"
    "  zcat scan.ply.gz | ahm logmap - --source 0 -o - --format jsonl | jq .distance\n"
    "  ahm logmap scan.pcd --source 0.1,0.2,1.4 --drop-nan --voxel 0.01 --outliers -o map.ply --view map.html\n"
    "  ahm logmap mesh.obj --source face:7:0.2,0.3,0.5 --u-axis 1,0,0 -o map.ply\n"
    "  ahm logmap scan.xyz --source 17 -o map.csv --json - | jq .status";

/// The command line: every input is mapped from every source.
struct LogmapCommand {
  std::vector<std::string> inputs;
  std::vector<SourceSpec> sources;
  LogmapOptions map;  ///< options of all maps; file names may be patterns
};

/// Sets the file names of one of several maps. @throws InvalidArgument (a name is not a pattern)
void name_outputs(LogmapOptions& map, const std::string& stem) {
  const auto fill = [&](std::string& name, const char* option, const char* ending) {
    if (name.empty()) return;
    if (!is_pattern(name))
      throw InvalidArgument(
          fmt::format("{} {}: this is one file for several maps; write a folder, or {{}} in place of the input's name",
                      option, name));
    name = output_name(name, stem, ending);
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

/// Checks that no two maps are written to the same file. @throws InvalidArgument
void check_different(const std::vector<std::vector<LogmapOptions>>& files) {
  std::map<std::string, std::string> inputs;
  for (const auto& maps : files)
    for (const LogmapOptions& map : maps)
      for (const std::string& name : {map.output.output, map.output.view, map.corners, map.output.json}) {
        if (name.empty() || name == "-") continue;
        if (const auto [other, is_new] = inputs.emplace(name, map.input.path); !is_new)
          throw InvalidArgument(fmt::format("{} is the output of both {} and {}; rename one of these inputs", name,
                                            other->second, map.input.path));
      }
}

/// The options of all maps, by input, with their own file names.
std::vector<std::vector<LogmapOptions>> plan_maps(const LogmapCommand& command) {
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
    if (command.inputs.size() > 1) throw InvalidArgument("--estimate: requires a single INPUT");
    LogmapOptions map = command.map;
    map.input.path = command.inputs.front();
    if (!command.sources.empty()) map.source.spec = command.sources.front();
    return run_estimate(map, !command.sources.empty());
  }
  const auto files = plan_maps(command);
  const std::size_t count = command.inputs.size() * command.sources.size();
  std::size_t failed = 0;
  for (const auto& maps : files) {
    std::size_t failed_here = maps.size();
    attempt(maps.front().input.path, count == 1, [&] { failed_here = run_log_maps(maps, count == 1); });
    failed += failed_here;
  }
  if (failed > 0) throw Error(fmt::format("{} of {} failed", failed, counted(count, "map")));
}

/// Sets `solver` for --factor. @throws InvalidArgument (this build has no CHOLMOD), CLI::ValidationError
void set_factor(const CLI::App& app, SolveOptions& o) {
  if (o.factor == "own") return;
  for (const char* own : {"--ordering", "--estimate"})
    if (app.count(own) > 0)
      throw CLI::ValidationError(own, fmt::format("is for own factors; leave it out with --factor {}", o.factor));
  if (o.strategy == Strategy::march)
    throw CLI::ValidationError("--factor", "a march uses own factors; leave out --factor, or use --strategy global");
  o.solver = cholmod_solver(o.factor == "cholmod" ? CholmodFactorization::automatic : CholmodFactorization::simplicial);
}

CLI::Option* add_factor(CLI::App& app, SolveOptions& o) {
  return add_parsed(app, "--factor", o.factor, choice({"own", "cholmod", "cholmod-simplicial"}), "NAME",
                    "Library of the factorization, for comparisons: own (default), cholmod (SuiteSparse, by its\n"
                    "own choice with supernodes if the factor is large), or cholmod-simplicial (never with\n"
                    "supernodes). Not for a march");
}

void offer_method(CLI::App& app, LogmapOptions& o) {
  const char* group = "Method";
  add_method(app, o.solve, {Method::polar, Method::exact}, true)->group(group);
  add_variant(app, o.solve)->group(group);
  add_backend(app, o.input)->group(group);
  add_t_coef(app, o.solve)->group(group);
  add_parsed(app, "--radius", o.solve.radius, parse_positive, "R", "Map only points within this distance of the source")
      ->group(group);
  add_u_axis(app, o.source)->group(group);
  add_parsed(
      app, "--ordering", o.solve.ordering,
      choice_of<Ordering>(
          {{"auto", Ordering::automatic}, {"amd", Ordering::amd}, {"nested-dissection", Ordering::nested_dissection}}),
      "NAME", "Ordering of the factorization: auto (default), amd, nested-dissection")
      ->group(group);
  add_factor(app, o.solve)->group(group);
  add_strategy(app, o.solve)->group(group);
  add_parsed(app, "--accuracy", o.solve.accuracy, parse_positive, "A",
             "Relative accuracy of a march, compared with a global solve (default 1e-9)")
      ->group(group);
  app.add_flag("--gradient", o.gradient, "Add columns with the direction away from the source to OUTPUT")->group(group);
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
  add_table_output(app, o.output);
  add_parsed(app, "--corners", o.corners, non_empty, "CORNERS",
             "Output mesh with u,v at the corners of its faces, see below");
  auto* estimate = app.add_flag(
      "--estimate", o.estimate,
      "Print the estimated time and memory of a map by heat and exit. Without --source the estimate uses only the\n"
      "size of INPUT (even sampling, no radius). With --source it builds the graph and is accurate to a third.\n"
      "On clouds a march with --radius may cost more than estimated, but never more than without --radius");
  app.callback([=, &app, &command, &o] {
    if (o.input.around_source && !o.solve.radius) throw CLI::ValidationError("--local", "requires --radius");
    if (o.solve.strategy == Strategy::global && app.count("--accuracy") > 0)
      throw CLI::ValidationError("--accuracy", "requires a march; leave it out with --strategy global");
    set_factor(app, o.solve);
    if (estimate->count() > 0) return;
    if (command.sources.empty()) throw CLI::RequiredError("--source");
    const auto is_given = [&app](const char* name) { return app.count(name) > 0; };
    if (std::ranges::none_of(std::array{"--output", "--view", "--corners", "--json"}, is_given))
      throw CLI::RequiredError("--output or --view");
  });
  offer_method(app, o);
  add_cloud_options(app, o.input);
  add_local(app, o.input, "Up to --radius, which is required");
  add_mesh_options(app, o.input);
  offer_reports(app, o.output);
}

}  // namespace

Subcommand add_logmap(CLI::App& program) {
  return subcommand<LogmapCommand>(program, "logmap", "Logarithmic maps of surfaces, one per source", logmap_footer,
                                   offer, run);
}

}  // namespace ahm::app
