#include <fmt/format.h>

#include <numeric>

#include "ahm/error.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/polyline.hpp"
#include "commands/subcommand.hpp"

namespace ahm::app {
namespace {

constexpr const char* path_footer =
    "POINTS is a list 'SPEC SPEC ...' or a file with one SPEC per line; SPEC is one of\n"
    "  123              a vertex of INPUT, counted from 0\n"
    "  1.5,0,-2         the nearest point of the surface; in files also 1.5 0 -2\n"
    "  face:7:.2,.3,.5  a point in face 7, by barycentric coordinates, one per corner\n"
    "The path is the shortest over the flat faces, exact up to rounding; of several of one length, one of them.\n"
    "\n"
    "OUTPUT  .csv, .ply with edges, or .obj with a line: x,y,z and arclength (not in .obj) where the path starts,\n"
    "        crosses an edge, bends, and ends\n"
    "\n"
    "Examples:\n"
    "  ahm path mesh.ply --from 17 --to 4711 -o path.csv --json -\n"
    "  ahm path mesh.obj --from 0.1,0.2,1.4 --to '33 face:7:.2,.3,.5' --closed -o loop.obj --view loop.png";

struct PathCommandOptions {
  InputOptions input;
  OutputOptions output;
  SourceSpec from;
  std::vector<SourceSpec> to;
  bool closed = false;
};

/// Adds the shortest ways from stop to stop, as one curve.
void go_through(const std::vector<SurfacePoint>& stops, const std::vector<SourceSpec>& specs,
                const ExactGeodesics& geodesics, Polyline& path) {
  std::vector<double> lengths;
  for (std::size_t k = 1; k < stops.size(); ++k) {
    const exact::GeodesicPath leg = geodesics.path(std::span(stops).subspan(k - 1, 2));
    if (leg.status != Status::ok)
      throw InvalidArgument(fmt::format("there is no path from {} to {}: the surface does not connect them",
                                        to_string(specs[k - 1]), to_string(specs[k])));
    const std::vector<Vec3> points = positions_of(geodesics, leg.points);
    path.points.insert(path.points.end(), points.begin() + (k > 1 ? 1 : 0), points.end());
    lengths.push_back(leg.length);
  }
  const double length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  path.text = fmt::format("a path of {} points, {:.6g} long\n", path.points.size(), length);
  path.json["points"] = path.points.size();
  path.json["length"] = length;
  path.json["lengths"] = lengths;
}

Polyline find_path(const PathCommandOptions& options, const ExactGeodesics& geodesics, const Input& input) {
  std::vector<SourceSpec> specs{options.from};
  specs.insert(specs.end(), options.to.begin(), options.to.end());
  std::vector<SurfacePoint> stops;
  for (const SourceSpec& spec : specs) stops.push_back(point_on_faces(input, spec, stops.empty() ? "--from" : "--to"));
  if (options.closed) stops.push_back(stops.front()), specs.push_back(specs.front());
  Polyline path{.from = stops.front()};
  for (const SourceSpec& spec : specs) path.json["stops"].push_back(to_string(spec));
  path.json["closed"] = options.closed;
  go_through(stops, specs, geodesics, path);
  return path;
}

void run(const PathCommandOptions& options) {
  run_polyline("path", options.input, options.output, {},
               [&](const auto& geodesics, const Input& input) { return find_path(options, geodesics, input); });
}

void offer(CLI::App& app, PathCommandOptions& o) {
  add_input(app, o.input);
  add_parsed(app, "--from", o.from, parse_source, "SPEC", "Where the path starts, see below")->required();
  add_parsed(app, "--to", o.to, parse_sources, "POINTS", "Where it ends, or what it leads through in this order")
      ->required();
  add_output(app, o.output)->required();
  app.add_flag("--closed", o.closed, "And back to where it starts");
  add_threads(app, o.input);
  add_mesh_options(app, o.input);
  add_map_results(app, o.output);
}

}  // namespace

Subcommand add_path(CLI::App& program) {
  return subcommand<PathCommandOptions>(program, "path", "Shortest path over the faces of a mesh", path_footer, offer,
                                        run);
}

}  // namespace ahm::app
