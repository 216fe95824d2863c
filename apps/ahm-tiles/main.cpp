/// \file
/// The program ahm-tiles: log maps of point clouds that do not fit into memory, step by step; also of meshes.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ahm-tiles/arguments.hpp"
#include "ahm-tiles/plan_mesh.hpp"
#include "ahm/tiles/build_tiles.hpp"
#include "ahm/util/text.hpp"
#include "cli/interrupt.hpp"

namespace {

using namespace ahm;
using namespace ahm::tiles;
using namespace ahm::tiles::program;
using polymesh::Discretization;

const std::string name = "ahm-tiles";

/// Checks that an output is not in a folder of tiles or maps. @throws InvalidArgument
void check_output(const std::filesystem::path& output, const std::vector<std::filesystem::path>& folders) {
  std::error_code ignored;
  const auto own = std::filesystem::weakly_canonical(output.has_parent_path() ? output.parent_path() : ".", ignored);
  for (const auto& folder : folders)
    if (std::filesystem::equivalent(own, folder, ignored))
      throw InvalidArgument("--output " + output.string() +
                            ": is in a folder of tiles or maps that is read; choose another folder");
}

struct Arguments {
  std::string input, folder, map, output, step;
  TileOptions tile;
  MeshPlan mesh;
  BuildOptions build;
  MapArguments logmap;
  LocalArguments local;
  std::size_t memory = std::size_t{2} << 30;
  std::optional<std::size_t> number;
  ScheduleOptions schedule;
  Deal deal = Deal::arrival;
  std::vector<int> ranks{1, 2, 4, 8, 16, 32, 64};
};

void add_tile_options(CLI::App& app, Arguments& a) {
  app.add_option(
         "input", a.input,
         "points (PLY, PCD, LAS, or text: .xyz, .txt, .asc, .csv, .pts), or a mesh in any format that ahm reads; "
         "may be compressed (.gz)")
      ->required();
  app.add_option("-o,--output", a.folder, "output folder for the tiles, without tiles in it")->required();
  app.add_option("--tile-points", a.tile.tile_points, "points, or vertices of a mesh, per tile")->capture_default_str();
  app.add_option("--k", a.tile.k, "neighbors per point; 0: 30")->capture_default_str();
  app.add_flag("--drop-nan", a.tile.drop_non_finite, "drop points that are not finite");
  app.add_flag("--ignore-normals", a.tile.ignore_normals, "ignore the normals of the file and estimate them");
  app.add_option("--non-manifold", a.mesh.non_manifold,
                 "edges of a mesh with more than two faces, and vertices where surfaces touch: error (default), or "
                 "split the mesh")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, NonManifold>{{"error", NonManifold::error}, {"split", NonManifold::split}}))
      ->option_text("HOW");
  app.add_option("--discretization", a.mesh.discretization,
                 "of polygon meshes: polygons, refined, or auto (default): refined, or polygons if a face is twisted")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Discretization>{{"auto", Discretization::automatic},
                                                                                {"polygons", Discretization::polygons},
                                                                                {"refined", Discretization::refined}}))
      ->option_text("NAME");
  app.add_flag_callback(
      "--no-flips", [&a] { a.mesh.flips = false; }, "do not flip the edges of a mesh");
  app.add_option("--threads", a.mesh.threads, "number of threads for building a mesh; 0: one per core")
      ->capture_default_str();
}

void add_build_options(CLI::App& app, Arguments& a) {
  app.add_option("folder", a.folder, "folder of the tiles")->required();
  app.add_option("--memory", a.build.memory, "memory limit for a tile with its surroundings, such as 2GB")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--threads", a.build.threads, "number of threads; 0: one per core")->capture_default_str();
  app.add_flag("--keep", a.build.keep, "keep the files of finished steps");
}

void make_local_maps(Arguments& a) {
  const TiledGraph graph(a.local.folder, a.local.memory);
  std::size_t made = 0;
  for (std::size_t t = a.number.value_or(0); t < (a.number ? *a.number + 1 : graph.tiles()); ++t)
    made += write_local_maps(graph, t, a.local.output, a.local.options);
  std::cout << detail::counted(made, "tile") << " written; peak memory " << peak_megabytes() << " MB\n";
}

void print(const Manifest& m) {
  std::int64_t vertices = 0, edges = 0;
  for (const TileFacts& t : m.tiles) vertices += t.vertices, edges += t.edges;
  std::cout << detail::counted(m.tiles.size(), "tile") << ", " << to_string(m.stage) << "; points: " << m.points
            << ", input: " << m.input << '\n';
  if (m.stage == Stage::built)
    std::cout << vertices << " vertices; edges: " << edges / 2 << ", components: " << m.components
              << ", reflections: " << m.reflections << "\n";
}

void make_map(const MapArguments& a, bool coordinates) {
  const TiledGraph graph(a.folder, a.memory / 2);
  TiledMapOptions options = map_options(a, coordinates);
  options.heat.progress = progress_printer(name);
  const TiledMapSummary s = write_log_map(graph, source_at(source_vertices(graph, a.sources)), a.output, options);
  print_map(s, graph.size(), coordinates);
  std::cout << "; tiles released: " << s.releases << ", parts of the map moved to disk: " << s.spills
            << "; peak memory " << peak_megabytes() << " MB\n";
}

/// Mean position of the vertices of each tile.
std::vector<Vec3> middles_of(const TiledGraph& graph, const std::vector<Index>& first) {
  std::vector<Vec3> result(first.size() - 1, Vec3{0, 0, 0});
  for (std::size_t t = 0; t < result.size(); ++t) {
    for (Index i = first[t]; i < first[t + 1]; ++i)
      for (std::size_t c = 0; c < 3; ++c) result[t][c] += graph.frame(i)->origin[c];
    for (double& x : result[t]) x /= std::max(1, first[t + 1] - first[t]);
  }
  return result;
}

/// Prints one line per number of ranks.
void simulate(const Arguments& a) {
  const TiledGraph graph(a.logmap.folder, a.logmap.memory);
  const auto tiles =
      a.number ? equal_tiles(graph.size(),
                             static_cast<Index>(std::min<std::size_t>(*a.number, std::numeric_limits<Index>::max())))
               : graph.manifest().first_vertices();
  const std::vector<Vertex> sources = source_vertices(graph, a.logmap.sources);
  const auto distances = tile_distances(middles_of(graph, tiles), positions_of(graph, sources));
  const auto bands = march_schedule(graph, sources, tiles, a.schedule);
  std::cout << bands.size() << " band(s)\n";
  for (int ranks : a.ranks) {
    if (ranks < 1) throw InvalidArgument("--ranks " + std::to_string(ranks) + ": must be at least 1");
    const SharedLoad load = share_out(bands, deal_tiles(tiles, a.deal, ranks, distances), ranks);
    std::cout << ranks << " rank(s): " << load.solved << " vertices solved, largest band " << load.largest_band
              << ", largest part of a rank " << load.largest_part << ", active " << load.active << ", balance "
              << load.balance << ", messages " << load.messages << ", halo " << load.halo << '\n';
  }
}

/// Plans the input as a point cloud, or if it is not one as a mesh.
Manifest plan_input(const Arguments& a) {
  try {
    if (a.mesh.is_usual()) return plan_tiles(a.input, a.folder, a.tile, progress_printer(name));
  } catch (const IoError& error) {
    if (error.fault() != "no_cloud") throw;
  }
  return plan_mesh(a.input, a.folder, a.tile, a.mesh, progress_printer(name));
}

void add_building(CLI::App& app, Arguments& a) {
  CLI::App& plan = *app.add_subcommand(
      "plan", "cut a point cloud into tiles; tiles of a mesh, which must fit into memory, are also built");
  add_tile_options(plan, a);
  plan.callback([&] { print(plan_input(a)); });
  CLI::App& build = *app.add_subcommand("build", "build the graph of all tiles; resumes a killed run");
  add_build_options(build, a);
  build.callback([&] {
    a.build.progress = progress_printer(name);
    build_tiles(a.folder, a.build);
    print(Manifest::read(a.folder));
  });
  std::string names;
  for (const Step& step : steps()) names += " " + std::string(step.name) + (step.per_tile ? "*" : "");
  CLI::App& step =
      *app.add_subcommand("step", "run one step of the build, for your own scripts; steps (* for each tile):" + names);
  add_build_options(step, a);
  step.add_option("name", a.step, "name of the step")->required();
  step.add_option("--tile", a.number, "number of the tile, from 0");
  step.callback([&] { run_step(a.folder, a.step, a.number, a.build); });
  CLI::App& info = *app.add_subcommand("info", "print the size and the build stage of the tiles");
  info.add_option("folder", a.folder, "folder of the tiles")->required();
  info.callback([&] { print(Manifest::read(a.folder)); });
}

void add_maps(CLI::App& app, Arguments& a) {
  const auto add_map = [&](const std::string& command, const std::string& text, bool coordinates) {
    CLI::App& map = *app.add_subcommand(command, text);
    add_march_options(map, a.logmap);
    if (coordinates) add_map_options(map, a.logmap);
    map.add_option("--threads", a.logmap.threads, "number of threads; 0: one per core")->capture_default_str();
    map.callback([&, coordinates] { make_map(a.logmap, coordinates); });
  };
  add_map("logmap", "make the log map of one or several sources; resumes a killed run from its last checkpoint", true);
  add_map("distance", "make only the distances of logmap --variant localized, which is faster", false);
  CLI::App& rows = *app.add_subcommand("rows",
                                       "write a map as CSV with the columns row, u, v, distance, spread, status; "
                                       "distances without u, v, spread; or features");
  rows.add_option("folder", a.folder, "folder of the tiles")->required();
  rows.add_option("map", a.map, "folder of the map, or of features of local maps")->required();
  rows.add_option("-o,--output", a.output, "CSV file; - for standard output")->required();
  rows.callback([&] {
    check_output(a.output, {a.folder, a.map});
    if (a.output == "-") a.output = "/dev/stdout";
    const bool is_local = std::filesystem::exists(Manifest::file(a.map, "local", 0));
    (is_local ? write_feature_rows : write_rows)(TiledGraph(a.folder, a.memory), a.map, a.output);
  });
  CLI::App& schedule =
      *app.add_subcommand("simulate", "print how evenly the ranks of ahm-mpi would share the work of a map");
  schedule.add_option("folder", a.logmap.folder, "folder of the tiles")->required();
  schedule.add_option("--source", a.logmap.sources, "source as in logmap");
  schedule.add_option("--ranks", a.ranks, "numbers of ranks to simulate")->capture_default_str();
  schedule.add_option("--tiles", a.number, "simulate this many tiles of equal size");
  schedule.add_option("--step", a.schedule.step, "distance that the front moves per band, in mean edge lengths")
      ->capture_default_str();
  schedule.add_option("--width", a.schedule.width, "depth of a band, in mean edge lengths")->capture_default_str();
  add_deal_option(schedule, a.deal);
  schedule.callback([&] { simulate(a); });
  CLI::App& local =
      *app.add_subcommand("local-maps", "make the map around every vertex, tile by tile; resumes a killed run");
  add_local_options(local, a.local);
  local.add_option("--tile", a.number, "only this tile, from 0");
  local.callback([&] { make_local_maps(a); });
}

/// The message of an error, with the option of this program that helps.
std::string message_of(const Error& error) {
  const std::string_view fault = error.fault();
  if (fault == "non_finite") return std::string(error.problem()) + "; drop such points with --drop-nan";
  if (fault == "normals_given") return std::string(error.problem()) + "; estimate them with --ignore-normals";
  if (fault == "non_manifold_edges" || fault == "non_manifold_vertices")
    return std::string(error.problem()) + "; cut the mesh there with --non-manifold split";
  if (fault == "twisted_faces") return std::string(error.problem()) + "; use --discretization polygons";
  return error.what();
}

int run(int argc, char** argv) {
  Arguments a;
  CLI::App app("Log maps of point clouds that do not fit into memory: cuts them into tiles on disk.", name);
  app.set_version_flag("--version", name + " " AHM_VERSION, "Print the version");
  app.require_subcommand(1);
  add_building(app, a);
  add_maps(app, a);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  return 0;
}

/// Runs the program and prints its errors. @return the exit status
int run_and_report(int argc, char** argv) {
  try {
    const int status = run(argc, argv);
    if (std::cout.flush()) return status;
    std::cerr << "ahm-tiles: error: cannot write to standard output\n";
  } catch (const std::bad_alloc&) {
    std::cerr << "ahm-tiles: error: out of memory; plan smaller tiles\n";
  } catch (const Error& e) {
    std::cerr << "ahm-tiles: error: " << message_of(e) << '\n';
  } catch (const std::exception& e) {
    std::cerr << "ahm-tiles: error: " << e.what() << '\n';
  } catch (...) {
    std::cerr << "ahm-tiles: error: unknown failure\n";
  }
  return 1;
}

}  // namespace

// Exits without running the destructors of libraries, as the program ahm does.
int main(int argc, char** argv) {
  app::install_interrupt_handling(name);
  _exit(run_and_report(argc, argv));
}
