#include "cli/option_adders.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "ahm/io/formats.hpp"
#include "cli/source_list.hpp"
#include "input/backend.hpp"
#include "output/output_paths.hpp"
#include "output/picture_options.hpp"

namespace ahm::app {
namespace {

/// "a, b or c"
std::string one_of(const std::vector<std::string>& names) {
  const std::string rest = fmt::format("{}", fmt::join(names.begin(), names.end() - 1, ", "));
  return rest.empty() ? names.back() : rest + " or " + names.back();
}

std::string input_help() {
  return fmt::format("Input file, or - for standard input. Formats: {}", fmt::join(io::extensions(io::Use::read), " "));
}

/// Parses the name of a format into its extension.
ChoiceOf<std::string> format_parser(io::Use use, const std::vector<std::string>& more = {}) {
  std::vector<std::pair<std::string, std::string>> names;
  std::vector<std::string> extensions = io::extensions(use);
  extensions.insert(extensions.end(), more.begin(), more.end());
  for (const std::string& extension : extensions) names.emplace_back(extension.substr(1), extension);
  return choice_of(names);
}

void add_input_format(CLI::App& app, InputOptions& o) {
  add_parsed(app, "--input-format", o.format, format_parser(io::Use::read), "NAME",
             "Format of INPUT: ply, xyz, ... (default: from the file name; for -, from the first bytes)");
}

/// The radius of smoothing; none: automatic, 0: off.
std::optional<double> parse_smoothing(const std::string& text) {
  if (text == "auto") return {};
  if (text == "off") return 0.0;
  try {
    return parse_positive(text);
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument("'" + text + "' is not auto, off or a number > 0");
  }
}

}  // namespace

std::function<Index(const std::string&)> integer_parser(std::int64_t low, std::int64_t high) {
  return [=](const std::string& text) { return static_cast<Index>(parse_integer(text, low, high)); };
}

std::string Choice::operator()(const std::string& text) const {
  if (std::ranges::find(words, text) == words.end())
    throw std::invalid_argument(fmt::format("'{}' is not one of {}", text, fmt::join(words, ", ")));
  return text;
}

std::string non_empty(const std::string& text) {
  if (text.empty()) throw std::invalid_argument("the name is empty");
  return text;
}

CLI::Option* add_source(CLI::App& app, SourceOptions& o, const std::string& help) {
  return add_parsed(app, "-s,--source", o.spec, parse_source, "SPEC", help);
}

void add_sources(CLI::App& app, std::vector<SourceSpec>& sources) {
  const auto one = [](const std::string& text) { return std::vector{parse_source(text)}; };
  const auto add = [&](const std::string& names, const char* type, const auto& parse, const std::string& help) {
    const std::string label = names.substr(names.find("--"));
    const auto append = [&sources, label, parse](const std::vector<std::string>& texts) {
      try {
        for (const std::string& text : texts) {
          const std::vector<SourceSpec> more = parse(text);
          sources.insert(sources.end(), more.begin(), more.end());
        }
      } catch (const std::invalid_argument& e) {
        throw CLI::ValidationError(label, e.what());
      }
    };
    app.add_option_function<std::vector<std::string>>(names, append, help)->type_name(type)->allow_extra_args(false);
  };
  add("-s,--source", "SPEC", one, "Source of the map, see below; repeat it for several maps");
  add("--sources", "SOURCES", parse_sources, "More sources: list or file, see below");
}

CLI::Option* add_u_axis(CLI::App& app, SourceOptions& o) {
  return add_parsed(
      app, "--u-axis", o.u_axis,
      [](const std::string& text) {
        return text == "curvature" ? UAxis{true, {}} : UAxis{false, parse_direction(text)};
      },
      "X,Y,Z|curvature",
      "Direction of the u axis, a vector in space that is projected to the surface (default: chosen by the\n"
      "backend). It must be at least 1 degree from the normal, 5 if normals are estimated.\n"
      "curvature: the direction in which the surface bends most (not on planes and spheres)");
}

CLI::Option* add_min_quality(CLI::App& app, double& min_quality) {
  return add_parsed(
      app, "--min-quality", min_quality,
      [](const std::string& text) {
        const double value = parse_positive(text);
        if (value > 1) throw std::invalid_argument(fmt::format("'{}' is greater than 1", text));
        return value;
      },
      "Q", "Use only vertices with at least this quality, in (0, 1] (default 0.5)");
}

void add_input(CLI::App& app, InputOptions& o) {
  app.add_option("INPUT", o.path, input_help())->required()->type_name("");
  add_input_format(app, o);
}

void add_inputs(CLI::App& app, InputOptions& o, std::vector<std::string>& paths) {
  app.add_option("INPUT", paths, input_help())->required()->type_name("");
  add_input_format(app, o);
}

CLI::Option* add_backend(CLI::App& app, InputOptions& o) {
  std::vector<std::string> names;
  for (const Backend& backend : backends()) names.emplace_back(backend.name);
  const std::string help = "Kind of surface: auto (default: chosen from the faces of INPUT), " + one_of(names);
  names.insert(names.begin(), "auto");
  return add_parsed(app, "--backend", o.backend, choice(names), "NAME", help);
}

CLI::Option* add_drop_nan(CLI::App& app, InputOptions& o) {
  return app.add_flag("--drop-nan", o.drop_nan,
                      "Drop points with NaN or infinite coordinates (default: stop with an error)");
}

CLI::Option* add_non_manifold(CLI::App& app, InputOptions& o) {
  return add_parsed(
      app, "--non-manifold", o.non_manifold, choice({"error", "split"}), "HOW",
      "Edges with more than two faces, and vertices where surfaces touch: error (default), or split the mesh there");
}

void add_cloud_options(CLI::App& app, InputOptions& o) {
  const char* group = "Point clouds";
  add_parsed(app, "--voxel", o.voxel, parse_positive, "SIZE",
             "Thin the cloud to one point per cube of this edge length; rows named in the command are kept")
      ->group(group);
  app.add_flag("--outliers", o.outliers, "Remove statistical outliers before the map")->group(group);
  add_drop_nan(app, o)->group(group);
  add_parsed(app, "--k", o.k, integer_parser(3), "N", "Neighbors per point, at least 3 (default 30)")->group(group);
  add_parsed(app, "--knn", o.knn, choice({"nanoflann", "flann", "pcl"}), "NAME",
             "Library of the neighbor search: nanoflann (default), flann or pcl")
      ->group(group);
  add_normals(app, o)->group(group);
  add_smooth(app, o)->group(group);
}

CLI::Option* add_smooth(CLI::App& app, InputOptions& o) {
  return add_parsed(
      app, "--smooth", o.smooth, parse_smoothing, "auto|off|RADIUS",
      "Smooth the points before the map: auto (default: only where the cloud is noisy), off, or all points\n"
      "over neighborhoods of this radius");
}

CLI::Option* add_normals(CLI::App& app, InputOptions& o) {
  return add_parsed(
      app, "--normals", o.normals, choice({"auto", "oriented", "unoriented", "estimate"}), "HOW",
      "Use of the normals in INPUT: auto (default) checks their signs, oriented uses the signs unchecked,\n"
      "unoriented ignores the signs, estimate ignores the normals");
}

void add_local(CLI::App& app, InputOptions& o, const std::string& radius) {
  app.add_flag(
      "--local", o.around_source,
      radius +
          ": build the graph only around the source, which is fast on very large inputs.\n"
          "The mean edge length and the noise of a cloud are then measured there only, so results differ from\n"
          "those of the whole input");
}

void add_mesh_options(CLI::App& app, InputOptions& o) {
  const char* group = "Triangle meshes";
  app.add_flag_callback(
         "--no-flips", [&o] { o.flips = false; },
         "Keep the edges of the mesh instead of flipping them to the intrinsic Delaunay triangulation, for\n"
         "comparisons. Distances then do not go around holes, and quality is less reliable")
      ->group(group);
  add_non_manifold(app, o)->group(group);
  add_parsed(app, "--discretization", o.discretization, choice({"auto", "polygons", "refined"}), "NAME",
             "auto (default): refined, or polygons if a face is twisted. polygons: one cell per face.\n"
             "refined: intrinsic triangles, with an additional vertex in every face")
      ->group("Polygon meshes");
  add_repair_options(app, o);
}

void add_repair_options(CLI::App& app, InputOptions& o) {
  const char* group = "Repair of meshes";
  app.add_flag_callback(
         "--repair",
         [&o] {
           const std::optional<double> reach = o.repair.weld;
           o.repair = RepairOptions::all();
           if (reach) o.repair.weld = reach;
           o.non_manifold = "split";
         },
         "All repairs below and --non-manifold split; --weld is 0 unless set. Results keep the rows of INPUT")
      ->group(group);
  const auto parse_reach = [](const std::string& text) { return text == "0" ? 0.0 : parse_positive(text); };
  add_parsed(app, "--weld", o.repair.weld, parse_reach, "EPS",
             "Join vertices at most EPS apart (0: at equal positions), and drop the faces that collapse")
      ->group(group);
  app.add_flag("--drop-degenerate", o.repair.drop_degenerate,
               "Drop faces with fewer than three vertices, a repeated vertex, or a vertex that is not finite")
      ->group(group);
  app.add_flag("--drop-duplicates", o.repair.drop_duplicates, "Keep only the first of the faces with the same vertices")
      ->group(group);
  app.add_flag("--orient", o.repair.orient, "Flip faces so that neighbors agree and closed parts face outward")
      ->group(group);
}

CLI::Option* add_method(CLI::App& app, SolveOptions& o, std::vector<Method> methods, bool chosen) {
  if (chosen) o.method.reset();
  app.parse_complete_callback([&app, &o] {
    if (o.method == Method::heat) return;
    for (const char* name :
         {"--variant", "--strategy", "--t-coef", "--ordering", "--factor", "--accuracy", "--estimate"}) {
      const CLI::Option* option = app.get_option_no_throw(name);
      if (option == nullptr || option->count() == 0) continue;
      if (o.method)
        throw CLI::ValidationError("--method", fmt::format("{} does not use {}; leave it out, or use --method heat",
                                                           to_string(*o.method), name));
      o.method = Method::heat;
      return;
    }
  });
  std::vector<std::pair<std::string, std::optional<Method>>> choices{{"heat", Method::heat}};
  if (chosen) choices.insert(choices.begin(), {"auto", std::nullopt});
  for (const Method method : methods) choices.emplace_back(to_string(method), method);
  const auto offers = [&](Method method) { return std::ranges::find(methods, method) != methods.end(); };
  std::string help =
      chosen ? "auto (default): polar on meshes and on clouds with little noise, otherwise heat. Options of the heat\n"
               "method select heat.\n"
             : "";
  if (offers(Method::polar))
    help +=
        "polar: length and direction of the shortest path, computed by a wavefront without factorization;\n"
        "95 % of the vectors are within a few percent.\n";
  help += fmt::format("heat{}: the affine heat method, smooth on noisy surfaces", chosen ? "" : " (default)");
  if (offers(Method::exact))
    help +=
        ".\nexact: straight lines over the faces of a mesh; best on coarse and sharp-edged meshes, and around holes";
  return add_parsed(app, "--method", o.method, choice_of<std::optional<Method>>(choices), "NAME", help);
}

CLI::Option* add_variant(CLI::App& app, SolveOptions& o) {
  std::vector<std::pair<std::string, Variant>> variants;
  std::vector<std::string> names;
  for (Variant variant : all_variants) {
    variants.emplace_back(to_string(variant), variant);
    names.push_back(variants.back().first + (variant == o.variant ? " (default)" : ""));
  }
  return add_parsed(app, "--variant", o.variant, choice_of(variants), "NAME", one_of(names));
}

CLI::Option* add_strategy(CLI::App& app, SolveOptions& o) {
  return add_parsed(
      app, "--strategy", o.strategy,
      choice_of<Strategy>({{"auto", Strategy::automatic}, {"global", Strategy::global}, {"march", Strategy::march}}),
      "NAME", "auto (default); global: one factorization; march: band after band outward, for any size and distance");
}

CLI::Option* add_t_coef(CLI::App& app, SolveOptions& o) {
  return add_parsed(app, "--t-coef", o.t_coef, parse_positive, "T",
                    "Diffusion time in squared mean edge lengths, > 0 (default 1); larger values give smoother maps");
}

CLI::Option* add_threads(CLI::App& app, InputOptions& graph, SolveOptions* maps) {
  const auto parse = [maps, number = integer_parser(0, 4096)](const std::string& text) {
    const auto threads = static_cast<unsigned>(number(text));
    if (maps != nullptr) maps->threads = threads;
    return threads;
  };
  return add_parsed(app, "--threads", graph.threads, parse, "N", "Number of threads; 0 (default): one per core");
}

void add_graph_options(CLI::App& app, InputOptions& input, SolveOptions& solve) {
  add_variant(app, solve);
  add_backend(app, input);
  add_t_coef(app, solve);
  add_threads(app, input, &solve);
  add_cloud_options(app, input);
  add_mesh_options(app, input);
}

CLI::Option* add_output(CLI::App& app, OutputOptions& o) {
  app.add_flag("--no-overwrite", o.keep_existing,
               "Do not replace existing files (default: replace them when the new files are complete)");
  return add_parsed(
      app, "-o,--output", o.output,
      [](const std::string& text) { return text == "-" ? standard_output : non_empty(text); }, "OUTPUT",
      "Output file, see below");
}

CLI::Option* add_table_output(CLI::App& app, OutputOptions& o, const std::vector<std::string>& more) {
  std::string names = "csv, jsonl, ply";
  for (const std::string& extension : more) names += ", " + extension.substr(1);
  add_parsed(app, "--format", o.format, format_parser(io::Use::write, more), "NAME",
             fmt::format("Format of OUTPUT: {}, ... (default: from the file name; for -, csv)", names));
  return add_output(app, o)->description("Output file, see below; - for standard output");
}

CLI::Option* add_json(CLI::App& app, OutputOptions& o) {
  return add_parsed(app, "--json", o.json, non_empty, "FILE|-",
                    "Write a summary as JSON to FILE, or to standard output (-)");
}

CLI::Option* add_view(CLI::App& app, OutputOptions& o) {
  const auto parse = [](const std::string& text) {
    const std::string ending = io::lower_extension(text);
    if (!is_pattern(non_empty(text)) && ending != ".png" && ending != ".html" && ending != ".htm")
      throw std::invalid_argument(fmt::format("'{}' must end in .png or .html", text));
    return text;
  };
  return add_parsed(app, "--view", o.view, parse, "FILE", "Write a picture of the result: .png or .html");
}

void add_verbosity(CLI::App& app, Verbosity& verbosity, const std::string& group) {
  app.add_flag_callback(
         "--verbose", [&] { verbosity = Verbosity::verbose; }, "Print the time of each stage and the peak memory")
      ->group(group);
  app.add_flag_callback(
         "--quiet", [&] { verbosity = Verbosity::quiet; }, "Print errors only: no summary, no warnings")
      ->group(group);
}

void add_map_results(CLI::App& app, OutputOptions& o) {
  add_json(app, o);
  add_view(app, o);
  add_map_picture(app, o.picture);
  add_verbosity(app, o.verbosity);
}

void add_graph_and_results(CLI::App& app, InputOptions& input, SolveOptions& solve, OutputOptions& output) {
  add_graph_options(app, input, solve);
  add_map_results(app, output);
}

}  // namespace ahm::app
