#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ahm/error.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/polyline.hpp"
#include "commands/subcommand.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"

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

/// The curve through all points, and how long it is between them.
struct Path {
  std::vector<Vec3> points;
  std::vector<double> lengths;
  double length = 0;

  void add(const ExactGeodesics& geodesics, const exact::GeodesicPath& leg) {
    for (const exact::MeshPoint& point : leg.points) {
      const bool joint = !points.empty() && &point == &leg.points.front();
      if (!joint) points.push_back(geodesics.position(point));
    }
    lengths.push_back(leg.length);
    length += leg.length;
  }
};

Path find_path(const ExactGeodesics& geodesics, const std::vector<SurfacePoint>& stops,
               const std::vector<SourceSpec>& specs) {
  Path path;
  for (std::size_t k = 1; k < stops.size(); ++k) {
    const exact::GeodesicPath leg = geodesics.path(std::span(stops).subspan(k - 1, 2));
    if (leg.status != Status::ok)
      throw InvalidArgument(fmt::format("there is no path from {} to {}: the surface does not connect them",
                                        to_string(specs[k - 1]), to_string(specs[k])));
    path.add(geodesics, leg);
  }
  return path;
}

void report(const PathCommandOptions& options, const Input& input, const std::vector<SourceSpec>& specs,
            const Path& path, Journal& journal) {
  nlohmann::ordered_json j = summary("ahm path", options.input.path, options.output, input);
  for (const SourceSpec& spec : specs) j["stops"].push_back(to_string(spec));
  j["closed"] = options.closed;
  j["points"] = path.points.size();
  j["length"] = path.length;
  j["lengths"] = path.lengths;
  deliver(std::move(j), fmt::format("a path of {} points, {:.6g} long\n", path.points.size(), path.length),
          options.output, journal);
}

void run(const PathCommandOptions& options) {
  check_results(options.input.path, options.output, polyline_endings());
  Journal journal(options.output.verbose);
  const Input input = open_input(options.input, journal);
  journal.start("path");
  const ExactGeodesics geodesics = geodesics_of(input);
  std::vector<SourceSpec> specs{options.from};
  specs.insert(specs.end(), options.to.begin(), options.to.end());
  std::vector<SurfacePoint> stops;
  for (const SourceSpec& spec : specs) stops.push_back(point_on_faces(input, spec, stops.empty() ? "--from" : "--to"));
  if (options.closed) stops.push_back(stops.front()), specs.push_back(specs.front());
  const Path path = find_path(geodesics, stops, specs);
  write_polyline_view(geodesics, input, options.input, options.output, stops.front(), path.points, journal);
  journal.start("write");
  write_polyline(options.output.output, path.points);
  report(options, input, specs, path, journal);
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
