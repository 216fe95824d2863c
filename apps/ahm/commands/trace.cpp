#include <fmt/format.h>

#include "ahm/error.hpp"
#include "cli/numbers.hpp"
#include "cli/option_adders.hpp"
#include "commands/polyline.hpp"
#include "commands/subcommand.hpp"

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

Polyline find_line(const TraceCommandOptions& options, const ExactGeodesics& geodesics, const Input& input) {
  Polyline result{.from = point_on_faces(input, options.source, "--source")};
  const exact::TracedPath line = trace(geodesics, result.from, options);
  const std::vector<Vec3>& points = result.points = positions_of(geodesics, line.points);
  const bool complete = line.end == exact::TraceEnd::complete;
  result.json["source"] = {{"spec", to_string(options.source)}, {"position", points.front()}};
  result.json["end"] = {{"at", complete ? "length" : "boundary"}, {"position", points.back()}};
  result.json["points"] = points.size();
  result.json["length"] = line.length;
  result.text = fmt::format("a line of {} points, {:.6g} long{}\n", points.size(), line.length,
                            complete ? "" : ", where it meets the boundary");
  return result;
}

void run(const TraceCommandOptions& options) {
  run_polyline("trace", options.input, options.output, options.source,
               [&](const auto& geodesics, const Input& input) { return find_line(options, geodesics, input); });
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
