#include "output/view.hpp"

#include <fmt/format.h>

#include "ahm/error.hpp"
#include "ahm/viewer/server.hpp"
#include "cli/console.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/subcommand.hpp"

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

struct ViewCommandOptions : ViewOptions {
  int port = 0;
  bool no_browser = false;
  Verbosity verbosity = Verbosity::normal;
};

void run(const ViewCommandOptions& options) {
  if (!viewer::can_serve())
    throw Error(
        "this build of ahm has no viewer; install cpp-httplib and three.js (Debian: libcpp-httplib-dev libjs-three "
        "pkgconf) and build again, or use 'ahm logmap --view map.html' or map.png");
  Journal journal(options.verbosity);
  const View view(options, journal);
  viewer::Server server(view.session(), options.port);
  journal.finish();
  journal.clear_display();
  const bool opened = !options.no_browser && open_browser(server.address());
  print(fmt::format("{}\n", server.address()));
  print_to_stderr(opened ? "ahm: opened in the browser; Ctrl-C ends the program\n"
                         : "ahm: open this address in a browser; Ctrl-C ends the program\n");
  if (const auto radius = view.first_radius(); radius && !options.solve.radius)
    print_to_stderr(fmt::format(
        "ahm: maps have the radius {:g}, set by 'radius' on the page; clear that field to map everything\n", *radius));
  server.run();
}

void offer(CLI::App& app, ViewCommandOptions& o) {
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
  return subcommand<ViewCommandOptions>(program, "view", "Interactive maps in the browser", view_footer, offer, run);
}

}  // namespace ahm::app
