#include "ahm/applications/isolines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ahm/error.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/line_finder.hpp"
#include "commands/solve.hpp"
#include "commands/subcommand.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

constexpr const char* isolines_footer =
    "NAME is a column of numbers in INPUT, or x, y or z. With --source the function is the distance from SPEC:\n"
    "123, x,y,z (the nearest vertex) or face:7:0.2,0.3,0.5 as in 'ahm logmap'.\n"
    "LEVELS is a list of numbers separated by commas: 0.1,0.2.\n"
    "\n"
    "The function is linear in every triangle. Lines end at the boundary, and where the function is nan.\n"
    "\n"
    "OUTPUT  .csv, .jsonl, .ply and .vtp with edges, or .obj with lines. One row per point on an edge of the mesh:\n"
    "  index      number of the point, from 0 (.csv, .jsonl)\n"
    "  curve      number of the line, from 0; a closed line ends at its first point\n"
    "  level      value of the function on the line\n"
    "  x,y,z      position on the surface\n"
    "  arclength  length of the line from its first point\n"
    "\n"
    "Examples:\n"
    "  ahm isolines part.stl --column z --every 0.5 -o contours.obj\n"
    "  ahm isolines map.ply --column quality --levels 0.5 -o reliable.csv\n"
    "  ahm isolines scan.ply --source 17 --every 10 -o rings.vtp --view rings.png";

struct IsolinesOptions {
  InputOptions input;
  SourceOptions source;
  bool of_distance = false;
  SolveOptions solve;
  OutputOptions output;
  std::string column;
  std::vector<double> levels;
  double every = 0;
};

/// The function, and the distances for the picture.
std::vector<double> values_of(const IsolinesOptions& options, const Input& input, Journal& journal) {
  if (!options.of_distance) return column_of(input.geometry, options.column, "--column");
  const SurfaceSource source = resolve(options.source, input, options.input.threads);
  comment_on_positions(input, std::span(&options.source.spec, 1), "--source", journal);
  journal.start("distance");
  return input.surface().to_rows(solve(options.solve, input, options.source.spec, source, journal)).distance;
}

void write_view(const IsolinesOptions& options, const Input& input, const Polylines& lines, Journal& journal) {
  if (options.output.view.empty()) return;
  Results results(options.output, input, options.input);
  render::Scene scene = results.scene();
  render::PictureOptions picture;
  picture.pattern = render::Pattern::none;
  std::vector<Index> pieces;
  for (const Index b : lines.begin)
    if (b > 0) pieces.push_back(b);
  scene.curve = lines.points;
  scene.curve_pieces = pieces;
  scene.source = lines.points.front();
  results.write_view(scene, journal, picture);
}

void run(const IsolinesOptions& options) {
  check_results(options.input.path, options.output, {".csv", ".jsonl", ".ply", ".vtp", ".obj"});
  Journal journal(options.output.verbosity);
  const Input input =
      open_input(options.input, journal, options.of_distance ? std::optional(options.source.spec) : std::nullopt);
  const std::vector<double> values = values_of(options, input, journal);
  if (std::ranges::none_of(values, [](double value) { return std::isfinite(value); }))
    throw InvalidArgument(fmt::format("--column {}: no value is finite", options.column));
  journal.start("isolines");
  const std::vector<double> levels = options.levels.empty() ? level_multiples(values, options.every) : options.levels;
  const std::vector<Isoline> found = isolines(input.surface(), values, levels);
  const auto [low, high] = std::ranges::minmax(values, {}, [](double v) { return std::isnan(v) ? 0 : v; });
  if (found.empty())
    throw InvalidArgument(
        fmt::format("{}: no triangle contains a level; the values lie between {:.6g} and {:.6g}",
                    options.levels.empty() ? fmt::format("--every {:.6g}", options.every) : "--levels", low, high));

  const Polylines lines = polylines_of(found);
  double length = 0;
  for (const Isoline& line : found) length += line.length;
  const auto closed = static_cast<std::size_t>(std::ranges::count(found, true, &Isoline::closed));
  write_view(options, input, lines, journal);
  journal.start("write");
  write_polylines(options.output.output, options.output.format, lines);
  nlohmann::ordered_json j = summary("ahm isolines", options.input.path, options.output, input);
  if (!options.of_distance) j["column"] = options.column;
  if (options.of_distance) j["source"] = to_string(options.source.spec);
  j["levels"] = levels;
  j["lines"] = found.size();
  j["closed"] = closed;
  j["points"] = lines.points.size();
  j["length"] = length;
  deliver(std::move(j),
          fmt::format("{} of {}, {} closed, total length {:.6g}\n", counted(found.size(), "line"),
                      counted(levels.size(), "level"), closed, length),
          options.output, journal);
}

void offer(CLI::App& app, IsolinesOptions& o) {
  add_input(app, o.input);
  auto* column = add_parsed(app, "--column", o.column, non_empty, "NAME", "Column of INPUT, see below");
  auto* source = add_source(app, o.source, "Lines of equal distance from SPEC, see below")->excludes(column);
  auto* levels =
      add_parsed(app, "--levels", o.levels, parse_numbers, "LEVELS", "Values of the function on the lines, see below");
  auto* every =
      add_parsed(app, "--every", o.every, parse_positive, "STEP", "All multiples of STEP as levels")->excludes(levels);
  app.callback([=, &o] {
    if (column->count() == 0 && source->count() == 0)
      throw CLI::ValidationError("--column", "use --column or --source");
    if (levels->count() == 0 && every->count() == 0) throw CLI::ValidationError("--levels", "use --levels or --every");
    o.of_distance = source->count() > 0;
  });
  add_table_output(app, o.output)->required();
  add_method(app, o.solve, {Method::polar, Method::exact}, true);
  add_graph_and_results(app, o.input, o.solve, o.output);
}

}  // namespace

Subcommand add_isolines(CLI::App& program) {
  return subcommand<IsolinesOptions>(program, "isolines", "Curves on a surface where a column has given values",
                                     isolines_footer, offer, run);
}

}  // namespace ahm::app
