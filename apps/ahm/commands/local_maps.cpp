#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ahm/io/npz.hpp"
#include "ahm/surface/row_local_maps.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/solve.hpp"
#include "commands/subcommand.hpp"
#include "input/open.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

constexpr const char* local_maps_footer =
    "OUTPUT is a NumPy archive. Entry e of source s, indptr[s] <= e < indptr[s+1], nearest first:\n"
    "  sources[s]    row of INPUT             frames[s]     u axis, v axis and normal in space\n"
    "  indices[e]    row of the neighbour     log[e]        its coordinates u, v in the source's frame\n"
    "  distance[e]   along the surface        transport[e]  turns u + iv into the neighbour's frame\n"
    "  weight[e]     area of the neighbour\n"
    "With --pad the arrays are sources x K, and mask says what is there.\n"
    "\n"
    "Example:\n"
    "  ahm local-maps scan.ply --radius 0.02 --k 32 --pad --float32 -o neighbours.npz";

struct LocalMapsOptions {
  InputOptions input;
  SolveOptions solve;
  OutputOptions output;
  double radius = 0;
  Index nearest = 0;            ///< 0: all
  std::string sources = "all";  ///< or a file of row numbers
  bool pad = false;             ///< rows of `nearest` entries and a mask instead of compressed rows
  bool float32 = false;
};

void check_options(const LocalMapsOptions& options) {
  check_results(options.input.path, options.output, {".npz"});
  // The list is read once the number of rows is known, and must still be there then.
  if (options.sources != "all")
    check_outputs({options.sources}, {{"--output", options.output.output}, {"--json", options.output.json}}, false);
  if (!io::has_npz()) throw InvalidArgument("this build of ahm cannot write .npz files; it was built without minizip");
}

/// Row numbers, one per line.
std::vector<Row> read_rows(const std::string& path, Index rows) {
  const std::string name = "--sources " + path;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw IoError(name + ": cannot be read; write all, or the name of a file of row numbers");
  std::vector<Row> result;
  for_each_line(path, name, "row numbers", [&](const std::string& line) {
    result.emplace_back(static_cast<Index>(parse_integer(line, 0, rows - 1)));
  });
  return result;
}

std::vector<Row> wanted_rows(const LocalMapsOptions& options, const RowMap& rows) {
  if (options.sources != "all") {
    std::vector<Row> result = read_rows(options.sources, rows.row_count());
    for (Row row : result)
      if (!rows.vertex(row))
        throw InvalidArgument(
            fmt::format("--sources {}: row {} is no vertex of the surface", options.sources, row.index));
    return result;
  }
  std::vector<Row> result;
  for (Row row(0); row.index < rows.row_count(); ++row.index)
    if (rows.vertex(row)) result.push_back(row);
  return result;
}

std::vector<Index> numbers_of(const std::vector<Row>& rows) {
  std::vector<Index> numbers;
  numbers.reserve(rows.size());
  for (const Row row : rows) numbers.push_back(row.index);
  return numbers;
}

/// Rows of `count` entries: `values` has `width` numbers per entry, what is missing is 0.
template <class T>
std::vector<T> padded(const RowLocalMaps& maps, const std::vector<T>& values, std::size_t width, std::size_t count) {
  std::vector<T> result(static_cast<std::size_t>(maps.sources()) * count * width, T{});
  for (std::size_t s = 0; s < static_cast<std::size_t>(maps.sources()); ++s)
    std::copy(values.begin() + maps.indptr[s] * static_cast<Offset>(width),
              values.begin() + maps.indptr[s + 1] * static_cast<Offset>(width),
              result.begin() + static_cast<std::ptrdiff_t>(s * count * width));
  return result;
}

void write(const LocalMapsOptions& options, const RowLocalMaps& maps, const std::vector<Row>& rows,
           const TangentGraph& graph, const std::vector<Vertex>& vertices) {
  const std::size_t sources = rows.size(), entries = maps.neighbors.size();
  const auto k = static_cast<std::size_t>(options.nearest);
  const auto real = options.float32 ? io::NpyType::float32 : io::NpyType::float64;
  const auto complex = options.float32 ? io::NpyType::complex64 : io::NpyType::complex128;
  const bool rotations = maps.kind == TransportKind::rotation2;
  io::NpzFile file(options.output.output);
  file.add("sources", {sources}, std::span<const Index>(numbers_of(rows)));
  std::vector<double> frames;
  for (const auto [vertex] : vertices) {
    const Frame frame = *graph.frame(vertex);
    for (const Vec3& axis : {frame.x, frame.y, frame.normal}) frames.insert(frames.end(), axis.begin(), axis.end());
  }
  file.add("frames", {sources, 3, 3}, frames, real);
  using Shape = std::vector<std::size_t>;
  auto add = [&](const std::string& name, const std::vector<double>& values, const Shape& element, io::NpyType type) {
    Shape shape = options.pad ? Shape{sources, k} : Shape{entries};
    shape.insert(shape.end(), element.begin(), element.end());
    const std::size_t width = values.size() / std::max<std::size_t>(entries, 1);
    file.add(name, shape, options.pad ? padded(maps, values, width, k) : values, type);
  };
  if (options.pad) {
    file.add("indices", {sources, k}, std::span<const Index>(padded(maps, numbers_of(maps.neighbors), 1, k)));
    file.add("mask", {sources, k},
             std::span<const std::uint8_t>(padded(maps, std::vector<std::uint8_t>(entries, 1), 1, k)));
  } else {
    file.add("indptr", {sources + 1}, std::span<const Offset>(maps.indptr));
    file.add("indices", {entries}, std::span<const Index>(numbers_of(maps.neighbors)));
  }
  add("log", maps.logs, {2}, real);
  add("distance", maps.distances, {}, real);
  add("weight", maps.weights, {}, real);
  // Surfaces that cannot be oriented carry 2 x 2 matrices, some of them reflections.
  add("transport", maps.transports, rotations ? Shape{} : Shape{2, 2}, rotations ? complex : real);
  file.commit();
}

/// Maps around a vertex of very many neighbours are each solved on all of these.
void comment_on_hubs(const TangentGraph& graph, std::size_t sources, Journal& journal) {
  constexpr double long_work = 3e8;  // a minute
  std::size_t most = 0;
  for (Index i = 0; i < graph.size(); ++i) most = std::max(most, graph.star(i).degree());
  if (const auto degree = static_cast<double>(most); degree * static_cast<double>(std::min(most, sources)) > long_work)
    journal.add_warning(
        fmt::format("a vertex has {} neighbours, and each map around it is solved on all of them: this takes long; "
                    "choose --sources",
                    most));
}

/// Radii in other units, or of too few edges, are seen by neighbourhoods without neighbours.
void comment_on_lonely(const RowLocalMaps& maps, const LocalMapsOptions& options, const Input& input,
                       Journal& journal) {
  Index lonely = 0;
  for (Index s = 0; s < maps.sources(); ++s) lonely += maps.indptr[s + 1] - maps.indptr[s] == 1;
  if (options.radius > 0 && options.nearest != 1 && 2 * lonely > maps.sources())
    journal.add_warning(
        fmt::format("--radius {}: {} of {} neighbourhoods hold their source alone; edges are {:.4g} long in the mean",
                    options.radius, lonely, maps.sources(), input.mean_edge_length()));
}

void run(const LocalMapsOptions& options) {
  check_options(options);
  Journal journal(options.output.verbosity);
  const Input input = open_input(options.input, journal);
  const RowMap& rows = input.surface().rows();
  const std::vector<Row> wanted = wanted_rows(options, rows);
  std::vector<Vertex> vertices;
  for (Row row : wanted) vertices.push_back(*rows.vertex(row));

  comment_on_hubs(input.graph(), vertices.size(), journal);

  journal.start("solve");
  LocalMapOptions map_options;
  map_options.radius = options.radius;
  map_options.nearest = options.nearest;
  map_options.heat = options.solve.diffusion();
  map_options.memory = options.solve.memory;
  map_options.heat.progress = journal.progress();
  const RowLocalMaps maps = row_local_maps(input.surface(), vertices, map_options);

  if (std::any_of(maps.weights.begin(), maps.weights.end(), [](double w) { return std::isnan(w); }))
    journal.add_warning("weight: no double holds squares of such lengths; they are given as nan");

  comment_on_lonely(maps, options, input, journal);

  journal.start("write");
  write(options, maps, wanted, input.graph(), vertices);

  const double mean = static_cast<double>(maps.neighbors.size()) / static_cast<double>(wanted.size());
  nlohmann::ordered_json j = summary("ahm local-maps", options.input.path, options.output, input);
  if (options.radius > 0) j["radius"] = options.radius;
  j["sources"] = wanted.size();
  j["entries"] = maps.neighbors.size();
  j["mean_neighbours"] = mean;
  deliver(j, fmt::format("{} of {:.1f} vertices on average\n", counted(wanted.size(), "neighbourhood"), mean),
          options.output, journal);
}

void offer(CLI::App& app, LocalMapsOptions& o) {
  add_input(app, o.input);
  add_parsed(app, "--radius", o.radius, parse_positive, "R", "Of the neighbourhoods, along the surface");
  add_output(app, o.output)->required()->description("File to write, .npz");
  add_parsed(app, "--k", o.nearest, integer_parser(1), "K",
             "Keep only so many nearest, the source included; without --radius: however far they are");
  add_parsed(app, "--sources", o.sources, non_empty, "all|FILE",
             "all (default), or a file of rows of INPUT, counted from 0");
  app.add_flag("--pad", o.pad, "Fixed rows of K entries and a mask; needs --k");
  app.add_flag("--float32", o.float32, "Numbers in single precision");
  add_variant(app, o.solve);
  add_backend(app, o.input);
  add_t_coef(app, o.solve);
  add_drop_nan(app, o.input);
  add_normals(app, o.input);
  add_mesh_options(app, o.input);
  add_threads(app, o.input, &o.solve);
  add_json(app, o.output);
  add_verbosity(app, o.output.verbosity);
  app.callback([&o] {
    if (o.radius == 0 && o.nearest == 0) throw CLI::RequiredError("--radius, or --k");
    if (o.pad && o.nearest == 0) throw CLI::ValidationError("--pad", "needs --k");
  });
}

}  // namespace

Subcommand add_local_maps(CLI::App& program) {
  return subcommand<LocalMapsOptions>(program, "local-maps", "Log maps of all neighbourhoods, for learning on surfaces",
                                      local_maps_footer, offer, run);
}

}  // namespace ahm::app
