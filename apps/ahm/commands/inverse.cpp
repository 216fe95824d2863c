#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "ahm/io/write.hpp"
#include "cli/numbers.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/commands.hpp"
#include "input/skin.hpp"
#include "output/output_paths.hpp"

namespace ahm::app {
namespace {

constexpr const char* inverse_footer =
    "SPEC is 123, x,y,z or face:7:.2,.3,.5 as in 'ahm logmap'.\n"
    "POINTS is a list 'u,v u,v ...' or a file with one pair per line, in the unit of INPUT.\n"
    "OUTPUT is .csv; one row per pair, nan where the map is not to be trusted or has no such point:\n"
    "  u,v           as given                        x,y,z         on the surface\n"
    "  nx,ny,nz      its normal, on the source's side\n"
    "  hx,hy,hz      heading of u there: unit, in the surface\n"
    "\n"
    "Example:\n"
    "  ahm inverse scan.ply --source 17 --at '0.1,0 0.1,0.05' -o points.csv";

struct InverseCommandOptions {
  RunOptions run;
  std::vector<std::array<double, 2>> points;
  double min_quality = trusted_quality;
};

void check_options(const RunOptions& o) {
  check_outputs(o.input, {{"--output", o.output}, {"--json", o.json}});
  if (extension_of(o.output) != ".csv")
    throw InvalidArgument(fmt::format("--output {}: the name must end in .csv", o.output));
}

/// Returns how many of the points the surface has.
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
  io::write(options.run.output, table);
  return found;
}

void run_inverse(const InverseCommandOptions& options) {
  check_options(options.run);
  Journal journal(options.run.verbose);
  const Surface surface = open_surface(options.run, journal);
  const ResolvedSource source = resolve(options.run, *surface.model);
  const LogMapSolver solver = make_solver(options.run, *surface.model, journal);
  const LogMap map = solve(options.run, solver, source.source, journal);

  journal.start("write");
  const std::size_t found = write(options, inverse_of(surface, map, options.min_quality));
  journal.finish();
  journal.clear_display();
  nlohmann::ordered_json j = summary("ahm inverse", options.run, surface);
  j["source"] = {{"spec", to_string(options.run.source)}, {"position", source.position}};
  j["points"] = options.points.size();
  j["found"] = found;
  deliver(std::move(j), fmt::format("{} of {} points lie on the surface\n", found, options.points.size()), options.run,
          journal);
}

}  // namespace

Subcommand add_inverse(CLI::App& program) {
  const auto options = std::make_shared<InverseCommandOptions>();
  InverseCommandOptions& o = *options;
  CLI::App& inverse = *program.add_subcommand("inverse", "Points of a surface at given coordinates, with frames");
  add_input(inverse, o.run.input);
  add_source(inverse, o.run, "Where the map starts, see below")->required();
  add_parsed(inverse, "--at", o.points, parse_plane_points, "POINTS", "Coordinates to look up, see below")->required();
  add_output(inverse, o.run)->required();
  add_min_quality(inverse, o.min_quality);
  add_u_axis(inverse, o.run);
  add_graph_options(inverse, o.run);
  add_json(inverse, o.run);
  add_verbose(inverse, o.run);
  inverse.footer(inverse_footer);
  return {&inverse, [options] { run_inverse(*options); }};
}

}  // namespace ahm::app
