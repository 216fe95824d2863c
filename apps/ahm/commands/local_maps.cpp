#include "ahm/maps/local_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "ahm/io/npz.hpp"
#include "cli/numbers.hpp"
#include "cli/option_adders.hpp"
#include "commands/commands.hpp"
#include "input/surface.hpp"
#include "output/output_paths.hpp"

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
  RunOptions run;  ///< a part of it
  double radius = 0;
  Index nearest = 0;            ///< 0: all
  std::string sources = "all";  ///< or a file of row numbers
  bool pad = false;             ///< rows of `nearest` entries and a mask instead of compressed rows
  bool float32 = false;
};

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

void check_options(const LocalMapsOptions& options) {
  const RunOptions& o = options.run;
  check_outputs(o.input, {{"--output", o.output}, {"--json", o.json}});
  if (extension_of(o.output) != ".npz")
    throw InvalidArgument(fmt::format("--output {}: the name must end in .npz", o.output));
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
  std::ifstream file(path);
  if (!file) throw IoError("--sources " + path + ": cannot be read; write all, or the name of a file of row numbers");
  std::vector<Index> result;
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const auto first = line.find_first_not_of(" \t\r"), last = line.find_last_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    try {
      result.push_back(static_cast<Index>(
          parse_integer(line.substr(first, last - first + 1), 0, static_cast<std::int64_t>(rows) - 1)));
    } catch (const std::invalid_argument& e) {
      throw InvalidArgument(fmt::format("--sources {}, line {}: {}", path, number, e.what()));
    }
  }
  if (result.empty()) throw InvalidArgument("--sources " + path + ": holds no row numbers");
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

void write(const LocalMapsOptions& options, const LocalMaps& maps, const std::vector<Index>& rows, const Model& model,
           const std::vector<Vertex>& vertices) {
  const std::size_t sources = rows.size(), entries = maps.indices.size();
  const auto k = static_cast<std::size_t>(options.nearest);
  const auto real = options.float32 ? io::NpyType::float32 : io::NpyType::float64;
  const auto complex = options.float32 ? io::NpyType::complex64 : io::NpyType::complex128;
  const bool rotations = maps.kind == TransportKind::rotation2;
  io::NpzFile file(options.run.output);
  file.add("sources", {sources}, std::span<const Index>(rows));
  std::vector<double> frames;
  for (const auto [vertex] : vertices) {
    const Frame frame = *model.graph().frame(vertex);
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

void run_local_maps(const LocalMapsOptions& options) {
  check_options(options);
  Journal journal(options.run.verbose);
  RunOptions run = options.run;
  run.source = SourcePosition{{0, 0, 0}};  // none: the backends check it against the input
  const Surface surface = open_surface(run, journal);
  const auto& [input, backend, model] = surface;
  const Rows rows(*model, input.points.size());
  const std::vector<Index> wanted = wanted_rows(options, rows);
  std::vector<Vertex> vertices;
  for (Index row : wanted) vertices.emplace_back(rows.vertex_of_row[row]);

  journal.start("solve");
  LocalMapOptions map_options;
  map_options.radius = options.radius;
  const bool has_virtual = std::count(rows.row_of_vertex.begin(), rows.row_of_vertex.end(), -1) > 0;
  map_options.nearest = has_virtual ? 0 : options.nearest;
  map_options.variant = options.run.variant;
  map_options.t_coef = options.run.t_coef;
  map_options.threads = options.run.threads;
  map_options.progress = journal.progress();
  LocalMaps maps = local_maps(model->graph(), vertices, map_options);
  keep_rows(maps, rows, options.nearest);

  journal.start("write");
  write(options, maps, wanted, *model, vertices);
  journal.finish();
  journal.clear_display();

  const double mean = static_cast<double>(maps.indices.size()) / static_cast<double>(wanted.size());
  nlohmann::ordered_json j = summary("ahm local-maps", options.run, surface);
  j["radius"] = options.radius;
  j["sources"] = wanted.size();
  j["entries"] = maps.indices.size();
  j["mean_neighbours"] = mean;
  deliver(j, fmt::format("{} neighbourhoods of {:.1f} vertices on average\n", wanted.size(), mean), options.run,
          journal);
}

}  // namespace

Subcommand add_local_maps(CLI::App& program) {
  const auto options = std::make_shared<LocalMapsOptions>();
  LocalMapsOptions& o = *options;
  CLI::App& local = *program.add_subcommand("local-maps", "Log maps of all neighbourhoods, for learning on surfaces");
  add_input(local, o.run.input);
  add_parsed(local, "--radius", o.radius, parse_positive, "R", "Of the neighbourhoods, along the surface")->required();
  add_parsed(local, "-o,--output", o.run.output, non_empty, "OUTPUT", "File to write, .npz")->required();
  add_parsed(local, "--k", o.nearest, integer_parser(1), "K", "Keep only so many nearest, the source included");
  add_parsed(local, "--sources", o.sources, non_empty, "all|FILE",
             "all (default), or a file of rows of INPUT, counted from 0");
  local.add_flag("--pad", o.pad, "Fixed rows of K entries and a mask; needs --k");
  local.add_flag("--float32", o.float32, "Numbers in single precision");
  add_variant(local, o.run);
  add_backend(local, o.run);
  add_t_coef(local, o.run);
  add_drop_nan(local, o.run);
  add_non_manifold(local, o.run);
  add_threads(local, o.run.threads);
  add_json(local, o.run);
  add_verbose(local, o.run);
  local.callback([&o] {
    if (o.pad && o.nearest == 0) throw CLI::ValidationError("--pad", "needs --k");
  });
  local.footer(local_maps_footer);
  return {&local, [options] { run_local_maps(*options); }};
}

}  // namespace ahm::app
