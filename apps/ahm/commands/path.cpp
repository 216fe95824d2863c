#include <fmt/format.h>

#include <array>
#include <numeric>
#include <sstream>

#include "ahm/error.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/line_finder.hpp"
#include "commands/subcommand.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

constexpr const char* path_footer =
    "POINTS is a list 'SPEC SPEC ...' or a file with one SPEC per line; SPEC is one of\n"
    "  123                 a vertex of INPUT, counted from 0\n"
    "  1.5,0,-2            the nearest point of the surface; in files also 1.5 0 -2\n"
    "  face:7:0.2,0.3,0.5  a point in face 7 in barycentric coordinates, one per corner\n"
    "PAIRS is a file with two SPECs per line, one path per line. All paths from the same start share one map.\n"
    "\n"
    "On a mesh the path is the shortest over the flat faces, exact up to rounding. On a cloud it crosses the tangent\n"
    "planes of the points; the error of its length is of second order in the spacing.\n"
    "With --fast the path is locally shortest: no nearby curve is shorter, but a path around the other side of a hill\n"
    "may be.\n"
    "With --tighten the loop moves away from its points and becomes a closed geodesic, which is locally shortest.\n"
    "\n"
    "OUTPUT  .csv, .jsonl, .ply and .vtp with edges, or .obj with lines. One row per point where the path starts,\n"
    "        crosses an edge, bends or ends: index (.csv, .jsonl), x,y,z and arclength (not in .obj). With PAIRS also\n"
    "        curve, the number of the pair, from 0\n"
    "\n"
    "Examples:\n"
    "  ahm path mesh.ply --from 17 --to 4711 -o path.csv --json -\n"
    "  ahm path mesh.obj --from 0.1,0.2,1.4 --through '33 face:7:0.2,0.3,0.5' --to 90 --closed -o loop.obj --view "
    "loop.png\n"
    "  ahm path scan.ply --pairs pairs.txt -o paths.ply";

struct PathCommandOptions {
  InputOptions input;
  OutputOptions output;
  std::optional<SourceSpec> from;
  std::vector<SourceSpec> through, to;
  std::vector<std::array<SourceSpec, 2>> pairs;
  bool closed = false, tighten = false, fast = false;
};

/// Reads two SPECs or six numbers from a line.
std::array<SourceSpec, 2> parse_pair(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  if (words.size() == 6)
    return {parse_source(words[0] + "," + words[1] + "," + words[2]),
            parse_source(words[3] + "," + words[4] + "," + words[5])};
  if (words.size() != 2)
    throw std::invalid_argument(fmt::format("expected two SPECs or six numbers, found '{}'", line));
  return {parse_source(words[0]), parse_source(words[1])};
}

std::vector<std::array<SourceSpec, 2>> read_pairs(const std::string& file) {
  require_file(file, "two SPECs per line");
  std::vector<std::array<SourceSpec, 2>> pairs;
  for_each_line(file, file, "pairs", [&](const std::string& line) { pairs.push_back(parse_pair(line)); });
  return pairs;
}

/// The points of --from, --through and --to in this order.
std::vector<SourceSpec> stops_of(const PathCommandOptions& options) {
  std::vector<SourceSpec> specs{*options.from};
  for (const auto& more : {options.through, options.to}) specs.insert(specs.end(), more.begin(), more.end());
  return specs;
}

/// All points in the command line.
std::vector<SourceSpec> named_points(const PathCommandOptions& options) {
  if (options.pairs.empty()) return stops_of(options);
  std::vector<SourceSpec> specs;
  for (const auto& pair : options.pairs) specs.insert(specs.end(), pair.begin(), pair.end());
  return specs;
}

/// Adds the paths from stop to stop as one curve.
void add_path_through(const PathCommandOptions& options, const std::vector<SurfacePoint>& stops,
                      const std::vector<SourceSpec>& specs, const LineFinder& finder, Polylines& path) {
  std::vector<double> lengths;
  FoundLine curve;
  for (std::size_t k = 1; k < stops.size(); ++k) {
    const FoundLine leg = finder.path(stops[k - 1], stops[k], options.fast);
    if (leg.status != Status::ok)
      throw InvalidArgument(
          fmt::format("there is no path from {} to {}: they lie on different components of the surface",
                      to_string(specs[k - 1]), to_string(specs[k])));
    const std::size_t first = k > 1 ? 1 : 0;
    curve.points.insert(curve.points.end(), leg.points.begin() + first, leg.points.end());
    if (finder.has_faces()) curve.flat.insert(curve.flat.end(), leg.flat.begin() + first, leg.flat.end());
    lengths.push_back(leg.length);
  }
  double length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  if (options.tighten) {
    curve = finder.tightened(curve.flat);
    if (!(curve.length > 0))
      throw InvalidArgument("--tighten: the loop does not enclose a hole or handle and shrinks to a point");
    path.json["length_through_stops"] = length;
    length = curve.length;
  }
  path.add(curve.points);
  path.text = fmt::format("a {} of {}, length {:.6g}\n", options.tighten ? "closed geodesic" : "path",
                          counted(path.points.size(), "point"), length);
  path.json["points"] = path.points.size();
  path.json["length"] = length;
  if (!options.tighten) path.json["lengths"] = lengths;
}

Polylines find_path(const PathCommandOptions& options, const LineFinder& finder, const Input& input, Journal& journal) {
  std::vector<SourceSpec> specs = stops_of(options);
  comment_on_positions(input, std::span(&*options.from, 1), "--from", journal);
  comment_on_positions(input, options.through, "--through", journal);
  comment_on_positions(input, options.to, "--to", journal);
  std::vector<SurfacePoint> stops;
  for (std::size_t k = 0; k < specs.size(); ++k)
    stops.push_back(point_on_surface(input, specs[k],
                                     k == 0                        ? "--from"
                                     : k <= options.through.size() ? "--through"
                                                                   : "--to"));
  if (options.closed) stops.push_back(stops.front()), specs.push_back(specs.front());
  Polylines path;
  if (!options.fast) path.from = stops.front();
  for (const SourceSpec& spec : specs) path.json["stops"].push_back(to_string(spec));
  path.json["closed"] = options.closed;
  path.json["fast"] = options.fast;
  add_path_through(options, stops, specs, finder, path);
  return path;
}

Polylines find_pairs(const PathCommandOptions& options, const LineFinder& finder, const Input& input,
                     Journal& journal) {
  std::vector<std::array<SurfacePoint, 2>> ends;
  comment_on_positions(input, named_points(options), "--pairs", journal);
  for (const auto& [from, to] : options.pairs)
    ends.push_back({point_on_surface(input, from, "--pairs"), point_on_surface(input, to, "--pairs")});
  const std::vector<FoundLine> paths = finder.paths(ends, options.fast, journal.progress(), options.input.threads);
  Polylines result;
  result.numbered = true;
  result.json["fast"] = options.fast;
  double length = 0;
  std::size_t found = 0;
  for (std::size_t k = 0; k < paths.size(); ++k) {
    const FoundLine& path = paths[k];
    const bool ok = path.status == Status::ok;
    result.add(path.points);
    result.json["paths"].push_back({{"from", to_string(options.pairs[k][0])},
                                    {"to", to_string(options.pairs[k][1])},
                                    {"status", to_string(path.status)},
                                    {"points", path.points.size()},
                                    {"length", ok ? nlohmann::ordered_json(path.length) : nlohmann::ordered_json()}});
    if (ok) ++found, length += path.length;
  }
  if (found < paths.size())
    journal.add_warning(fmt::format("pairs without a path, on different components of the surface: {} of {}",
                                    paths.size() - found, paths.size()));
  result.text = fmt::format("{} of {}, total length {:.6g}\n", counted(found, "path"),
                            counted(result.points.size(), "point"), length);
  return result;
}

void run(const PathCommandOptions& options) {
  run_polyline(
      "path", with_named_points(options.input, named_points(options)), options.output, {},
      [&](const LineFinder& finder, const Input& input, Journal& journal) {
        if (!finder.has_faces() && (options.fast || options.tighten))
          throw InvalidArgument(fmt::format("{}: requires faces; the input has none, or --backend ignores them",
                                            options.fast ? "--fast" : "--tighten"));
        return options.pairs.empty() ? find_path(options, finder, input, journal)
                                     : find_pairs(options, finder, input, journal);
      });
}

void offer(CLI::App& app, PathCommandOptions& o) {
  add_input(app, o.input);
  auto* from = add_parsed(
      app, "--from", o.from, [](const std::string& text) { return parse_source(text); }, "SPEC",
      "Start of the path, see below");
  auto* to = add_parsed(app, "--to", o.to, parse_sources, "POINTS",
                        "End of the path, or several points that it passes in this order");
  auto* through =
      add_parsed(app, "--through", o.through, parse_sources, "POINTS", "Points that the path passes before --to")
          ->needs(to);
  auto* pairs = add_parsed(app, "--pairs", o.pairs, read_pairs, "PAIRS",
                           "File with one path per line, instead of --from and --to");
  add_table_output(app, o.output)->required();
  auto* closed = app.add_flag("--closed", o.closed, "Close the path: return to its start")->excludes(pairs);
  app.add_flag("--tighten", o.tighten, "With --closed: shorten the loop to a closed geodesic, away from its points")
      ->needs(closed);
  app.add_flag("--fast", o.fast, "Locally shortest paths; fast on meshes of any size");
  for (auto* option : {from, to, through}) option->excludes(pairs);
  app.callback([=] {
    if (pairs->count() == 0 && (from->count() == 0 || to->count() == 0))
      throw CLI::ValidationError("--from", "use --from and --to, or --pairs");
  });
  add_threads(app, o.input);
  add_cloud_options(app, o.input);
  add_mesh_options(app, o.input);
  add_map_results(app, o.output);
}

}  // namespace

Subcommand add_path(CLI::App& program) {
  return subcommand<PathCommandOptions>(program, "path", "Shortest paths on a surface", path_footer, offer, run);
}

}  // namespace ahm::app
