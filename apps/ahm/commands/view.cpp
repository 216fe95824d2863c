#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "ahm/error.hpp"
#include "ahm/io/image.hpp"
#include "ahm/util/shell.hpp"
#include "ahm/viewer/server.hpp"
#include "cli/console.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/coverage.hpp"
#include "commands/line_finder.hpp"
#include "commands/solve.hpp"
#include "commands/subcommand.hpp"
#include "commands/tool_path_files.hpp"
#include "output/results.hpp"
#include "output/texture_output.hpp"

namespace ahm::app {
namespace {

constexpr const char* view_footer =
    "Opens a page in the browser and serves it, to this machine only, until Ctrl-C. Click a point of the surface to\n"
    "see the map from there; the page shows its values under the pointer. The page also draws paths, strokes, decals\n"
    "and tool paths, saves files, and shows the command line that gives the same result.\n"
    "\n"
    "Examples:\n"
    "  ahm view scan.ply\n"
    "  ahm view mesh.obj --source 17 --method exact\n"
    "  ahm view scan.ply --no-browser --port 8080      over ssh -L 8080:127.0.0.1:8080: open the printed address";

struct ViewOptions {
  InputOptions input;
  std::optional<SourceSpec> source;
  SolveOptions solve;
  int port = 0;
  bool no_browser = false;
  bool local = false;
  Verbosity verbosity = Verbosity::normal;
};

/// Radius of the first maps, where a map of the whole surface would take long. None: no limit.
std::optional<double> first_radius(const ViewOptions& options, const TangentGraph& graph) {
  constexpr Index large = 500'000;
  constexpr double edges = 64;  // about 20,000 vertices
  if (options.solve.radius || options.solve.method == Method::exact) return options.solve.radius;
  if (!options.local && graph.size() <= large) return std::nullopt;
  return std::stod(fmt::format("{:.2g}", edges * graph.mean_edge_length() * graph.length_unit()));
}

viewer::SessionOptions session_options(const ViewOptions& options, const Input& input,
                                       const std::vector<Vec3>& normals) {
  viewer::SessionOptions session;
  session.title = std::filesystem::path(options.input.path).filename().string();
  session.input = detail::shell_word(options.input.path);
  session.input_options = fmt::format("{}", fmt::join(option_words(options.input), " "));
  session.settings = {options.solve.method.value_or(input.surface().suggested_method()),
                      options.solve.variant,
                      options.solve.t_coef,
                      first_radius(options, input.graph()),
                      {}};
  if (options.source) session.source = point_of(input, *options.source);
  session.threads = options.input.threads;
  session.formats = {{"map", {"csv", "ply", "vtp", "jsonl", "pcd"}},
                     {"stroke", {"csv", "ply", "vtp", "jsonl", "pcd"}},
                     {"path", {"obj", "csv", "ply", "vtp", "jsonl"}},
                     {"coverage", {"csv", "ply", "vtp", "jsonl"}},
                     {"whole", {"csv", "ply", "vtp", "jsonl", "obj", "json", "yaml"}}};
  if (io::has_images()) session.formats["decal"] = {"glb", "ply"};
  session.worded = [](const Error& error) { return worded(error); };
  session.write = [&input, &normals](const std::filesystem::path& file, const RowLogMap& rows,
                                     const std::vector<double>& quality) {
    io::Table table = table_of(input.geometry, normals, input.geometry.colors);
    add_map(table, rows, quality);
    io::write(file, table);
  };
  session.write_path = [](const std::filesystem::path& file, const std::vector<Vec3>& points) {
    Polylines path;
    path.add(points);
    write_polylines(file.string(), "", path);
  };
  session.write_coverage = [](const std::filesystem::path& file, const CoveragePath& path) {
    write_coverage(file.string(), "", path);
  };
  session.write_whole = [](const std::filesystem::path& file, const ToolPath& path) {
    OutputOptions output;
    output.output = file.string();
    write_path_file(output, {}, {.spacing = path.spacing}, path);
  };
  session.write_decal = [&input](const std::filesystem::path& file, const InverseMap& inverse,
                                 const DecalOptions& decal, const Image& image) {
    if (file.extension() == ".ply") {
      const Colors colors = painted(input, image_coordinates_of_vertices(inverse, decal), image);
      return io::write(file, painted_table(input, colors));
    }
    const Decal made = make_decal(inverse, decal);
    if (made.face_begin.size() < 2)
      throw InvalidArgument("the image covers no part of the surface where the map is reliable; choose another source");
    io::write_textured(file, DecalMesh(all_faces(input), made, image).parts());
  };
  return session;
}

void run(const ViewOptions& options) {
  if (!viewer::can_serve())
    throw Error(
        "this build of ahm has no viewer; install cpp-httplib and three.js (Debian: libcpp-httplib-dev libjs-three "
        "pkgconf) and build again, or use 'ahm logmap --view map.html' or map.png");
  Journal journal(options.verbosity);
  const Input input = open_input(options.input, journal, options.source);
  if (options.source) place(input, *options.source);  // checks the source
  journal.start("page");
  const std::vector<Vec3> normals = input.surface().normals();
  const viewer::Session session(input.surface(), input.geometry, session_options(options, input, normals));
  viewer::Server server(session, options.port);
  journal.finish();
  journal.clear_display();
  const bool opened = !options.no_browser && open_browser(server.address());
  print(fmt::format("{}\n", server.address()));
  print_to_stderr(opened ? "ahm: opened in the browser; Ctrl-C ends the program\n"
                         : "ahm: open this address in a browser; Ctrl-C ends the program\n");
  if (const auto radius = first_radius(options, input.graph()); radius && !options.solve.radius)
    print_to_stderr(fmt::format(
        "ahm: maps have the radius {:g}, set by 'radius' on the page; clear that field to map everything\n", *radius));
  server.run();
}

void offer(CLI::App& app, ViewOptions& o) {
  add_input(app, o.input);
  add_parsed(
      app, "-s,--source", o.source, [](const std::string& text) { return parse_source(text); }, "SPEC",
      "Source of the first map (default: in the middle of the picture)");
  app.add_flag("--no-browser", o.no_browser, "Only print the address, do not open a browser");
  add_parsed(app, "--port", o.port, integer_parser(0, 65535), "N", "Port on 127.0.0.1 (default 0: any free port)");
  add_method(app, o.solve, {Method::polar, Method::exact}, true);
  add_parsed(app, "--radius", o.solve.radius, parse_positive, "R",
             "Map only points within this distance of the source");
  app.add_flag("--local", o.local,
               "Start with maps of radius 64 edges around the source, unless --radius is set. This is the default\n"
               "for more than 500,000 vertices, where a map of the whole surface takes long");
  add_graph_options(app, o.input, o.solve);
  add_verbosity(app, o.verbosity);
}

}  // namespace

Subcommand add_view(CLI::App& program) {
  return subcommand<ViewOptions>(program, "view", "Interactive maps in the browser", view_footer, offer, run);
}

}  // namespace ahm::app
