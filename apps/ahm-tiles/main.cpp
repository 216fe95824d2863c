/// \file
/// The program ahm-tiles: clouds that do not fit into memory, from a file of points to a log map, step by step; and meshes.

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
#include "cli/interrupt.hpp"

namespace {

using namespace ahm;
using namespace ahm::tiles;
using namespace ahm::tiles::program;
using polymesh::Discretization;

const std::string name = "ahm-tiles";

/// What lies in a folder of tiles or maps is theirs. @throws InvalidArgument
void check_output(const std::filesystem::path& output, const std::vector<std::filesystem::path>& folders) {
  std::error_code ignored;
  const auto own = std::filesystem::weakly_canonical(output.has_parent_path() ? output.parent_path() : ".", ignored);
  for (const auto& folder : folders)
    if (std::filesystem::equivalent(own, folder, ignored))
      throw InvalidArgument("--output " + output.string() +
                            ": is in the folder of tiles or maps that is read; write it elsewhere");
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
  app.add_option("input", a.input,
                 "points: PLY, PCD, LAS, or text (.xyz, .txt, .asc, .csv, .pts); or a mesh of any kind that ahm reads; "
                 "also .gz")
      ->required();
  app.add_option("-o,--output", a.folder, "folder for the tiles, a new one")->required();
  app.add_option("--tile-points", a.tile.tile_points, "points, or vertices of a mesh, per tile")->capture_default_str();
  app.add_option("--k", a.tile.k, "neighbours per point; 0: 30")->capture_default_str();
  app.add_flag("--drop-nan", a.tile.drop_non_finite, "leave out points that are not finite");
  app.add_flag("--ignore-normals", a.tile.ignore_normals, "estimate normals, though the file has some");
  app.add_option(
         "--non-manifold", a.mesh.non_manifold,
         "of a mesh, edges of more than two faces and pinched vertices: error (the default) or split, cutting there")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, NonManifold>{{"error", NonManifold::error}, {"split", NonManifold::split}}))
      ->option_text("HOW");
  app.add_option("--discretization", a.mesh.discretization,
                 "of polygons: polygons, refined, or auto (the default): refined, or polygons where a face is twisted")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Discretization>{{"auto", Discretization::automatic},
                                                                                {"polygons", Discretization::polygons},
                                                                                {"refined", Discretization::refined}}))
      ->option_text("NAME");
  app.add_flag_callback(
      "--no-flips", [&a] { a.mesh.flips = false; }, "keep the edges of a mesh as they are");
  app.add_option("--threads", a.mesh.threads, "to build a mesh; 0: one per core")->capture_default_str();
}

void add_build_options(CLI::App& app, Arguments& a) {
  app.add_option("folder", a.folder, "of tiles")->required();
  app.add_option("--memory", a.build.memory, "most that a tile and its surroundings may take, as 2GB")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--threads", a.build.threads, "0: one per core")->capture_default_str();
  app.add_flag("--keep", a.build.keep, "keep the files of finished steps");
}

void make_local_maps(Arguments& a) {
  const TiledGraph graph(a.local.folder, a.local.memory);
  std::size_t made = 0;
  for (std::size_t t = a.number.value_or(0); t < (a.number ? *a.number + 1 : graph.tiles()); ++t)
    made += write_local_maps(graph, t, a.local.output, a.local.options);
  std::cout << made << " tiles made; peak memory " << peak_megabytes() << " MB\n";
}

void print(const Manifest& m) {
  std::int64_t vertices = 0, edges = 0;
  for (const TileFacts& t : m.tiles) vertices += t.vertices, edges += t.edges;
  std::cout << m.tiles.size() << " tiles, " << to_string(m.stage) << ", of " << m.points << " points of " << m.input
            << '\n';
  if (m.stage == Stage::built)
    std::cout << vertices << " vertices, " << edges / 2 << " edges, " << m.components << " components, "
              << m.reflections << " reflections\n";
}

void make_map(const MapArguments& a, bool coordinates) {
  const TiledGraph graph(a.folder, a.memory / 2);
  TiledMapOptions options = map_options(a, coordinates);
  options.heat.progress = telling(name);
  const TiledMapSummary s = write_log_map(graph, source_at(source_vertices(graph, a.sources)), a.output, options);
  print_map(s, graph.size(), coordinates);
  std::cout << "; tiles were put aside " << s.releases << " times, parts of the map put aside " << s.spills
            << " times; peak memory " << peak_megabytes() << " MB\n";
}

/// Mean positions of these tiles' vertices.
std::vector<Vec3> middles_of(const TiledGraph& graph, const std::vector<Index>& first) {
  std::vector<Vec3> result(first.size() - 1, Vec3{0, 0, 0});
  for (std::size_t t = 0; t < result.size(); ++t) {
    for (Index i = first[t]; i < first[t + 1]; ++i)
      for (std::size_t c = 0; c < 3; ++c) result[t][c] += graph.frame(i)->origin[c];
    for (double& x : result[t]) x /= std::max(1, first[t + 1] - first[t]);
  }
  return result;
}

/// A line per number of ranks.
void simulate(const Arguments& a) {
  const TiledGraph graph(a.logmap.folder, a.logmap.memory);
  const auto tiles =
      a.number ? equal_tiles(graph.size(),
                             static_cast<Index>(std::min<std::size_t>(*a.number, std::numeric_limits<Index>::max())))
               : graph.manifest().first_vertices();
  const std::vector<Vertex> sources = source_vertices(graph, a.logmap.sources);
  const auto distances = tile_distances(middles_of(graph, tiles), positions_of(graph, sources));
  const auto bands = march_schedule(graph, sources, tiles, a.schedule);
  std::cout << bands.size() << " bands\n";
  for (int ranks : a.ranks) {
    if (ranks < 1) throw InvalidArgument("--ranks " + std::to_string(ranks) + " must be at least 1");
    const SharedLoad load = share_out(bands, deal_tiles(tiles, a.deal, ranks, distances), ranks);
    std::cout << ranks << " ranks: " << load.solved << " vertices solved, the largest band " << load.largest_band
              << ", the largest part of one " << load.largest_part << ", active " << load.active << ", balance "
              << load.balance << ", messages " << load.messages << ", halo " << load.halo << '\n';
  }
}

/// Points, or else a mesh.
Manifest plan_input(const Arguments& a) {
  try {
    if (a.mesh.is_usual()) return plan_tiles(a.input, a.folder, a.tile, telling(name));
  } catch (const IoError& error) {
    if (error.fault() != "no_cloud") throw;
  }
  return plan_mesh(a.input, a.folder, a.tile, a.mesh, telling(name));
}

void add_building(CLI::App& app, Arguments& a) {
  CLI::App& plan = *app.add_subcommand(
      "plan", "cut a file of points into tiles; those of a mesh, which must fit into memory, are built at once");
  add_tile_options(plan, a);
  plan.callback([&] { print(plan_input(a)); });
  CLI::App& build = *app.add_subcommand("build", "build the graph of all tiles; killed, it goes on where it was");
  add_build_options(build, a);
  build.callback([&] {
    a.build.progress = telling(name);
    build_tiles(a.folder, a.build);
    print(Manifest::read(a.folder));
  });
  std::string names;
  for (const Step& step : steps()) names += " " + std::string(step.name) + (step.per_tile ? "*" : "");
  CLI::App& step =
      *app.add_subcommand("step", "one step of the build, for drivers of your own; * of one tile:" + names);
  add_build_options(step, a);
  step.add_option("name", a.step, "of the step")->required();
  step.add_option("--tile", a.number, "number of the tile");
  step.callback([&] { run_step(a.folder, a.step, a.number, a.build); });
  CLI::App& info = *app.add_subcommand("info", "what the tiles are, and how far they are built");
  info.add_option("folder", a.folder, "of tiles")->required();
  info.callback([&] { print(Manifest::read(a.folder)); });
}

void add_maps(CLI::App& app, Arguments& a) {
  const auto add_map = [&](const std::string& command, const std::string& text, bool coordinates) {
    CLI::App& map = *app.add_subcommand(command, text);
    add_march_options(map, a.logmap);
    if (coordinates) add_map_options(map, a.logmap);
    map.add_option("--threads", a.logmap.threads, "0: one per core")->capture_default_str();
    map.callback([&, coordinates] { make_map(a.logmap, coordinates); });
  };
  add_map("logmap",
          "the log map, from the nearest of one or several sources; killed, it goes on from its last checkpoint", true);
  add_map("distance", "distances alone, those of logmap --variant localized, for less", false);
  CLI::App& rows = *app.add_subcommand(
      "rows", "a map as CSV: row, u, v, distance, spread, status; row, distance, status; row and features");
  rows.add_option("folder", a.folder, "of tiles")->required();
  rows.add_option("map", a.map, "folder of the map, or of features of local maps")->required();
  rows.add_option("-o,--output", a.output, "CSV file; - for standard output")->required();
  rows.callback([&] {
    check_output(a.output, {a.folder, a.map});
    if (a.output == "-") a.output = "/dev/stdout";
    const bool is_local = std::filesystem::exists(Manifest::file(a.map, "local", 0));
    (is_local ? write_feature_rows : write_rows)(TiledGraph(a.folder, a.memory), a.map, a.output);
  });
  CLI::App& schedule = *app.add_subcommand("simulate", "how evenly ranks of ahm-mpi would share the bands of a map");
  schedule.add_option("folder", a.logmap.folder, "of tiles")->required();
  schedule.add_option("--source", a.logmap.sources, "as logmap");
  schedule.add_option("--ranks", a.ranks, "numbers of ranks")->capture_default_str();
  schedule.add_option("--tiles", a.number, "as if there were so many, of equal size");
  schedule.add_option("--step", a.schedule.step, "how far the front moves with each band, mean edge lengths")
      ->capture_default_str();
  schedule.add_option("--width", a.schedule.width, "how far ahead a band reaches")->capture_default_str();
  add_deal_option(schedule, a.deal);
  schedule.callback([&] { simulate(a); });
  CLI::App& local = *app.add_subcommand("local-maps", "the map around every vertex, tile by tile; killed, it goes on");
  add_local_options(local, a.local);
  local.add_option("--tile", a.number, "this tile alone");
  local.callback([&] { make_local_maps(a); });
}

/// What is wrong, and the option of this program that helps.
std::string told(const Error& error) {
  const std::string_view fault = error.fault();
  if (fault == "non_finite") return std::string(error.problem()) + "; --drop-nan leaves them out";
  if (fault == "normals_given") return std::string(error.problem()) + "; --ignore-normals estimates others";
  if (fault == "non_manifold_edges" || fault == "non_manifold_vertices")
    return std::string(error.problem()) + "; --non-manifold split cuts the mesh there";
  if (fault == "twisted_faces") return std::string(error.problem()) + "; --discretization polygons takes them";
  return error.what();
}

int run(int argc, char** argv) {
  Arguments a;
  CLI::App app("Clouds that do not fit into memory: tiles of their graph, and log maps over them.", name);
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

/// The exit status of `run`; what it throws is told.
int run_told(int argc, char** argv) {
  try {
    const int status = run(argc, argv);
    if (std::cout.flush()) return status;
    std::cerr << "ahm-tiles: error: standard output cannot be written\n";
  } catch (const std::bad_alloc&) {
    std::cerr << "ahm-tiles: error: out of memory; plan smaller tiles\n";
  } catch (const Error& e) {
    std::cerr << "ahm-tiles: error: " << told(e) << '\n';
  } catch (const std::exception& e) {
    std::cerr << "ahm-tiles: error: " << e.what() << '\n';
  } catch (...) {
    std::cerr << "ahm-tiles: error: unknown failure\n";
  }
  return 1;
}

}  // namespace

// Ends without the destructors of libraries, as the program ahm does: where address space does not suffice OpenBLAS would wait
// for threads that never end.
int main(int argc, char** argv) {
  app::install_interrupt_handling(name);
  _exit(run_told(argc, argv));
}
