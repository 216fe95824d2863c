#include "ahm/maps/local_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ahm/io/npz.hpp"
#include "cli/numbers.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/solve.hpp"
#include "commands/subcommand.hpp"
#include "input/open.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"

namespace ahm::app {
namespace {

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

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

void check_options(const LocalMapsOptions& options) {
  check_results(options.input.path, options.output, {".npz"});
  if (!io::has_npz()) throw InvalidArgument("this build of ahm cannot write .npz files; it was built without minizip");
}

/// Which vertex stands for a row, and the other way round; -1: none. The first counts.
struct Rows {
  std::vector<Index> vertex_of_row, row_of_vertex;

  Rows(const Model& model, std::size_t rows) : vertex_of_row(rows, -1), row_of_vertex(at(model.graph().size()), -1) {
    for (const auto& [row, vertex] : model.row_vertices()) {
      if (vertex_of_row[row] < 0) vertex_of_row[row] = vertex;
      if (row_of_vertex[vertex] < 0) row_of_vertex[vertex] = row;
    }
  }
};

/// Row numbers, one per line.
std::vector<Index> read_rows(const std::string& path, std::size_t rows) {
  const std::string name = "--sources " + path;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw IoError(name + ": cannot be read; write all, or the name of a file of row numbers");
  std::vector<Index> result;
  for_each_line(path, name, "row numbers", [&](const std::string& line) {
    result.push_back(static_cast<Index>(parse_integer(line, 0, static_cast<std::int64_t>(rows) - 1)));
  });
  return result;
}

std::vector<Index> wanted_rows(const LocalMapsOptions& options, const Rows& rows) {
  if (options.sources != "all") {
    std::vector<Index> result = read_rows(options.sources, rows.vertex_of_row.size());
    for (Index row : result)
      if (rows.vertex_of_row[row] < 0)
        throw InvalidArgument(fmt::format("--sources {}: row {} is no vertex of the surface", options.sources, row));
    return result;
  }
  std::vector<Index> result;
  for (std::size_t row = 0; row < rows.vertex_of_row.size(); ++row)
    if (rows.vertex_of_row[row] >= 0) result.push_back(static_cast<Index>(row));
  return result;
}

/// Entries on rows of the input, at most `most` per source (0: all): those on virtual vertices are left out.
void keep_rows(LocalMaps& maps, const Rows& rows, Index most) {
  const std::size_t width = maps.transport_width();
  std::size_t kept = 0;
  for (std::size_t s = 0; s + 1 < maps.indptr.size(); ++s) {
    const auto begin = static_cast<std::size_t>(maps.indptr[s]), end = static_cast<std::size_t>(maps.indptr[s + 1]);
    maps.indptr[s] = static_cast<Offset>(kept);
    for (std::size_t e = begin; e < end; ++e) {
      const Index row = rows.row_of_vertex[maps.indices[e]];
      const auto taken = static_cast<Offset>(kept) - maps.indptr[s];
      if (row < 0 || (most > 0 && taken == most)) continue;
      maps.indices[kept] = row;
      maps.distances[kept] = maps.distances[e];
      maps.weights[kept] = maps.weights[e];
      std::copy_n(maps.logs.begin() + static_cast<std::ptrdiff_t>(2 * e), 2,
                  maps.logs.begin() + static_cast<std::ptrdiff_t>(2 * kept));
      std::copy_n(maps.transports.begin() + static_cast<std::ptrdiff_t>(width * e), width,
                  maps.transports.begin() + static_cast<std::ptrdiff_t>(width * kept));
      ++kept;
    }
  }
  maps.indptr.back() = static_cast<Offset>(kept);
  maps.indices.resize(kept);
  maps.distances.resize(kept);
  maps.weights.resize(kept);
  maps.logs.resize(2 * kept);
  maps.transports.resize(width * kept);
}

/// Rows of `count` entries: `values` has `width` numbers per entry, what is missing is 0.
template <class T>
std::vector<T> padded(const LocalMaps& maps, const std::vector<T>& values, std::size_t width, std::size_t count) {
  std::vector<T> result(at(maps.sources()) * count * width, T{});
  for (std::size_t s = 0; s < at(maps.sources()); ++s)
    std::copy(values.begin() + maps.indptr[s] * static_cast<Offset>(width),
              values.begin() + maps.indptr[s + 1] * static_cast<Offset>(width),
              result.begin() + static_cast<std::ptrdiff_t>(s * count * width));
  return result;
}

void write(const LocalMapsOptions& options, const LocalMaps& maps, const std::vector<Index>& rows,
           const TangentGraph& graph, const std::vector<Vertex>& vertices) {
  const std::size_t sources = rows.size(), entries = maps.indices.size();
  const auto k = static_cast<std::size_t>(options.nearest);
  const auto real = options.float32 ? io::NpyType::float32 : io::NpyType::float64;
  const auto complex = options.float32 ? io::NpyType::complex64 : io::NpyType::complex128;
  const bool rotations = maps.kind == TransportKind::rotation2;
  io::NpzFile file(options.output.output);
  file.add("sources", {sources}, std::span<const Index>(rows));
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
    file.add("indices", {sources, k}, std::span<const Index>(padded(maps, maps.indices, 1, k)));
    file.add("mask", {sources, k},
             std::span<const std::uint8_t>(padded(maps, std::vector<std::uint8_t>(entries, 1), 1, k)));
  } else {
    file.add("indptr", {sources + 1}, std::span<const Offset>(maps.indptr));
    file.add("indices", {entries}, std::span<const Index>(maps.indices));
  }
  add("log", maps.logs, {2}, real);
  add("distance", maps.distances, {}, real);
  add("weight", maps.weights, {}, real);
  // Surfaces that cannot be oriented carry 2 x 2 matrices, some of them reflections.
  add("transport", maps.transports, rotations ? Shape{} : Shape{2, 2}, rotations ? complex : real);
  file.commit();
}

void run(const LocalMapsOptions& options) {
  check_options(options);
  Journal journal(options.output.verbose);
  const Input input = open_input(options.input, journal);
  const Rows rows(*input.surface, input.rows());
  const std::vector<Index> wanted = wanted_rows(options, rows);
  std::vector<Vertex> vertices;
  for (Index row : wanted) vertices.emplace_back(rows.vertex_of_row[row]);

  journal.start("solve");
  LocalMapOptions map_options;
  map_options.radius = options.radius;
  const bool has_virtual = std::count(rows.row_of_vertex.begin(), rows.row_of_vertex.end(), -1) > 0;
  map_options.nearest = has_virtual ? 0 : options.nearest;
  map_options.heat = {.t_coef = options.solve.t_coef,
                      .variant = options.solve.variant,
                      .threads = options.solve.threads,
                      .progress = journal.progress()};
  LocalMaps maps = local_maps(input.graph(), vertices, map_options);
  keep_rows(maps, rows, options.nearest);

  journal.start("write");
  write(options, maps, wanted, input.graph(), vertices);

  const double mean = static_cast<double>(maps.indices.size()) / static_cast<double>(wanted.size());
  nlohmann::ordered_json j = summary("ahm local-maps", options.input.path, options.output, input);
  j["radius"] = options.radius;
  j["sources"] = wanted.size();
  j["entries"] = maps.indices.size();
  j["mean_neighbours"] = mean;
  deliver(j, fmt::format("{} neighbourhoods of {:.1f} vertices on average\n", wanted.size(), mean), options.output,
          journal);
}

void offer(CLI::App& app, LocalMapsOptions& o) {
  add_input(app, o.input);
  add_parsed(app, "--radius", o.radius, parse_positive, "R", "Of the neighbourhoods, along the surface")->required();
  add_parsed(app, "-o,--output", o.output.output, non_empty, "OUTPUT", "File to write, .npz")->required();
  add_parsed(app, "--k", o.nearest, integer_parser(1), "K", "Keep only so many nearest, the source included");
  add_parsed(app, "--sources", o.sources, non_empty, "all|FILE",
             "all (default), or a file of rows of INPUT, counted from 0");
  app.add_flag("--pad", o.pad, "Fixed rows of K entries and a mask; needs --k");
  app.add_flag("--float32", o.float32, "Numbers in single precision");
  add_variant(app, o.solve);
  add_backend(app, o.input);
  add_t_coef(app, o.solve);
  add_drop_nan(app, o.input);
  add_non_manifold(app, o.input);
  add_threads(app, o.input, &o.solve);
  add_json(app, o.output);
  add_verbose(app, o.output);
  app.callback([&o] {
    if (o.pad && o.nearest == 0) throw CLI::ValidationError("--pad", "needs --k");
  });
}

}  // namespace

Subcommand add_local_maps(CLI::App& program) {
  return subcommand<LocalMapsOptions>(program, "local-maps", "Log maps of all neighbourhoods, for learning on surfaces",
                                      local_maps_footer, offer, run);
}

}  // namespace ahm::app
