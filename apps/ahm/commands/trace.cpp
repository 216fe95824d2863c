#include <fmt/format.h>

#include <sstream>

#include "ahm/error.hpp"
#include "ahm/util/vec.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/line_finder.hpp"
#include "commands/subcommand.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

constexpr const char* trace_footer =
    "SPEC is 123, x,y,z (the nearest point of the surface) or face:7:0.2,0.3,0.5 as in 'ahm path'. The maps of\n"
    "'ahm logmap' and 'ahm inverse' start at the vertex nearest to x,y,z: to start there, use its number.\n"
    "The line runs straight through faces, and through vertices with equal angles on both sides. Over a cloud it runs\n"
    "from tangent plane to tangent plane. It ends early at a boundary.\n"
    "DIRECTION is a vector X,Y,Z in space, projected to the surface, or an angle in degrees from the u axis of\n"
    "'ahm logmap' at the source, counter-clockwise. A vector must be at least 1 degree from the normal, 5 if normals "
    "are\n"
    "estimated.\n"
    "LINES is a file with one line per row: SPEC DIRECTION, followed by its length L unless --length is set.\n"
    "OUTPUT is .csv, .ply, .obj, ... as in 'ahm path'. With LINES it also has curve, the number of the line, from 0.\n"
    "\n"
    "Example:\n"
    "  ahm trace mesh.ply --source 17 --direction 1,0,0 --length 0.5 -o line.csv --view line.png";

/// A line to trace.
struct LineRequest {
  std::optional<SourceSpec> source;
  Direction direction;
  double length = 0;  ///< 0: that of --length
};

struct TraceCommandOptions {
  InputOptions input;
  OutputOptions output;
  LineRequest line;
  std::vector<LineRequest> lines;  ///< lines of --lines, instead of `line`
};

LineRequest parse_line(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  if (words.size() != 2 && words.size() != 3)
    throw std::invalid_argument(fmt::format("expected SPEC DIRECTION or SPEC DIRECTION L, found '{}'", text));
  return {parse_source(words[0]), parse_vector_or_angle(words[1]), words.size() == 3 ? parse_positive(words[2]) : 0.0};
}

std::vector<LineRequest> read_lines(const std::string& file) {
  require_file(file, "SPEC DIRECTION in each row");
  std::vector<LineRequest> lines;
  for_each_line(file, file, "lines", [&](const std::string& line) { lines.push_back(parse_line(line)); });
  return lines;
}

FoundLine trace(const Input& input, const LineFinder& finder, const SurfacePoint& from, const LineRequest& line,
                const char* option) {
  const Vec3 direction = vector_of(line.direction, input, from, option);
  try {
    return finder.trace(from, direction, line.length);
  } catch (const InvalidArgument& e) {
    if (e.fault() != "axis_along_normal") throw;
    throw InvalidArgument(fmt::format("{} {},{},{}: at the source {} {}", option, direction[0], direction[1],
                                      direction[2], to_string(*line.source), e.problem()));
  }
}

Polylines find_lines(const TraceCommandOptions& options, const LineFinder& finder, const Input& input) {
  Polylines result;
  result.numbered = true;
  double length = 0;
  std::size_t at_boundary = 0;
  for (LineRequest wanted : options.lines) {
    if (wanted.length == 0) wanted.length = options.line.length;
    const SurfacePoint from = point_on_surface(input, *wanted.source, "--lines");
    const FoundLine line = trace(input, finder, from, wanted, "--lines");
    result.add(line.points);
    result.json["lines"].push_back({{"source", to_string(*wanted.source)},
                                    {"end", line.complete ? "length" : "boundary"},
                                    {"position", line.points.back()},
                                    {"points", line.points.size()},
                                    {"length", line.length}});
    length += line.length;
    at_boundary += line.complete ? 0 : 1;
  }
  result.text =
      fmt::format("{} of {}, total length {:.6g}; {} at the boundary\n", counted(options.lines.size(), "line"),
                  counted(result.points.size(), "point"), length, counted(at_boundary, "line", "end"));
  return result;
}

Polylines find_line(const TraceCommandOptions& options, const LineFinder& finder, const Input& input) {
  Polylines result;
  result.from = point_on_surface(input, *options.line.source, "--source");
  const FoundLine line = trace(input, finder, *result.from, options.line, "--direction");
  result.add(line.points);
  const std::vector<Vec3>& points = result.points;
  result.json["source"] = {{"spec", to_string(*options.line.source)}, {"position", points.front()}};
  result.json["end"] = {{"at", line.complete ? "length" : "boundary"}, {"position", points.back()}};
  result.json["points"] = points.size();
  result.json["length"] = line.length;
  result.text = fmt::format("a line of {}, length {:.6g}{}\n", counted(points.size(), "point"), line.length,
                            line.complete ? "" : ", ends at the boundary");
  return result;
}

void run(const TraceCommandOptions& options) {
  const bool is_one = options.lines.empty();
  std::vector<SourceSpec> sources;
  if (is_one) sources.push_back(*options.line.source);
  for (const LineRequest& line : options.lines) sources.push_back(*line.source);
  run_polyline("trace", with_named_points(options.input, sources), options.output, options.line.source,
               [&](const LineFinder& finder, const Input& input, Journal& journal) {
                 comment_on_positions(input, sources, is_one ? "--source" : "--lines", journal);
                 return is_one ? find_line(options, finder, input) : find_lines(options, finder, input);
               });
}

void offer(CLI::App& app, TraceCommandOptions& o) {
  add_input(app, o.input);
  auto* source = add_parsed(
      app, "-s,--source", o.line.source, [](const std::string& text) { return parse_source(text); }, "SPEC",
      "Start of the line, see below");
  auto* direction = add_parsed(app, "--direction", o.line.direction, parse_vector_or_angle, "DIRECTION",
                               "X,Y,Z in space, or degrees from the u axis; see below");
  auto* length =
      add_parsed(app, "--length", o.line.length, parse_positive, "L", "Length of the line, along the surface");
  auto* lines = add_parsed(app, "--lines", o.lines, read_lines, "LINES",
                           "File with many lines, instead of --source and --direction; see below");
  source->excludes(lines);
  direction->excludes(lines);
  app.callback([=, &o] {
    if (lines->count() == 0 && (source->count() == 0 || direction->count() == 0 || length->count() == 0))
      throw CLI::ValidationError("--source", "use --source, --direction and --length, or --lines");
    for (const LineRequest& line : o.lines)
      if (line.length == 0 && length->count() == 0)
        throw CLI::ValidationError("--lines", "some lines have no length; add it to the file, or use --length");
  });
  add_table_output(app, o.output)->required();
  add_threads(app, o.input);
  add_cloud_options(app, o.input);
  add_mesh_options(app, o.input);
  add_map_results(app, o.output);
}

}  // namespace

Subcommand add_trace(CLI::App& program) {
  return subcommand<TraceCommandOptions>(program, "trace", "Straight lines (geodesics) on a surface", trace_footer,
                                         offer, run);
}

}  // namespace ahm::app
