#include "commands/whole_coverage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numbers>

#include "ahm/error.hpp"
#include "ahm/io/write.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/line_finder.hpp"
#include "input/open.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

std::vector<double> parse_plane(const std::string& text) {
  std::vector<double> numbers = parse_numbers(text);
  if (numbers.size() != 6)
    throw std::invalid_argument("expected a point and a normal, six numbers separated by commas");
  if (std::hypot(numbers[3], numbers[4], numbers[5]) == 0) throw std::invalid_argument("the normal is zero");
  return numbers;
}

const char* word(PassOrigin origin) {
  switch (origin) {
    case PassOrigin::seed:
      return "seed";
    case PassOrigin::level:
      return "level";
    case PassOrigin::cut_locus:
      return "cut_locus";
    case PassOrigin::boundary:
      return "boundary";
    case PassOrigin::spiral:
      return "spiral";
  }
  return "";
}

const std::vector<std::string> coverages{"covered", "gap", "no_pass", "outside_region", "no_triangle", "removed"};

std::array<std::size_t, 6> count_rows(const std::vector<RowCoverage>& rows) {
  std::array<std::size_t, 6> counts{};
  for (const RowCoverage row : rows) ++counts[static_cast<std::size_t>(row)];
  return counts;
}

/// Writes the rows of the input with their coverage.
void write_rows(const std::string& file, const io::Geometry& geometry, const std::vector<RowCoverage>& rows) {
  std::vector<std::uint8_t> codes;
  for (const RowCoverage row : rows) codes.push_back(static_cast<std::uint8_t>(row));
  io::Table table{.title = "coverage by libahm"};
  table.add({"x", "y", "z"}, geometry.points);
  table.columns.push_back({{"status"}, io::CodedWords{codes, coverages}});
  table.faces = geometry.faces();
  io::write(file, table);
}

/// The rows that are not covered, by reason: "rows not covered: 12 in gaps, 3 in no triangle". Empty if there are none.
std::string uncovered_rows(const std::vector<RowCoverage>& rows) {
  const std::array<std::size_t, 6> counts = count_rows(rows);
  std::vector<std::string> parts;
  for (const auto& [reason, words] : {std::pair{RowCoverage::gap, "in gaps"},
                                      {RowCoverage::no_pass, "in components without a pass"},
                                      {RowCoverage::no_triangle, "in no triangle"},
                                      {RowCoverage::removed, "removed before the map or without a face"}})
    if (const std::size_t n = counts[static_cast<std::size_t>(reason)]; n > 0)
      parts.push_back(fmt::format("{} {}", n, words));
  return parts.empty() ? "" : fmt::format("rows not covered: {}\n", fmt::join(parts, ", "));
}

constexpr double long_side = 10;  ///< times the median side

/// Share of the area of a cloud in triangles with long sides: between outliers, across holes, where points are sparse.
double share_of_long_triangles(const Surface& surface) {
  const exact::PolyhedralSurface flat = surface.flat_approximation().surface;
  std::vector<double> sides;
  for (Index half = 0; half < 3 * flat.face_count(); ++half) sides.push_back(flat.record(half).length);
  std::vector<double> sorted = sides;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  double all = 0, in_long = 0;
  for (std::size_t k = 0; k < sides.size(); k += 3) {
    const double a = sides[k], b = sides[k + 1], c = sides[k + 2], half_sum = (a + b + c) / 2;
    const double area = std::sqrt(std::max(0.0, half_sum * (half_sum - a) * (half_sum - b) * (half_sum - c)));
    all += area;
    if (std::max({a, b, c}) > long_side * *middle) in_long += area;
  }
  return in_long / all;
}

/// Warns if much of the area of a cloud may be no surface.
void comment_on_long_triangles(const Input& input, Journal& journal) {
  if (input.surface().faces().size() > 0) return;
  if (const double share = share_of_long_triangles(input.surface()); share > 0.02)
    journal.add_warning(fmt::format(
        "{:.1f} % of the area is in triangles with sides longer than {:g} times the median: between outliers, across "
        "holes, or where points are sparse; a path over everything covers them. Remove outliers (--outliers), or cover "
        "a region",
        100 * share, long_side));
}

/// The largest gap, which is measured up to 4 spacings.
std::string gap_text(const ToolPathMeasures& measures) {
  return fmt::format("{:.2f} spacings{}", measures.largest_gap, measures.largest_gap >= 4 ? " or more" : "");
}

/// The region of --mask: rows whose value is not zero.
std::vector<bool> mask_of(const io::Geometry& geometry, const std::string& name) {
  std::vector<bool> rows;
  for (const double value : column_of(geometry, name, "--mask")) rows.push_back(value != 0 && !std::isnan(value));
  return rows;
}

std::vector<Vec3> curve_of(const Input& input, const std::vector<SourceSpec>& specs, const std::string& option) {
  std::vector<Vec3> points;
  for (const SourceSpec& spec : specs) points.push_back(position_of(input, spec, option));
  return points;
}

/// The point of a SPEC, or its position: the library checks the distance of positions from the surface.
CurvePoint curve_point(const SurfacePoint& point, const SourceSpec& spec) {
  if (const auto* given = std::get_if<SourcePosition>(&spec)) return given->position;
  return point;
}

ToolPathSeed seed_of(const WholeOptions& options, const Input& input) {
  if (options.from_boundary) return BoundarySeed{};
  if (const auto& p = options.plane; !p.empty()) return PlaneSeed{{p[0], p[1], p[2]}, {p[3], p[4], p[5]}};
  if (options.line) {
    const SurfacePoint point = point_on_surface(input, *options.line, "--seed-line");
    return LineSeed{curve_point(point, *options.line), vector_of(*options.direction, input, point, "--seed-line")};
  }
  if (options.feature_angle > 0) {
    FeatureSeed seed{options.feature_angle};
    if (const auto& spec = options.feature)
      seed.near = curve_point(point_on_surface(input, *spec, "--seed-near"), *spec);
    return seed;
  }
  if (options.curve.empty()) return AutomaticSeed{};
  return CurveSeed{curve_of(input, options.curve, "--seed-curve"), options.closed};
}

void write_view(const InputOptions& input_options, const OutputOptions& output, const Input& input,
                const ToolPath& path, Journal& journal) {
  if (output.view.empty()) return;
  Results results(output, input, input_options);
  render::Scene scene = results.scene();
  render::PictureOptions picture;
  picture.pattern = render::Pattern::none;
  std::vector<Vec3> curve;
  std::vector<Index> pieces;
  for (const ToolPass& pass : path.passes) {
    if (!curve.empty()) pieces.push_back(static_cast<Index>(curve.size()));
    for (std::size_t k = pass.begin; k < pass.end; ++k) curve.push_back(path.poses[k].position);
  }
  scene.curve = curve;
  scene.curve_pieces = pieces;
  scene.source = curve.front();
  results.write_view(scene, journal, picture);
}

void report(const std::string& input_path, const OutputOptions& output, const Input& input, const ToolPath& path,
            const ToolPathMeasures& measures, Journal& journal) {
  const auto spirals = std::ranges::count(path.passes, PassOrigin::spiral, &ToolPass::origin);
  nlohmann::ordered_json j = summary("ahm coverage", input_path, output, input);
  j["pattern"] = "whole";
  j["spirals"] = spirals;
  j["spacing"] = path.spacing;
  j["points"] = path.poses.size();
  j["pass_length"] = path.pass_length;
  j["link_length"] = path.link_length;
  j["links"] = {{"on_surface", path.surface_links}, {"lifted", path.lifted_links}, {"missing", path.missing_links}};
  j["area"] = measures.area;
  j["covered"] = measures.covered;
  j["largest_gap"] = measures.largest_gap;
  j["double_covered"] = measures.double_covered;
  const std::array<std::size_t, 6> counts = count_rows(measures.rows);
  for (std::size_t k = 0; k < counts.size(); ++k) j["rows"][coverages[k]] = counts[k];
  for (std::size_t k = 0; k < path.passes.size() && !output.json.empty(); ++k) {
    const ToolPass& pass = path.passes[k];
    j["passes"].push_back({{"pass", k},
                           {"kind", word(pass.origin)},
                           {"closed", pass.closed},
                           {"distance", pass.distance},
                           {"length", pass.length},
                           {"first", pass.begin},
                           {"points", pass.end - pass.begin}});
  }
  deliver(std::move(j),
          fmt::format("{}{} of length {:.4g}, {} poses; links: {} on the surface, {} lifted{}, length {:.4g}\n"
                      "covered: {:.2f} % of the area within 0.6 spacings; largest gap {}; double: {:.2f} % of "
                      "the passes\n",
                      path.passes.size() == 1 ? "1 pass" : fmt::format("{} passes", path.passes.size()),
                      spirals == 0   ? ""
                      : spirals == 1 ? " (1 spiral)"
                                     : fmt::format(" ({} spirals)", spirals),
                      path.pass_length, path.poses.size(), path.surface_links, path.lifted_links,
                      path.missing_links == 0 ? "" : fmt::format(", {} missing", path.missing_links), path.link_length,
                      100 * measures.covered, gap_text(measures), 100 * measures.double_covered) +
              uncovered_rows(measures.rows),
          output, journal);
}

}  // namespace

void offer_whole(CLI::App& app, WholeOptions& o) {
  auto* whole =
      app.add_flag("--whole", o.whole, "Cover the whole surface, closed or not; --source and --radius limit it");
  const auto add = [&](const std::string& name, auto& value, const auto& parse, const char* type, const char* help) {
    return add_parsed(app, name, value, parse, type, help)->needs(whole);
  };
  auto* boundary =
      app.add_flag("--seed-boundary", o.from_boundary, "With --whole: passes parallel to the longest boundary loop")
          ->needs(whole);
  auto* plane =
      add("--seed-plane", o.plane, parse_plane, "X,Y,Z,NX,NY,NZ", "Passes parallel to the section with a plane");
  auto* curve = add("--seed-curve", o.curve, parse_sources, "POINTS",
                    "Passes parallel to the curve through points: list or file of SPECs");
  app.add_flag("--seed-closed", o.closed, "Close the curve of --seed-curve")->needs(curve);
  const auto half_turn = [](const std::string& text) {
    const double angle = parse_degrees(text);
    if (!(angle >= 0 && angle <= std::numbers::pi))
      throw std::invalid_argument(fmt::format("'{}' is not between 0 and 180 degrees", text));
    return angle;
  };
  const auto turn = [=](const std::string& text) {
    const double angle = half_turn(text);
    if (angle == 0) throw std::invalid_argument("the angle is zero");
    return angle;
  };
  auto* feature =
      add("--seed-feature", o.feature_angle, turn, "DEG",
          "Passes parallel to the longest feature edge of each component, where normals turn by DEG or more");
  add(
      "--seed-near", o.feature, [](const std::string& text) { return parse_source(text); }, "SPEC",
      "With --seed-feature: passes parallel to the feature edge nearest to a point")
      ->needs(feature);
  auto* line = add(
      "--seed-line", o.line, [](const std::string& text) { return parse_source(text); }, "SPEC",
      "Passes parallel to the straight line through a point");
  auto* direction = add(
      "--direction", o.direction, [](const std::string& text) { return parse_vector_or_angle(text); }, "DIRECTION",
      "Direction of --seed-line: a vector X,Y,Z, or an angle in degrees from the u axis, as in 'ahm trace'");
  line->needs(direction);
  direction->needs(line);
  std::vector<CLI::Option*> seeds{boundary, plane, curve, feature, line};
  for (auto* a : seeds)
    for (auto* b : seeds)
      if (a != b) a->excludes(b);
  add("--mask", o.mask, non_empty, "NAME", "Cover only triangles whose corners have a nonzero value in column NAME");
  auto* facing = add(
      "--facing", o.facing, [](const std::string& text) { return parse_direction(text); }, "X,Y,Z",
      "Cover only what faces a direction: 0,0,1 is the upper side of the part. What lies below other parts is\n"
      "covered, too");
  add("--max-angle", o.max_angle, half_turn, "DEG",
      "Largest angle between the normal of the surface and --facing, 0 to 180 (default 45).\n0,0,1 with 90 covers all "
      "that is "
      "not turned down")
      ->needs(facing);
  add("--inside", o.inside, parse_sources, "POINTS",
      "Cover only what the closed curve through points encloses: all parts but the largest into which it divides the\n"
      "surface. List or file of SPECs");
  add("--outside", o.outside, parse_sources, "POINTS", "Leave out what the closed curve through points encloses");
  add("--chord-error", o.path.chord_error, parse_positive, "E",
      "Largest distance of the passes from the chords between poses (default: S / 200)");
  add("--tool-radius", o.path.tool_radius, parse_positive, "R",
      "The tool axis is the mean normal within R (default: S / 2)");
  add("--clearance", o.path.clearance, parse_positive, "H", "Height of lifted links over the surface (default: S)");
  add("--max-link", o.path.max_link, parse_positive, "L",
      "Longest link on the surface; longer ones are lifted (default: 3 S)");
  auto* one_way = app.add_flag("--one-way", o.path.one_way, "All passes run in the same direction")->needs(whole);
  app.add_flag("--zigzag", o.zigzag, "Directions of passes alternate (default)")->needs(whole)->excludes(one_way);
  const auto lean = [](const std::string& text) {
    const double angle = parse_degrees(text);
    if (!(std::abs(angle) < std::numbers::pi / 2))
      throw std::invalid_argument(fmt::format("'{}' is not between -90 and 90 degrees", text));
    return angle;
  };
  auto* lead = add("--lead", o.path.lead, lean, "DEG", "The tool leans toward the travel by DEG degrees");
  add(
      "--lag", o.path.lead, [=](const std::string& text) { return -lean(text); }, "DEG",
      "The tool leans against the travel by DEG degrees")
      ->excludes(lead);
  add("--tilt", o.path.tilt, lean, "DEG", "The tool leans to the left of the travel by DEG degrees; < 0: to the right");
  add("--offset", o.path.offset, parse_positive, "D",
      "Distance of the poses from the surface, as the center of a ball of radius D on it");
  add("--rows", o.rows, non_empty, "FILE",
      "Write for every row of INPUT whether it is covered, and why not, see below: .csv, .ply, ...");
  offer_path_files(app, o.files, whole);
}

void run_whole(const InputOptions& input_options, const OutputOptions& output, const WholeOptions& options,
               const std::optional<SourceSpec>& source, double radius) {
  check_results(input_options.path, output, path_endings(), {{"--rows", options.rows}});
  if (!options.rows.empty()) io::check_writable(options.rows);
  check_path_file(output, options.files);
  if (input_options.around_source)
    throw InvalidArgument("--local: cannot be combined with --whole, which needs the whole input");
  Journal journal(output.verbosity);
  std::vector<SourceSpec> named = options.curve;
  for (const auto* curve : {&options.inside, &options.outside}) named.insert(named.end(), curve->begin(), curve->end());
  for (const auto& spec : {source, options.line, options.feature})
    if (spec) named.push_back(*spec);
  InputOptions opened = with_named_points(input_options, named);
  opened.all_components = true;
  const Input input = open_input(opened, journal);
  comment_on_long_triangles(input, journal);
  ToolPathOptions o = options.path;
  o.seed = seed_of(options, input);
  o.progress = journal.progress();
  o.threads = input_options.threads;
  if (source) o.region.disc = {curve_point(point_on_surface(input, *source, "--source"), *source), radius};
  if (!options.mask.empty()) o.region.rows = mask_of(input.geometry, options.mask);
  if (options.facing) o.region.facing = {*options.facing, options.max_angle};
  if (!options.inside.empty()) o.region.enclosures.push_back({curve_of(input, options.inside, "--inside")});
  if (!options.outside.empty()) o.region.enclosures.push_back({curve_of(input, options.outside, "--outside"), true});
  journal.start("path");
  const ToolPath path = tool_path(input.surface(), o);
  journal.start("measures");
  const ToolPathMeasures measures = tool_path_measures(input.surface(), path, o.region);
  if (path.uncovered_components > 0)
    journal.add_warning(fmt::format(
        "{} not covered: the seed does not reach {}",
        path.uncovered_components == 1 ? "1 component is" : fmt::format("{} components are", path.uncovered_components),
        path.uncovered_components == 1 ? "it" : "them"));
  if (path.missing_links > 0)
    journal.add_warning(
        fmt::format("missing links: {}. No free path leads to the poses of kind 'missing'; raise or lower --clearance",
                    path.missing_links));
  if (o.spiral && std::ranges::count(path.passes, PassOrigin::spiral, &ToolPass::origin) == 0)
    journal.add_warning("no spiral: nowhere are three or more closed passes around each other; try another seed");
  if (measures.covered < 0.99 || measures.largest_gap > 1.25)
    journal.add_warning(
        fmt::format("gaps: {:.2f} % of the area is farther than 0.6 spacings from a pass, the farthest point {}",
                    100 * (1 - measures.covered), gap_text(measures)));
  write_view(input_options, output, input, path, journal);
  journal.start("write");
  if (!options.rows.empty()) write_rows(options.rows, input.geometry, measures.rows);
  write_tool_path(output.output, output.format, options.files, o, path);
  report(input_options.path, output, input, path, measures, journal);
}

}  // namespace ahm::app
