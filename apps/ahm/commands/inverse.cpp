#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "ahm/applications/inverse_map.hpp"
#include "ahm/io/write.hpp"
#include "ahm/maps/quality.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/solve.hpp"
#include "commands/subcommand.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"

namespace ahm::app {
namespace {

constexpr const char* inverse_footer =
    "SPEC is 123, x,y,z (the nearest vertex) or face:7:0.2,0.3,0.5 as in 'ahm logmap': with the same --source, (u, v)\n"
    "are those of 'ahm logmap'.\n"
    "POINTS is a list 'u,v u,v ...' or a file with one pair per line, in the unit of INPUT.\n"
    "OUTPUT is .csv, .jsonl, .ply or .vtp; one row per pair. Numbers are nan where the map has no such point, or its\n"
    "quality there is below --min-quality:\n"
    "  index     number of the pair, from 0 (.csv, .jsonl)\n"
    "  u,v       the pair\n"
    "  x,y,z     position on the surface\n"
    "  nx,ny,nz  unit normal of the surface, on the side of the source's normal\n"
    "  hx,hy,hz  unit direction of the u axis there, tangential to the surface\n"
    "\n"
    "Example:\n"
    "  ahm inverse scan.ply --source 17 --at '0.1,0 0.1,0.05' -o points.csv";

struct InverseCommandOptions {
  InputOptions input;
  SourceOptions source;
  SolveOptions solve;
  OutputOptions output;
  std::vector<std::array<double, 2>> points;
  double min_quality = reliable_quality;
};

/// Writes the points. @return how many of them are on the surface
std::size_t write(const InverseCommandOptions& options, const InverseMap& inverse) {
  std::vector<double> us, vs;
  const Vec3 none{NAN, NAN, NAN};
  std::vector<Vec3> positions(options.points.size(), none), normals = positions, headings = positions;
  std::size_t found = 0;
  for (std::size_t i = 0; i < options.points.size(); ++i) {
    const auto& [u, v] = options.points[i];
    us.push_back(u), vs.push_back(v);
    const std::optional<InversePoint> point = inverse.at(u, v);
    if (!point) continue;
    positions[i] = point->position, normals[i] = point->normal, headings[i] = point->frame().x;
    ++found;
  }
  io::Table table;
  table.add("u", us), table.add("v", vs);
  table.add({"x", "y", "z"}, positions);
  table.add({"nx", "ny", "nz"}, normals);
  table.add({"hx", "hy", "hz"}, headings);
  io::write(options.output.output, table, options.output.format);
  return found;
}

/// Distance in the map from the source to the farthest of the points.
double reach(const std::vector<std::array<double, 2>>& points) {
  double longest = 0;
  for (const auto& [u, v] : points) longest = std::max(longest, std::hypot(u, v));
  return longest;
}

void run(const InverseCommandOptions& options) {
  check_results(options.input.path, options.output, {".csv", ".jsonl", ".ply", ".vtp"});
  Journal journal(options.output.verbosity);
  const Input input = open_around(options.input, reach(options.points), journal, options.source.spec);
  const SurfaceSource source = resolve(options.source, input, options.input.threads);
  comment_on_positions(input, std::span(&options.source.spec, 1), "--source", journal);
  const LogMap map = solve(options.solve, input, options.source.spec, source, journal);

  const std::vector<double> quality = map_quality(input.graph(), map, options.solve.threads);
  comment_on_quality(to_rows(input.surface().to_rows(map), quality), "choose a source closer to POINTS", journal);

  journal.start("write");
  const std::size_t found =
      write(options, inverse_map(input.surface(), map, {.min_quality = options.min_quality, .quality = quality}));
  nlohmann::ordered_json j = summary("ahm inverse", options.input.path, options.output, input);
  j["source"] = {{"spec", to_string(options.source.spec)}, {"position", source.position}};
  j["points"] = options.points.size();
  j["found"] = found;
  deliver(std::move(j), fmt::format("points found on the surface: {} of {}\n", found, options.points.size()),
          options.output, journal);
}

void offer(CLI::App& app, InverseCommandOptions& o) {
  add_input(app, o.input);
  add_source(app, o.source, "Source of the map, see below")->required();
  add_parsed(app, "--at", o.points, parse_plane_points, "POINTS", "Coordinates (u, v) to look up, see below")
      ->required();
  add_table_output(app, o.output)->required();
  add_min_quality(app, o.min_quality);
  add_u_axis(app, o.source);
  add_method(app, o.solve, {Method::polar, Method::exact}, true);
  add_strategy(app, o.solve);
  add_graph_options(app, o.input, o.solve);
  add_local(app, o.input, "Up to the farthest of POINTS");
  add_json(app, o.output);
  add_verbosity(app, o.output.verbosity);
}

}  // namespace

Subcommand add_inverse(CLI::App& program) {
  return subcommand<InverseCommandOptions>(program, "inverse", "Points of a surface at coordinates (u, v), with frames",
                                           inverse_footer, offer, run);
}

}  // namespace ahm::app
