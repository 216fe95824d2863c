#include "command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "numbers.hpp"
#include "system_info.hpp"

namespace ahm::app {
namespace {

constexpr const char* main_footer =
    "Examples:\n"
    "  ahm info scan.ply                                    what is in the file, and what to run\n"
    "  ahm logmap scan.ply --source 0 -o map.csv            coordinates u, v of every point, seen from point 0\n"
    "  ahm logmap scan.ply --source 0 -o map.ply --view map.png\n"
    "\n"
    "A logarithmic map flattens a surface around a source point: each point gets the direction and the length\n"
    "of the shortest path that leads to it from the source.\n"
    "\n"
    "Exit status: 0 success, 1 the work failed, 2 the command line is wrong, 130 or 143 interrupted.";

constexpr const char* logmap_footer =
    "SPEC is one of\n"
    "  123              a vertex of INPUT, counted from 0\n"
    "  1.5,0,-2         the vertex nearest to this position\n"
    "  face:7:.2,.3,.5  a point in face 7, by barycentric coordinates, one per corner (meshes)\n"
    "\n"
    "INPUT   .ply .pcd .xyz .txt .csv .off .obj .stl\n"
    "OUTPUT  .csv, .ply or .pcd; one row per vertex of INPUT, in its order:\n"
    "          index,x,y,z,u,v,distance,angle,status,quality, with --order 2 also error_estimate\n"
    "        quality is in (0, 1]; below 0.5 the vertex lies at a cut locus or in a fold.\n"
    "        The numbers are nan where status is not ok:\n"
    "          component  not connected to the source      radius   beyond --radius\n"
    "          unreached  too far for double precision     removed  dropped, replaced, or in no face\n"
    "\n"
    "Examples:\n"
    "  ahm logmap scan.ply --source 0 -o map.csv\n"
    "  ahm logmap scan.pcd --source 0.1,0.2,1.4 --drop-nan --voxel 0.01 --outliers -o map.ply --view map.html\n"
    "  ahm logmap mesh.obj --source face:7:.2,.3,.5 --u-axis 1,0,0 -o map.ply\n"
    "  ahm logmap scan.xyz --source 17 -o map.csv --json - | jq .status";

/// Adds an option whose text a parser of ours turns into a value: CLI11's own takes nan, inf and hexadecimal for
/// numbers.
template <class Value, class Parse>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, Value& value, const Parse& parse,
                        const std::string& type, const std::string& help) {
  const std::string label = name.substr(name.find("--"));
  return app
      .add_option_function<std::string>(
          name,
          [&value, parse, label](const std::string& text) {
            try {
              value = parse(text);
            } catch (const std::invalid_argument& e) {
              throw CLI::ValidationError(label, e.what());
            }
          },
          help)
      ->type_name(type);
}

auto integer_parser(std::int64_t low, std::int64_t high = std::numeric_limits<Index>::max()) {
  return [=](const std::string& text) { return static_cast<Index>(parse_integer(text, low, high)); };
}

auto choice(std::vector<std::string> allowed) {
  return [allowed = std::move(allowed)](const std::string& text) {
    if (std::find(allowed.begin(), allowed.end(), text) == allowed.end())
      throw std::invalid_argument(fmt::format("'{}' is none of {}", text, fmt::join(allowed, ", ")));
    return text;
  };
}

std::string non_empty(const std::string& text) {
  if (text.empty()) throw std::invalid_argument("the name is empty");
  return text;
}

void add_input(CLI::App& app, std::string& input) {
  app.add_option("INPUT", input, "File to read: .ply .pcd .xyz .txt .csv .off .obj .stl")->required()->type_name("");
}

CLI::Option* add_variant(CLI::App& app, LogmapOptions& o) {
  return add_parsed(
      app, "--variant", o.variant,
      [](const std::string& text) {
        return choice({"adaptive", "localized"})(text) == "adaptive" ? Variant::adaptive : Variant::localized;
      },
      "NAME", "adaptive (default) or localized");
}

CLI::Option* add_backend(CLI::App& app, LogmapOptions& o) {
  return add_parsed(app, "--backend", o.backend, choice({"auto", "trimesh", "polymesh", "pointcloud"}), "NAME",
                    "auto (default): by the faces of INPUT; trimesh, polymesh or pointcloud");
}

CLI::Option* add_t_coef(CLI::App& app, LogmapOptions& o) {
  return add_parsed(app, "--t-coef", o.t_coef, parse_positive, "T",
                    "Diffusion time in squared mean edge lengths, > 0 (default 1); larger is smoother");
}

void add_method_options(CLI::App& app, LogmapOptions& o) {
  const char* group = "Method";
  add_variant(app, o)->group(group);
  add_backend(app, o)->group(group);
  add_t_coef(app, o)->group(group);
  add_parsed(app, "--radius", o.radius, parse_positive, "R", "Leave out everything farther than this from the source")
      ->group(group);
  add_parsed(app, "--u-axis", o.u_axis, parse_direction, "X,Y,Z",
             "Direction of the u axis, projected to the surface (default: chosen by the backend)")
      ->group(group);
  add_parsed(
      app, "--ordering", o.ordering,
      [](const std::string& text) {
        return choice({"amd", "nested-dissection"})(text) == "amd" ? Ordering::amd : Ordering::nested_dissection;
      },
      "NAME", "Of the factorization: amd (default) or nested-dissection")
      ->group(group);
  add_parsed(
      app, "--strategy", o.strategy,
      [](const std::string& text) {
        const std::string name = choice({"auto", "global", "march"})(text);
        return name == "auto" ? Strategy::automatic : name == "global" ? Strategy::global : Strategy::march;
      },
      "NAME", "auto (default), global: one factorization, or march: band by band, any size and distance")
      ->group(group);
  add_parsed(app, "--order", o.order, integer_parser(1, 2), "N",
             "1 (default), or 2: extrapolate from several diffusion times, with an estimate of the error")
      ->group(group);
  add_parsed(app, "--accuracy", o.accuracy, parse_positive, "A",
             "Of a march, against a global solve, relative (default 1e-9)")
      ->group(group);
  add_parsed(app, "--threads", o.threads, integer_parser(0, 4096), "N", "0 (default): one per core")->group(group);
}

CLI::Option* add_drop_nan(CLI::App& app, LogmapOptions& o) {
  return app.add_flag("--drop-nan", o.drop_nan,
                      "Drop points with nan or infinite coordinates instead of refusing them");
}

CLI::Option* add_non_manifold(CLI::App& app, LogmapOptions& o) {
  return add_parsed(app, "--non-manifold", o.non_manifold, choice({"error", "split"}), "HOW",
                    "Edges of more than two faces and pinched vertices: error (default) or split, cutting there");
}

void add_cloud_options(CLI::App& app, LogmapOptions& o) {
  const char* group = "Point clouds";
  add_parsed(app, "--voxel", o.voxel, parse_positive, "SIZE", "Keep one point per cube of this edge length first")
      ->group(group);
  app.add_flag("--local", o.local,
               "With --radius: build the graph of the surroundings of the source only, fast on huge scans;\n"
               "the diffusion time is then that of the surroundings")
      ->group(group);
  app.add_flag("--outliers", o.outliers, "Remove statistical outliers first")->group(group);
  add_drop_nan(app, o)->group(group);
  add_parsed(app, "--k", o.k, integer_parser(3), "N", "Neighbours per point, at least 3 (default 30)")->group(group);
  add_parsed(app, "--knn", o.knn, choice({"nanoflann", "flann", "pcl"}), "NAME",
             "Neighbour search: nanoflann (default), flann or pcl")
      ->group(group);
  add_parsed(app, "--normals", o.normals, choice({"auto", "oriented", "unoriented", "estimate"}), "HOW",
             "Normals of INPUT: auto (default) judges their signs, oriented trusts them, unoriented\n"
             "ignores the signs, estimate ignores the normals")
      ->group(group);
}

void add_mesh_options(CLI::App& app, LogmapOptions& o) {
  const char* group = "Triangle meshes";
  app.add_flag("!--no-flips", o.flips, "Keep the edges as they are instead of flipping to intrinsic Delaunay")
      ->group(group);
  add_non_manifold(app, o)->group(group);
}

void add_polygon_options(CLI::App& app, LogmapOptions& o) {
  add_parsed(app, "--discretization", o.discretization, choice({"auto", "polygons", "refined"}), "NAME",
             "polygons: every face one cell, refined: a virtual vertex in every face and intrinsic\n"
             "triangles. auto (default): refined, or polygons where a face is twisted")
      ->group("Polygon meshes");
}

void add_report_options(CLI::App& app, LogmapOptions& o) {
  const char* group = "Reports";
  add_parsed(app, "--json", o.json, non_empty, "FILE|-", "Write a summary for programs; -: to standard output")
      ->group(group);
  add_parsed(app, "--view", o.view, non_empty, "FILE", "Draw the map: .png or .html")->group(group);
  app.add_flag("--verbose", o.verbose, "Print the time of each stage and the peak memory")->group(group);
}

CLI::App& add_logmap(CLI::App& app, LogmapOptions& o) {
  CLI::App& logmap = *app.add_subcommand("logmap", "Logarithmic map of a surface from one source");
  add_input(logmap, o.input);
  auto* source = add_parsed(logmap, "-s,--source", o.source, parse_source, "SPEC", "Where the map starts, see below");
  auto* output = add_parsed(logmap, "-o,--output", o.output, non_empty, "OUTPUT", "File to write, see below");
  auto* estimate = logmap.add_flag("--estimate", o.estimate, "Tell what time and memory the run would take, and end");
  logmap.callback([=] {
    if (estimate->count() > 0) return;
    if (source->count() == 0) throw CLI::RequiredError("--source");
    if (output->count() == 0) throw CLI::RequiredError("--output");
  });
  add_method_options(logmap, o);
  add_cloud_options(logmap, o);
  add_mesh_options(logmap, o);
  add_polygon_options(logmap, o);
  add_report_options(logmap, o);
  logmap.footer(logmap_footer);
  return logmap;
}

constexpr const char* local_maps_footer =
    "OUTPUT is a NumPy archive. Entry e of source s, indptr[s] <= e < indptr[s+1], nearest first:\n"
    "  sources[s]    row of INPUT             frames[s]     u axis, v axis and normal in space\n"
    "  indices[e]    row of the neighbour     log[e]        its coordinates u, v in the source's frame\n"
    "  distance[e]   length of log[e]         transport[e]  turns u + iv into the neighbour's frame\n"
    "  weight[e]     area of the neighbour\n"
    "With --pad the arrays are sources x K, and mask says what is there.\n"
    "\n"
    "Example:\n"
    "  ahm local-maps scan.ply --radius 0.02 --k 32 --pad --float32 -o neighbours.npz";

CLI::App& add_local_maps(CLI::App& app, LocalMapsOptions& o) {
  CLI::App& local = *app.add_subcommand("local-maps", "Log maps of all neighbourhoods, for learning on surfaces");
  add_input(local, o.graph.input);
  add_parsed(local, "--radius", o.radius, parse_positive, "R", "Of the neighbourhoods, along the surface")->required();
  add_parsed(local, "-o,--output", o.graph.output, non_empty, "OUTPUT", "File to write, .npz")->required();
  add_parsed(local, "--k", o.nearest, integer_parser(1), "K", "Keep only so many nearest, the source included");
  add_parsed(local, "--sources", o.sources, non_empty, "all|FILE",
             "all (default), or a file of rows of INPUT, counted from 0");
  local.add_flag("--pad", o.pad, "Fixed rows of K entries and a mask; needs --k");
  local.add_flag("--float32", o.float32, "Numbers in single precision");
  add_variant(local, o.graph);
  add_backend(local, o.graph);
  add_t_coef(local, o.graph);
  add_drop_nan(local, o.graph);
  add_non_manifold(local, o.graph);
  add_parsed(local, "--threads", o.graph.threads, integer_parser(0, 4096), "N", "0 (default): one per core");
  add_parsed(local, "--json", o.graph.json, non_empty, "FILE|-", "Write a summary for programs; -: to standard output");
  local.add_flag("--verbose", o.graph.verbose, "Print the time of each stage and the peak memory");
  local.callback([&o] {
    if (o.pad && o.nearest == 0) throw CLI::ValidationError("--pad", "needs --k");
  });
  local.footer(local_maps_footer);
  return local;
}

constexpr const char* coverage_footer =
    "SPEC is 123, x,y,z or face:7:.2,.3,.5 as in 'ahm logmap'.\n"
    "OUTPUT is .csv, or .ply with edges between consecutive points; one row per point, in order of travel:\n"
    "  piece         a tool lifts between pieces     line          of the raster\n"
    "  x,y,z         on the surface                  nx,ny,nz      its normal\n"
    "  hx,hy,hz      heading, unit, in the surface   u,v           coordinates\n"
    "  arclength     from the start of the piece     spacing       to the next line, in space\n"
    "\n"
    "Examples:\n"
    "  ahm coverage scan.ply --source 0.1,0.2,1.4 --radius 0.2 --spacing 0.01 -o path.csv\n"
    "  ahm coverage part.stl --source 17 --radius 30 --spacing 2 --pattern spiral -o path.ply";

CLI::App& add_coverage(CLI::App& app, CoverageCommandOptions& o) {
  CLI::App& coverage = *app.add_subcommand("coverage", "Path that covers a surface around a point, with normals");
  add_input(coverage, o.graph.input);
  add_parsed(coverage, "-s,--source", o.graph.source, parse_source, "SPEC", "Middle of what is covered")->required();
  add_parsed(coverage, "--radius", o.path.radius, parse_positive, "R", "How far to go, along the surface")->required();
  add_parsed(coverage, "--spacing", o.path.spacing, parse_positive, "S", "Between lines or turns")->required();
  add_parsed(coverage, "-o,--output", o.graph.output, non_empty, "OUTPUT", "File to write, see below")->required();
  add_parsed(
      coverage, "--pattern", o.path.pattern,
      [](const std::string& text) {
        return choice({"raster", "spiral"})(text) == "raster" ? CoveragePattern::raster : CoveragePattern::spiral;
      },
      "NAME", "raster (default) or spiral");
  add_parsed(
      coverage, "--angle", o.path.angle,
      [](const std::string& text) { return parse_number(text) * std::numbers::pi / 180; }, "DEG",
      "Direction of the lines, from the u axis (default 0)");
  add_parsed(coverage, "--step", o.path.step, parse_positive, "L", "Between points of the path (default: S / 2)");
  add_parsed(
      coverage, "--min-quality", o.min_quality,
      [](const std::string& text) {
        const double value = parse_positive(text);
        if (value > 1) throw std::invalid_argument(fmt::format("'{}' is greater than 1", text));
        return value;
      },
      "Q", "Trust vertices of this quality and above, in (0, 1] (default 0.5)");
  add_parsed(coverage, "--u-axis", o.graph.u_axis, parse_direction, "X,Y,Z",
             "Direction of the u axis, projected to the surface (default: chosen by the backend)");
  add_variant(coverage, o.graph);
  add_backend(coverage, o.graph);
  add_t_coef(coverage, o.graph);
  add_cloud_options(coverage, o.graph);
  add_mesh_options(coverage, o.graph);
  add_polygon_options(coverage, o.graph);
  add_parsed(coverage, "--threads", o.graph.threads, integer_parser(0, 4096), "N", "0 (default): one per core");
  add_parsed(coverage, "--json", o.graph.json, non_empty, "FILE|-",
             "Write a summary for programs; -: to standard output");
  coverage.add_flag("--verbose", o.graph.verbose, "Print the time of each stage and the peak memory");
  coverage.footer(coverage_footer);
  return coverage;
}

CLI::App& add_info(CLI::App& app, InfoOptions& o) {
  CLI::App& info = *app.add_subcommand("info", "What is in a file, what is wrong with it, what to run on it");
  add_input(info, o.input);
  add_parsed(info, "--json", o.json, non_empty, "FILE|-", "Write the same for programs; -: to standard output");
  add_parsed(info, "--k", o.k, integer_parser(3), "N", "Neighbours per point when looking for components (default 30)");
  add_parsed(info, "--threads", o.threads, integer_parser(0, 4096), "N", "0 (default): one per core");
  info.footer("Example:\n  ahm info scan.pcd");
  return info;
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
  CLI::App app("Logarithmic maps on meshes and point clouds by the affine heat method", "ahm");
  app.get_formatter()->column_width(26);
  app.footer(main_footer);
  app.require_subcommand(1);
  bool version = false;
  app.add_flag("--version", version, "Print the versions of ahm, its libraries and the BLAS in use");
  LogmapOptions logmap_options;
  InfoOptions info_options;
  LocalMapsOptions local_maps_options;
  CoverageCommandOptions coverage_options;
  const CLI::App& logmap = add_logmap(app, logmap_options);
  const CLI::App& local_maps = add_local_maps(app, local_maps_options);
  const CLI::App& coverage = add_coverage(app, coverage_options);
  add_info(app, info_options);
  if (argc == 2 && std::string_view(argv[1]) == "--version") return TextRequest{versions_as_text()};
  const std::string first = argc > 1 ? argv[1] : "";
  if (!first.starts_with("-") && first != "logmap" && first != "local-maps" && first != "coverage" && first != "info")
    throw UsageError{(first.empty() ? "a subcommand is needed" : "'" + first + "' is no subcommand") +
                     std::string(": write logmap, local-maps, coverage or info\nRun 'ahm --help' for help.")};
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    return TextRequest{chosen.empty() ? app.help() : chosen.front()->help("ahm")};
  } catch (const CLI::ParseError& e) {
    const auto chosen = app.get_subcommands();
    throw UsageError{fmt::format("{}\nRun 'ahm {}--help' for help.", e.what(),
                                 chosen.empty() ? "" : chosen.front()->get_name() + " ")};
  }
  if (logmap.parsed()) return logmap_options;
  if (local_maps.parsed()) return local_maps_options;
  if (coverage.parsed()) return coverage_options;
  return info_options;
}

}  // namespace ahm::app
