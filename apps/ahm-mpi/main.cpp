/// \file
/// The program ahm-mpi: maps over tiles, computed by the ranks of an MPI run. Each rank owns some of the tiles.

#include <CLI/CLI.hpp>
#include <iostream>
#include <string>
#include <vector>

#include "ahm-mpi/mpi_team.hpp"
#include "ahm-tiles/arguments.hpp"
#include "ahm/tiles/march_schedule.hpp"
#include "cli/interrupt.hpp"
#include "tiled_log_map.hpp"

namespace {

using namespace ahm;
using namespace ahm::tiles;
using namespace ahm::tiles::mpi;
using namespace ahm::tiles::program;

const std::string name = "ahm-mpi";

struct Arguments {
  MapArguments logmap;
  LocalArguments local;
  Deal deal = Deal::arrival;
  bool traffic = false;
};

int rank_of() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

/// Runs a task on the first rank, then on the others, so that errors of the input are reported once.
template <class Task>
auto first_alone(const Task& task) {
  if (rank_of() > 0) MPI_Barrier(MPI_COMM_WORLD);
  auto result = task();
  if (rank_of() == 0) MPI_Barrier(MPI_COMM_WORLD);
  return result;
}

/// The vertices of the sources. Only the first rank reads the tiles; it sends the result to the others.
std::vector<Vertex> find_sources(const TiledGraph& graph, const std::vector<std::string>& texts) {
  std::vector<Index> numbers(texts.size());
  if (rank_of() == 0) {
    const std::vector<Vertex> vertices = source_vertices(graph, texts);
    for (std::size_t k = 0; k < vertices.size(); ++k) numbers[k] = vertices[k].index;
  }
  MPI_Bcast(numbers.data(), static_cast<int>(numbers.size() * sizeof(Index)), MPI_BYTE, 0, MPI_COMM_WORLD);
  std::vector<Vertex> result;
  for (Index number : numbers) result.emplace_back(number);
  return result;
}

/// The values of all ranks, on the first rank.
std::vector<std::int64_t> of_all_ranks(std::int64_t value) {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  std::vector<std::int64_t> values(static_cast<std::size_t>(size));
  MPI_Gather(&value, 1, MPI_INT64_T, values.data(), 1, MPI_INT64_T, 0, MPI_COMM_WORLD);
  return values;
}

/// Prints one line per figure, with one column per rank.
void print_traffic(const MpiTeam& team) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const Traffic& t = team.traffic();
  const auto milliseconds = [](const timeval& time) { return std::int64_t{time.tv_sec} * 1000 + time.tv_usec / 1000; };
  const std::pair<std::string, std::int64_t> lines[] = {
      {"peak memory, MB", static_cast<std::int64_t>(peak_megabytes())},
      {"processor time, ms", milliseconds(usage.ru_utime) + milliseconds(usage.ru_stime)},
      {"vertices solved", team.solved()},
      {"largest part of a band", team.largest_part()},
      {"messages of searches", t.search_messages},
      {"bytes of searches", t.search_bytes},
      {"messages of solves", t.solve_messages},
      {"bytes of solves", t.solve_bytes},
      {"reductions", t.reductions},
      {"solves", t.solves},
      {"iterations", t.iterations}};
  for (const auto& [what, value] : lines) {
    const std::vector<std::int64_t> all = of_all_ranks(value);
    if (team.rank() > 0) continue;
    std::cout << what << ':';
    for (std::int64_t one : all) std::cout << ' ' << one;
    std::cout << '\n';
  }
}

void make_map(const Arguments& a, bool coordinates) {
  TiledMapOptions options = first_alone([&] { return map_options(a.logmap, coordinates); });
  const TiledGraph graph = first_alone([&] { return TiledGraph(a.logmap.folder, a.logmap.memory / 2); });
  options.heat.threads = 1;
  if (rank_of() == 0) options.heat.progress = progress_printer(name);
  const std::vector<Vertex> sources = find_sources(graph, a.logmap.sources);
  const Source source = source_at(sources);
  TileOwners owners;
  owners.rank = rank_of();
  MPI_Comm_size(MPI_COMM_WORLD, &owners.ranks);
  std::vector<double> distances;
  if (a.deal == Deal::arrival)
    distances = first_alone([&] { return tile_distances(graph.middles(), positions_of(graph, sources)); });
  owners.of_tile = deal_tiles(graph.manifest().first_vertices(), a.deal, owners.ranks, distances);
  MpiTeam team(MPI_COMM_WORLD, graph, owners.of_tile, options.heat.accuracy);
  const TiledMapSummary s = team_log_map(graph, source, a.logmap.output, options, team, owners);
  if (team.rank() == 0) {
    print_map(s, graph.size(), coordinates);
    std::cout << "; vertices solved: " << s.march.solved << ", ranks: " << team.size() << "\n";
  }
  if (a.traffic) print_traffic(team);
}

/// Makes local maps tile by tile. Each rank takes the next tile when it is free, so no rank waits for another.
void make_local_maps(Arguments& a) {
  const TiledGraph graph = first_alone([&] {
    TiledGraph tiles(a.local.folder, a.local.memory);
    check_local_maps(tiles, a.local.options);
    return tiles;
  });
  std::int64_t next = 0, made = 0;
  std::int64_t* counter = nullptr;
  MPI_Win window = MPI_WIN_NULL;
  MPI_Win_allocate(rank_of() == 0 ? sizeof(std::int64_t) : 0, sizeof(std::int64_t), MPI_INFO_NULL, MPI_COMM_WORLD,
                   static_cast<void*>(&counter), &window);
  if (rank_of() == 0) *counter = 0;
  MPI_Barrier(MPI_COMM_WORLD);
  const std::int64_t one = 1;
  const auto take = [&] {
    MPI_Win_lock(MPI_LOCK_EXCLUSIVE, 0, 0, window);
    MPI_Fetch_and_op(&one, &next, MPI_INT64_T, 0, 0, MPI_SUM, window);
    MPI_Win_unlock(0, window);
    return static_cast<std::size_t>(next);
  };
  for (std::size_t tile = take(); tile < graph.tiles(); tile = take())
    made += write_local_maps(graph, tile, a.local.output, a.local.options) ? 1 : 0;
  MPI_Win_free(&window);
  const std::vector<std::int64_t> by_rank = of_all_ranks(made);
  if (rank_of() > 0) return;
  std::cout << "tiles written by each rank:";
  for (std::int64_t tiles : by_rank) std::cout << ' ' << tiles;
  std::cout << '\n';
}

void add_commands(CLI::App& app, Arguments& a) {
  const auto add_map = [&](const std::string& command, const std::string& text, bool coordinates) {
    CLI::App& map = *app.add_subcommand(command, text);
    add_march_options(map, a.logmap);
    if (coordinates) add_map_options(map, a.logmap);
    add_deal_option(map, a.deal);
    map.add_flag("--traffic", a.traffic, "print messages, bytes, memory and time of each rank");
    map.callback([&, coordinates] { make_map(a, coordinates); });
  };
  add_map("logmap", "make the log map with all ranks; resumes a killed run", true);
  add_map("distance", "make only the distances of logmap --variant localized, which is faster", false);
  CLI::App& local =
      *app.add_subcommand("local-maps", "make the map around every vertex; each rank works on one tile at a time");
  add_local_options(local, a.local);
  local.callback([&] { make_local_maps(a); });
}

/// Parses the command line and runs the command. @return the exit status
int run(const std::vector<std::string>& words) {
  Arguments a;
  CLI::App app(
      "Maps over tiles (ahm-tiles), computed by the ranks of an MPI run. Options after -- are passed to PETSc.", name);
  app.set_version_flag("--version", name + " " AHM_VERSION, "Print the version");
  app.require_subcommand(1);
  add_commands(app, a);
  a.local.options.maps.heat.threads = 1;
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& e) {
    if (rank_of() == 0) return app.exit(e) == 0 ? 0 : 2;
    return e.get_exit_code() == 0 ? 0 : 2;
  }
  return 0;
}

/// Prints an error and ends all ranks.
[[noreturn]] void fail(const char* what) {
  const std::string text = name + ": error: rank " + std::to_string(rank_of()) + ": " + what + "\n";
  std::cerr << text << std::flush;  // in one piece, because other ranks may fail at the same time
  MPI_Abort(MPI_COMM_WORLD, 1);
  std::abort();
}

/// Sets an option of PETSc unless the user has set it.
void set_default(const char* option, const char* value) {
  PetscBool is_set = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, nullptr, option, &is_set));
  if (is_set == PETSC_FALSE) check(PetscOptionsSetValue(nullptr, option, value));
}

int run_with_petsc(int argc, char** argv) {
  std::vector<std::string> words;
  int at = 1;
  for (; at < argc && std::string(argv[at]) != "--"; ++at) words.emplace_back(argv[at]);
  std::vector<char*> of_petsc{argv[0]};
  for (++at; at < argc; ++at) of_petsc.push_back(argv[at]);
  int count = static_cast<int>(of_petsc.size());
  of_petsc.push_back(nullptr);
  char** petsc = of_petsc.data();
  check(PetscInitialize(&count, &petsc, nullptr, nullptr));
  int status = 1;
  try {
    check(PetscPopSignalHandler());
    app::install_interrupt_handling(name);
    check(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr));
    set_default("-pc_type", "bjacobi");
    set_default("-sub_pc_type", "ilu");  // equivalent to icc for a symmetric matrix; icc crashes if a rank has no rows
    status = run(words);
  } catch (const std::bad_alloc&) {
    fail("out of memory; use more ranks on more machines, or plan smaller tiles");
  } catch (const std::exception& e) {
    fail(e.what());
  }
  check(PetscFinalize());
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_with_petsc(argc, argv);
  } catch (const std::exception& e) {
    std::cerr << name << ": error: " << e.what() << '\n';
  } catch (...) {
    std::cerr << name << ": error: unknown failure\n";
  }
  return 1;
}
