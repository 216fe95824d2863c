#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ahm/error.hpp"
#include "cli/numbers.hpp"
#include "cli/option_adders.hpp"
#include "commands/polyline.hpp"
#include "commands/subcommand.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"

namespace ahm::app {
namespace {

constexpr const char* trace_footer =
    "SPEC is 123, x,y,z (the nearest point of the surface) or face:7:.2,.3,.5 as in 'ahm path'.\n"
    "The line goes straight through faces, and through vertices with equal angles on both sides; it ends early at\n"
    "the boundary.\n"
    "OUTPUT is .csv, .ply or .obj as in 'ahm path'.\n"
    "\n"
    "Example:\n"
    "  ahm trace mesh.ply --source 17 --direction 1,0,0 --length 0.5 -o line.csv --view line.png";

struct TraceCommandOptions {
  InputOptions input;
  OutputOptions output;
  SourceSpec source;
  Vec3 direction{};
  double length = 0;
};

exact::TracedPath trace(const ExactGeodesics& geodesics, const SurfacePoint& from, const TraceCommandOptions& options) {
  try {
    return geodesics.trace(from, options.direction, options.length);
  } catch (const InvalidArgument& e) {
    if (e.fault() != "axis_along_normal") throw;
    throw InvalidArgument(fmt::format("--direction {},{},{}: is perpendicular to the surface at the source {}",
                                      options.direction[0], options.direction[1], options.direction[2],
                                      to_string(options.source)));
  }
}

void report(const TraceCommandOptions& options, const Input& input, const exact::TracedPath& line,
            const std::vector<Vec3>& points, Journal& journal) {
  const bool complete = line.end == exact::TraceEnd::complete;
  nlohmann::ordered_json j = summary("ahm trace", options.input.path, options.output, input);
  j["source"] = {{"spec", to_string(options.source)}, {"position", points.front()}};
  j["end"] = {{"at", complete ? "length" : "boundary"}, {"position", points.back()}};
  j["points"] = points.size();
  j["length"] = line.length;
  deliver(std::move(j),
          fmt::format("a line of {} points, {:.6g} long{}\n", points.size(), line.length,
                      complete ? "" : ", where it meets the boundary"),
          options.output, journal);
}

void run(const TraceCommandOptions& options) {
  check_results(options.input.path, options.output, polyline_endings());
  Journal journal(options.output.verbose);
  const Input input = open_input(options.input, journal, options.source);
  journal.start("trace");
  const ExactGeodesics geodesics = geodesics_of(input);
  const SurfacePoint from = point_on_faces(input, options.source, "--source");
  const exact::TracedPath line = trace(geodesics, from, options);
  std::vector<Vec3> points;
  for (const exact::MeshPoint& point : line.points) points.push_back(geodesics.position(point));
  write_polyline_view(geodesics, input, options.input, options.output, from, points, journal);
  journal.start("write");
  write_polyline(options.output.output, points);
  report(options, input, line, points, journal);
}

void offer(CLI::App& app, TraceCommandOptions& o) {
  add_input(app, o.input);
  add_parsed(app, "-s,--source", o.source, parse_source, "SPEC", "Where the line starts, see below")->required();
  add_parsed(app, "--direction", o.direction, parse_direction, "X,Y,Z", "Where to, projected to the surface")
      ->required();
  add_parsed(app, "--length", o.length, parse_positive, "L", "How far, along the surface")->required();
  add_output(app, o.output)->required();
  add_threads(app, o.input);
  add_mesh_options(app, o.input);
  add_map_results(app, o.output);
}

}  // namespace

Subcommand add_trace(CLI::App& program) {
  return subcommand<TraceCommandOptions>(program, "trace", "Straight line over the faces of a mesh", trace_footer,
                                         offer, run);
}

}  // namespace ahm::app
