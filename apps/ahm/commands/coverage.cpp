#include "ahm/applications/coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "ahm/maps/quality.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/solve.hpp"
#include "commands/subcommand.hpp"
#include "commands/whole_coverage.hpp"
#include "output/lines.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"
#include "output/wording.hpp"

namespace ahm::app {

namespace {

constexpr const char* coverage_footer =
    "Without --whole, the path is a pattern in the plane of one map around a point. With --whole, the passes have "
    "equal\n"
    "distance along the surface, from the section with a plane through the center along the longest direction, or "
    "from\n"
    "another seed. They are joined by links on the surface or above it.\n"
    "\n"
    "SPEC is 123, x,y,z (the nearest vertex) or face:7:0.2,0.3,0.5 as in 'ahm logmap'.\n"
    "OUTPUT is .csv, .jsonl, or .ply and .vtp with edges between consecutive points; one row per point, in order\n"
    "along the path:\n"
    "  index      number of the point, from 0 (.csv, .jsonl)\n"
    "  piece      number of the connected piece, from 0; the tool lifts between pieces\n"
    "  line       number of the raster line, from 0\n"
    "  x,y,z      position on the surface\n"
    "  nx,ny,nz   unit normal of the surface\n"
    "  hx,hy,hz   unit direction of travel, tangential to the surface\n"
    "  u,v        coordinates in the map\n"
    "  arclength  length of the path from the start of the piece\n"
    "  spacing    distance in space to the next line\n"
    "  between    1: added where the path bends between faces; not a point of the pattern\n"
    "With --whole, one row per pose: index, pass (number of the pass; on links that of the next one), kind (pass, "
    "link,\n"
    "approach, retreat, missing: no link leads there; in .ply and .vtp 0 to 4), x,y,z, nx,ny,nz (tool axis), hx,hy,hz "
    "(direction of travel), "
    "qw,qx,qy,qz\n"
    "(quaternion that takes z to the axis and x to the travel), arclength (from the first pose, without missing "
    "links); with --offset "
    "cx,cy,cz "
    "(the\n"
    "point of the surface), with --feed time (seconds, also for lifted motions). OUTPUT can also be:\n"
    "  .obj   a line per pass and per link, in the groups pass, link, approach and retreat\n"
    "  .json  an object per pass and per link, with the poses, also as 4 x 4 matrices\n"
    "  .ngc   G-code, RS-274/NGC as LinuxCNC reads it: lifted motions are G0, all others G1. With --axes 5 the tool "
    "axis is\n"
    "         (sin A sin C, sin A cos C, cos A), and X Y Z is the tool center point, as in LinuxCNC's xyzac-trt\n"
    "  .yaml  a message of ROS 1 for 'rostopic pub -f'\n"
    "With --rows FILE, one row per row of INPUT: x,y,z and status (in .ply a number from 0):\n"
    "  covered         within 0.6 S of a pass, along the surface\n"
    "  gap             farther from the passes\n"
    "  no_pass         in a component that the seed does not reach, or that is too small for a pass\n"
    "  outside_region  in no triangle of the region\n"
    "  no_triangle     an isolated point of a cloud\n"
    "  removed         removed before the map, for example an outlier, or a vertex that no face uses\n"
    "\n"
    "Examples:\n"
    "  ahm coverage scan.ply --source 0.1,0.2,1.4 --radius 0.2 --spacing 0.01 -o path.csv\n"
    "  ahm coverage part.stl --source 17 --radius 30 --spacing 2 --pattern spiral -o path.ply\n"
    "  ahm coverage part.obj --whole --spacing 2 -o path.csv\n"
    "  ahm coverage dome.obj --whole --spacing 2 --seed-boundary --pattern spiral -o path.csv\n"
    "  ahm coverage part.obj --whole --spacing 2 --facing 0,0,1 --max-angle 60 -o path.vtp --json path.json\n"
    "  ahm coverage part.obj --whole --spacing 2 --axes 5 --lead 10 --feed 800 -o path.ngc";

struct CoverageCommandOptions {
  InputOptions input;
  SourceOptions source;
  SolveOptions solve;
  OutputOptions output;
  CoverageOptions path;
  WholeOptions whole;
  bool has_source = false;
  double min_quality = reliable_quality;
};

/// Writes a picture of the path on the map.
void write_view(render::Scene scene, const CoveragePath& path, Results& results, Journal& journal) {
  std::vector<Vec3> curve;
  std::vector<Index> pieces;
  for (const CoveragePoint& point : path.points) {
    if (!curve.empty() && point.piece != path.points[curve.size() - 1].piece)
      pieces.push_back(static_cast<Index>(curve.size()));
    curve.push_back(point.position);
  }
  scene.curve = curve;
  scene.curve_pieces = pieces;
  results.write_view(scene, journal);
}

/// Quality of the rows within the radius; NaN elsewhere.
std::vector<double> quality_within(double radius, const RowLogMap& rows, std::vector<double> quality) {
  for (std::size_t r = 0; r < quality.size(); ++r)
    if (!(rows.distance[r] <= radius)) quality[r] = NAN;
  return quality;
}

/// Whether the map of a vertex and its neighbors has at least half of their area. Behind a corner where geodesic paths bend, exact
/// maps collapse the surface to a line, which the pattern does not cover.
bool has_area(const TangentGraph& graph, const LogMap& map, Index vertex) {
  struct Moments {
    double xx = 0, xy = 0, yy = 0;
    void add(double x, double y) { xx += x * x, xy += x * y, yy += y * y; }
    double determinant() const { return xx * yy - xy * xy; }
  } of_map, of_edges;
  const Star star = graph.star(vertex);
  const auto phi = map.coordinates(Vertex(vertex));
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const auto there = map.coordinates(Vertex(star.neighbors[e]));
    if (std::isnan(there[0])) continue;
    of_map.add((there[0] - phi[0]) / graph.length_unit(), (there[1] - phi[1]) / graph.length_unit());
    of_edges.add(star.log(e)[0], star.log(e)[1]);
  }
  return of_map.determinant() >= 0.25 * of_edges.determinant();
}

/// Share of the area within the radius whose vertices have at least the smallest allowed quality.
double reliable_share(const TangentGraph& graph, const LogMap& map, const std::vector<double>& quality,
                      const CoverageCommandOptions& options) {
  double all = 0, reliable = 0;
  for (Index i = 0; i < graph.size(); ++i) {
    if (!(map.distance(Vertex(i)) <= options.path.radius)) continue;
    all += graph.mass(i);
    if (quality[i] >= options.min_quality && (map.method() == Method::heat || has_area(graph, map, i)))
      reliable += graph.mass(i);
  }
  return reliable / all;
}

/// Figures of the report.
struct Summary {
  double length = 0;
  double covered = 0;                        ///< share of the pattern's points that are on the surface
  double spacing_low = 0, spacing_high = 0;  ///< 5th and 95th percentile of the distance between lines in space

  explicit Summary(const CoveragePath& path) {
    std::vector<double> spacings;
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      if (!std::isnan(path.points[i].spacing)) spacings.push_back(path.points[i].spacing);
      if (i + 1 == path.points.size() || path.points[i + 1].piece != path.points[i].piece)
        length += path.points[i].arclength;
    }
    const auto carried = std::ranges::count(path.points, false, &CoveragePoint::between);
    covered = static_cast<double>(carried) / static_cast<double>(path.planned);
    if (spacings.empty()) return;
    std::sort(spacings.begin(), spacings.end());
    spacing_low = spacings[spacings.size() / 20];
    spacing_high = spacings[spacings.size() - 1 - spacings.size() / 20];
  }
};

void report(const CoverageCommandOptions& options, const Input& input, const SurfaceSource& source,
            const CoveragePath& path, double reliable, const Summary& amount, Journal& journal) {
  const std::string pattern = options.path.pattern == CoveragePattern::raster ? "raster" : "spiral";
  nlohmann::ordered_json j = summary("ahm coverage", options.input.path, options.output, input);
  j["source"] = {{"spec", to_string(options.source.spec)}, {"position", source.position}};
  j["pattern"] = pattern;
  j["radius"] = options.path.radius;
  j["spacing"] = options.path.spacing;
  j["points"] = path.points.size();
  j["pieces"] = path.pieces;
  j["length"] = amount.length;
  j["covered"] = amount.covered;
  j["reliable_area"] = reliable;
  j["spacing_in_space"] = {{"percentile_5", amount.spacing_low}, {"percentile_95", amount.spacing_high}};
  deliver(j,
          fmt::format("{}: {} in {}, {:.4g} long, lines {:.4g} to {:.4g} apart in space\n"
                      "on the surface: {:.1f} % of the pattern; reliable: {:.1f} % of the area within the radius\n",
                      pattern, counted(path.points.size(), "point"), counted(path.pieces, "piece"), amount.length,
                      amount.spacing_low, amount.spacing_high, 100 * amount.covered, 100 * reliable),
          options.output, journal);
}

void run(const CoverageCommandOptions& options) {
  if (options.whole.whole) {
    WholeOptions whole = options.whole;
    whole.path.spacing = options.path.spacing;
    whole.path.step = options.path.step;
    whole.path.spiral = options.path.pattern == CoveragePattern::spiral;
    return run_whole(options.input, options.output, whole,
                     options.has_source ? std::optional(options.source.spec) : std::nullopt, options.path.radius);
  }
  check_results(options.input.path, options.output, {".csv", ".jsonl", ".ply", ".vtp"});
  Journal journal(options.output.verbosity);
  const Input input = open_around(options.input, options.path.radius, journal, options.source.spec);
  const SurfaceSource source = resolve(options.source, input, options.input.threads);
  comment_on_positions(input, std::span(&options.source.spec, 1), "--source", journal);
  const LogMap map = solve(options.solve, input, options.source.spec, source, journal);

  journal.start("path");
  const std::vector<double> quality = map_quality(input.graph(), map, options.solve.threads);
  const InverseMap inverse =
      inverse_map(input.surface(), map, {.min_quality = options.min_quality, .quality = quality});
  const CoveragePath path = coverage_path(input.surface(), inverse, options.path);
  if (path.points.empty())
    throw InvalidArgument(fmt::format(
        "--source {}: no line of the pattern reaches a reliable part of the map within radius {}; choose another "
        "source, or lower --spacing or --min-quality",
        to_string(options.source.spec), options.path.radius));
  if (!path.straight_reason.empty())
    journal.add_warning(
        fmt::format("the points of the path are joined by straight lines in space instead of shortest paths: {}",
                    path.straight_reason));
  const Summary amount(path);
  if (amount.spacing_high > 1.25 * options.path.spacing)
    journal.add_warning(
        fmt::format("neighboring lines are up to {:.4g} apart in space, more than --spacing {}: the surface is "
                    "saddle-shaped or rough",
                    amount.spacing_high, options.path.spacing));

  if (options.path.radius < input.mean_edge_length())
    journal.add_warning(fmt::format(
        "--radius {}: smaller than the mean edge length, {:.4g}; the path lies between the source and its neighbors",
        options.path.radius, input.mean_edge_length()));

  const RowLogMap rows = input.surface().to_rows(map);
  const std::vector<double> row_quality = to_rows(rows, quality);
  comment_on_quality(quality_within(options.path.radius, rows, row_quality), "lower --radius, or choose another source",
                     journal);

  Results results(options.output, input, options.input);
  write_view(results.scene(rows, row_quality, source), path, results, journal);
  journal.start("write");
  write_coverage(options.output.output, options.output.format, path);
  report(options, input, source, path, reliable_share(input.graph(), map, quality, options), amount, journal);
}

void offer(CLI::App& app, CoverageCommandOptions& o) {
  add_input(app, o.input);
  auto* source = add_source(app, o.source, "Center of the covered disc, see below");
  auto* radius =
      add_parsed(app, "--radius", o.path.radius, parse_positive, "R", "Radius of the covered disc, along the surface");
  add_parsed(app, "--spacing", o.path.spacing, parse_positive, "S", "Distance between neighboring lines or turns")
      ->required();
  add_table_output(app, o.output, {".obj", ".json", ".ngc", ".yaml"})->required();
  add_parsed(app, "--pattern", o.path.pattern,
             choice_of<CoveragePattern>({{"raster", CoveragePattern::raster}, {"spiral", CoveragePattern::spiral}}),
             "NAME", "raster (default) or spiral. With --whole, spiral joins closed passes");
  add_parsed(app, "--angle", o.path.angle, parse_degrees, "DEG",
             "Angle from the u axis to the lines, in degrees (default 0)");
  add_parsed(app, "--step", o.path.step, parse_positive, "L", "Distance between points of the path (default: S / 2)");
  add_min_quality(app, o.min_quality);
  add_u_axis(app, o.source);
  add_method(app, o.solve);
  add_graph_options(app, o.input, o.solve);
  add_local(app, o.input, "Up to --radius");
  add_map_results(app, o.output);
  offer_whole(app, o.whole);
  app.callback([=, &app, &o] {
    o.has_source = source->count() > 0;
    for (const char* name : {"--angle", "--u-axis", "--min-quality", "--method", "--variant", "--t-coef"})
      if (o.whole.whole && app.get_option(name)->count() > 0) throw CLI::ExcludesError(name, "--whole");
    if (!o.whole.whole && source->count() == 0) throw CLI::RequiredError("--source");
    if ((!o.whole.whole || o.has_source) && radius->count() == 0) throw CLI::RequiredError("--radius");
    if (o.whole.whole && !o.has_source && radius->count() > 0) throw CLI::RequiredError("--source");
  });
}

}  // namespace

Subcommand add_coverage(CLI::App& program) {
  return subcommand<CoverageCommandOptions>(program, "coverage",
                                            "Tool path that covers the surface around a point, with normals",
                                            coverage_footer, offer, run);
}

}  // namespace ahm::app
