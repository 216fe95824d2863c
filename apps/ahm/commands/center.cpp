#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "ahm/applications/mean.hpp"
#include "cli/console.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/solve.hpp"
#include "commands/subcommand.hpp"
#include "input/open.hpp"
#include "output/output_paths.hpp"
#include "output/summary.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

constexpr const char* center_footer =
    "POINTS is a list separated by blanks, or a file with one entry per line. An entry is a vertex of INPUT\n"
    "(123, counted from 0) or a position (1.5,0,-2: the nearest vertex; in files also 1.5 0 -2).\n"
    "WEIGHTS is a list or a file of the same form, with one number per point.\n"
    "\n"
    "The center usually lies between vertices. The program prints its position on the surface and the nearest vertex.\n"
    "Points that cover more than half of a closed surface may have several centers; --start chooses among them.\n"
    "\n"
    "Examples:\n"
    "  ahm center scan.ply --points '12 480 901'\n"
    "  ahm center terrain.ply --points towns.xyz --weights people.txt --median --json center.json";

struct CenterCommandOptions {
  InputOptions input;
  SolveOptions solve;
  OutputOptions output;
  std::vector<SourceSpec> points;
  std::vector<double> weights;
  std::optional<SourceSpec> start;
  bool median = false;
};

Center find_center(const CenterCommandOptions& options, const Input& input, const Maps& maps, Journal& journal) {
  const std::vector<Vertex> vertices = vertices_at(input, options.points, "--points");
  if (!options.weights.empty() && options.weights.size() != vertices.size())
    throw InvalidArgument(fmt::format("--weights: expected one weight per point, found {} for {}",
                                      options.weights.size(), vertices.size()));
  CenterOptions center;
  comment_on_positions(input, options.points, "--points", journal);
  if (options.start) {
    comment_on_positions(input, std::span(&*options.start, 1), "--start", journal);
    center.start = vertex_at(input, *options.start, "--start");
  }
  journal.start("search");
  const auto find = options.median ? geometric_median : karcher_mean;
  return find(maps.maker(), vertices, options.weights, center);
}

void report(const CenterCommandOptions& options, const Input& input, const Center& center, Journal& journal) {
  const Vec3 vertex = input.graph().frame(center.vertex.index)->origin;
  const Vec3 position = center_position(input.surface(), center);
  const std::optional<Row> row = input.surface().rows().row(center.vertex);
  const char* name = options.median ? "median" : "mean";
  nlohmann::ordered_json j = summary("ahm center", options.input.path, options.output, input);
  j.erase("output");
  j["center"] = {{"kind", name},
                 {"points", options.points.size()},
                 {"row", row ? nlohmann::ordered_json(row->index) : nlohmann::ordered_json()},
                 {"vertex_position", vertex},
                 {"position", position},
                 {"spread", center.spread},
                 {"maps", center.maps},
                 {"converged", center.converged}};
  const Vec3 &v = vertex, &p = position;
  const std::string text = fmt::format(
      "{} of {} at {:.9g} {:.9g} {:.9g}\nnearest vertex {} at {:.9g} {:.9g} {:.9g}\n{} {:.6g}; maps used: {}, "
      "{}\n",
      name, counted(options.points.size(), "point"), p[0], p[1], p[2],
      row ? fmt::format("{}", row->index) : "(inside a face)", v[0], v[1], v[2],
      options.median ? "mean distance" : "root mean squared distance", center.spread, center.maps,
      center.converged ? "converged" : "not converged");
  deliver(std::move(j), text, options.output, journal);
  if (options.output.verbosity == Verbosity::quiet && options.output.json != "-")
    print(text);  // this is the result, not a comment on it
}

void comment_on(const Center& center, const TangentGraph& graph, Journal& journal) {
  const double away = std::hypot(center.offset[0], center.offset[1]);
  const double edge = graph.mean_edge_length() * graph.length_unit();
  if (away > 3 * edge)
    journal.add_warning(fmt::format(
        "the center is {:.4g} ({:.0f} mean edge lengths) from the nearest vertex: it lies in a hole, or the points are "
        "too far apart on this surface to have one center; try another --start",
        away, away / edge));
  else if (!center.converged)
    journal.add_warning(fmt::format("the search did not converge, maps used: {}; choose another --start", center.maps));
}

void run(const CenterCommandOptions& options) {
  check_outputs({options.input.path}, {{"--json", options.output.json}}, options.output.keep_existing);
  Journal journal(options.output.verbosity);
  std::vector<SourceSpec> named = options.points;
  if (options.start) named.push_back(*options.start);
  const Input input = open_input(with_named_points(options.input, named), journal);
  const Maps maps(options.solve, input, journal, 6);
  const Center center = find_center(options, input, maps, journal);
  comment_on(center, input.graph(), journal);
  report(options, input, center, journal);
}

void offer(CLI::App& app, CenterCommandOptions& o) {
  add_input(app, o.input);
  add_parsed(app, "--points", o.points, parse_sources, "POINTS", "Points: list or file, see below")->required();
  add_parsed(app, "--weights", o.weights, parse_weights, "WEIGHTS",
             "Weights of the points: list or file (default: all equal)");
  app.add_flag("--median", o.median, "Minimize the sum of distances instead of squared distances");
  add_parsed(app, "--start", o.start, parse_source, "SPEC",
             "Where the search starts (default: the point of largest weight)");
  add_method(app, o.solve, {Method::polar, Method::exact}, true);
  add_graph_options(app, o.input, o.solve);
  add_json(app, o.output);
  add_verbosity(app, o.output.verbosity);
}

}  // namespace

Subcommand add_center(CLI::App& program) {
  return subcommand<CenterCommandOptions>(program, "center", "Mean or median of points on a surface", center_footer,
                                          offer, run);
}

}  // namespace ahm::app
