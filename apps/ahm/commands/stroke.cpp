#include "ahm/applications/stroke.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "ahm/error.hpp"
#include "ahm/maps/quality.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/solve.hpp"
#include "commands/subcommand.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

constexpr const char* stroke_footer =
    "CURVE is a list separated by blanks, or a file with one entry per line. An entry is one of\n"
    "  123                 a vertex of INPUT, counted from 0\n"
    "  1.5,0,-2            the nearest point of the surface; in files also 1.5 0 -2\n"
    "  face:7:0.2,0.3,0.5  a point in face 7 in barycentric coordinates, one per corner (meshes)\n"
    "Shortest paths join the points, over the faces of meshes or the tangent planes of clouds. The curve is cut into\n"
    "pieces of half an edge.\n"
    "\n"
    "OUTPUT  .csv, .jsonl, .ply, .pcd or .vtp; one row per vertex of INPUT, in the same order:\n"
    "          index,x,y,z,u,v,distance,status,quality,spread\n"
    "          u         arclength along the curve; beyond its ends along straight extensions\n"
    "          v         signed distance from the curve, positive on its left as seen from the side of the normals\n"
    "          distance  distance from the curve along the surface\n"
    "          quality   reliability of u,v in (0, 1]; do not use u,v below 0.5: several parts of the curve are\n"
    "                    equally near, or the mesh is too coarse for its bends\n"
    "          spread    uncertainty of u,v as a length: the standard deviation over the paths of the heat\n"
    "        With --circle the map takes the curve to a circle of the same length about the origin.\n"
    "        With --positions it takes the points of the curve to POINTS, a list 'u,v u,v ...' or a file with one\n"
    "        pair per line.\n"
    "\n"
    "Examples:\n"
    "  ahm stroke scan.ply --curve '0,0,1.2 0.3,0,1.1 0.5,0.2,1' -o stroke.csv --view stroke.png\n"
    "  ahm stroke part.stl --curve seam.xyz --closed -o stroke.ply";

struct StrokeCommandOptions {
  InputOptions input;
  SolveOptions solve;
  OutputOptions output;
  std::vector<SourceSpec> curve;
  StrokeOptions shape;
  std::vector<std::array<double, 2>> positions;  ///< (u, v) of each point of the curve; empty: by arclength
};

CurvePoint curve_point(const Input& input, const SourceSpec& spec) {
  if (const auto* position = std::get_if<SourcePosition>(&spec)) return position->position;
  return point_of(input, spec);
}

SurfaceCurve draw_curve(const Input& input, const StrokeCommandOptions& options) {
  std::vector<CurvePoint> points;
  for (const SourceSpec& spec : options.curve) {
    position_of(input, spec, "--curve");
    points.push_back(curve_point(input, spec));
  }
  try {
    if (!options.positions.empty())
      return ahm::draw_curve(input.surface(), points, options.positions, options.shape.closed);
    return ahm::draw_curve(input.surface(), points, options.shape);
  } catch (const InvalidArgument& e) {
    throw InvalidArgument(fmt::format("--curve: {}", worded(e)));
  }
}

LogMap solve(const SolveOptions& options, const Input& input, const SurfaceCurve& curve, Journal& journal) {
  const Maps maps(options, input, journal, 1);
  if (maps.solver) return ahm::app::solve(options, *maps.solver, curve.source, journal);
  journal.start("solve");
  ExactMapOptions exact = exact_options(options, journal);
  exact.frames = false;
  return maps.geodesics->log_map(curve.samples, exact).map;
}

void comment_on_curve(const SurfaceCurve& curve, double edge, Journal& journal) {
  if (curve.straight > 0)
    journal.add_warning(
        fmt::format("--curve: {} between its points {} straight in space and projected to the surface instead of a "
                    "shortest path: {}",
                    counted(curve.straight, "line"), curve.straight == 1 ? "is" : "are", curve.straight_reason));
  if (curve.gap > 2 * edge)
    journal.add_warning(fmt::format(
        "--curve: the straight lines between its points are up to {:.4g} ({:.0f} mean edge lengths) off the surface; "
        "add points",
        curve.gap, curve.gap / edge));
  if (curve.jump > 3 * edge)
    journal.add_warning(fmt::format(
        "--curve: jumps by up to {:.4g} ({:.0f} mean edge lengths) along the surface; add points, close to the surface",
        curve.jump, curve.jump / edge));
}

void write_results(const SurfaceCurve& curve, const StrokeOptions& shape, const RowLogMap& rows,
                   const std::vector<double>& quality, Results& results, Journal& journal) {
  io::Table table = results.table();
  add_map(table, rows, quality);
  std::vector<Vec3> line = curve.points;
  if (shape.closed) line.push_back(line.front());
  render::Scene scene = results.scene();
  scene.u = rows.u;
  scene.v = rows.v;
  scene.distance = rows.distance;
  scene.quality = quality;
  scene.details = {rows.distance, rows.spread, rows.status, {}};
  scene.curve = line;
  scene.source = line.front();
  if (curve.first) scene.source_axes = {curve.first->x, curve.first->y, curve.first->normal};
  render::PictureOptions picture;
  if (shape.shape == StrokeShape::line) picture.pattern = render::Pattern::grid;
  results.write(table, scene, journal, picture);
}

void report(const StrokeCommandOptions& options, const Input& input, const SurfaceCurve& curve, const RowLogMap& rows,
            const std::vector<double>& quality, Journal& journal) {
  const auto mapped = std::count(rows.status.begin(), rows.status.end(), Status::ok);
  double farthest = 0;
  for (double d : rows.distance) farthest = std::max(farthest, std::isnan(d) ? 0 : d);
  nlohmann::ordered_json j = summary("ahm stroke", options.input.path, options.output, input);
  j["curve"] = {{"given", options.curve.size()},
                {"pieces", curve.samples.size()},
                {"length", curve.length},
                {"closed", options.shape.closed},
                {"shape", !options.positions.empty()                   ? "positions"
                          : options.shape.shape == StrokeShape::circle ? "circle"
                                                                       : "line"},
                {"largest_gap", curve.gap},
                {"straight_lines", curve.straight}};
  if (curve.straight > 0) j["curve"]["straight_reason"] = curve.straight_reason;
  j["n"] = rows.status.size();
  j["mapped"] = mapped;
  j["largest_distance"] = farthest;
  const std::optional<double> reliable = reliable_distance(rows.distance, quality);
  add_quality(j, quality, reliable);
  const std::string text = fmt::format(
      "{} curve of {}, length {:.6g}, at most {:.2g} off the surface\n"
      "vertices mapped: {} of {}, up to {:.6g} from the curve\n{}\n",
      options.shape.closed ? "closed" : "open", counted(curve.samples.size(), "piece"), curve.length, curve.gap, mapped,
      rows.status.size(), farthest, quality_as_text(rows.distance, quality, reliable));
  deliver(std::move(j), text, options.output, journal);
}

void run(const StrokeCommandOptions& options) {
  check_results(options.input.path, options.output);
  Journal journal(options.output.verbosity);
  const Input input = open_input(with_named_points(options.input, options.curve), journal);
  const SurfaceCurve curve = draw_curve(input, options);
  comment_on_curve(curve, input.mean_edge_length(), journal);

  const double radius = options.solve.radius.value_or(std::numeric_limits<double>::infinity());
  SolveOptions reaching = options.solve;
  if (reaching.radius) reaching.radius = map_radius_of_curve(curve, radius);
  const LogMap map = solve(reaching, input, curve, journal);
  const RowLogMap rows = rows_from_curve(input.surface(), map, curve, radius);
  comment_on_statuses(rows.status, options.input.path, journal);
  const std::vector<double> quality = to_rows(rows, map_quality(input.graph(), map, options.solve.threads));
  comment_on_quality(quality, "limit the map with --radius", journal);
  Results results(options.output, input, options.input);
  write_results(curve, options.shape, rows, quality, results, journal);
  report(options, input, curve, rows, quality, journal);
}

void offer(CLI::App& app, StrokeCommandOptions& o) {
  add_input(app, o.input);
  add_parsed(app, "--curve", o.curve, parse_sources, "CURVE", "Points of the curve: list or file, see below")
      ->required();
  add_table_output(app, o.output)->required();
  app.add_flag("--closed", o.shape.closed, "Close the curve: join the last point to the first");
  auto* circle = app.add_flag_callback(
      "--circle", [&o] { o.shape.closed = true, o.shape.shape = StrokeShape::circle; },
      "Close the curve, and map it to a circle instead of a line");
  add_parsed(app, "--positions", o.positions, parse_plane_points, "POINTS",
             "Coordinates u,v of the points of CURVE, one pair per point, see below")
      ->excludes(circle);
  app.callback([&o] {
    if (!o.positions.empty() && o.positions.size() != o.curve.size())
      throw CLI::ValidationError("--positions", fmt::format("expected one pair per point of --curve, found {} for {}",
                                                            o.positions.size(), o.curve.size()));
  });
  add_parsed(app, "--radius", o.solve.radius, parse_positive, "R",
             "Map only points within this distance of the curve; smaller is faster");
  add_method(app, o.solve, {Method::exact});
  add_graph_and_results(app, o.input, o.solve, o.output);
}

}  // namespace

Subcommand add_stroke(CLI::App& program) {
  return subcommand<StrokeCommandOptions>(program, "stroke", "Coordinates along and across a curve on a surface",
                                          stroke_footer, offer, run);
}

}  // namespace ahm::app
