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
    "OUTPUT is a NumPy archive. The entries e of source s are indptr[s] <= e < indptr[s+1], nearest first:\n"
    "  sources[s]    row of the source in INPUT\n"
    "  frames[s]     u axis, v axis and normal of the source in space\n"
    "  indices[e]    row of the neighbor in INPUT\n"
    "  log[e]        coordinates u, v of the neighbor in the frame of the source\n"
    "  distance[e]   distance along the surface\n"
    "  transport[e]  complex number: multiplies u + iv in the source's frame to give the vector in the neighbor's\n"
    "                frame; 2 x 2 matrices on surfaces that are not orientable\n"
    "  weight[e]     area of the neighbor\n"
    "  quality[e]    with --quality: how reliable log[e] is, in (0, 1]\n"
    "With --pad the arrays have the shape sources x K instead, and mask is 1 for entries that exist.\n"
    "\n"
    "Example:\n"
    "  ahm local-maps scan.ply --radius 0.02 --k 32 --pad --float32 -o neighbors.npz";

struct LocalMapsOptions {
  InputOptions input;
  SolveOptions solve;
  OutputOptions output;
  double radius = 0;
  Index k = 0;                  ///< neighbors per source; 0: all
  std::string sources = "all";  ///< all, or a file of row numbers
  bool pad = false;             ///< write `k` entries per source and a mask instead of compressed rows
  bool float32 = false;
  bool quality = false;  ///< write the quality of each vector
};

void check_options(const LocalMapsOptions& options) {
  check_results(options.input.path, options.output, {".npz"});
  // The list is read later, when the number of rows is known, so no output may replace it.
  if (options.sources != "all")
    check_outputs({options.sources}, {{"--output", options.output.output}, {"--json", options.output.json}}, false);
  if (!io::has_npz()) throw InvalidArgument("this build of ahm cannot write .npz files; build it with minizip");
}

/// Reads row numbers, one per line.
std::vector<Row> read_rows(const std::string& path, Index rows) {
  const std::string name = "--sources " + path;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw IoError(name + ": cannot be read; write 'all' or the name of a file with row numbers");
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
            fmt::format("--sources {}: row {} is not a vertex of the surface; remove it from the list", options.sources,
                        row.index));
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

/// Compressed rows as rows of `count` entries, filled up with zeros.
/// @param values  `width` numbers per entry
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
  const auto k = static_cast<std::size_t>(options.k);
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
  if (options.quality) add("quality", maps.quality, {}, real);
  // Surfaces that are not orientable have 2 x 2 matrices, some of them reflections.
  add("transport", maps.transports, rotations ? Shape{} : Shape{2, 2}, rotations ? complex : real);
  file.commit();
}

/// Warns of a vertex with very many neighbors: each map by heat around it is solved on all of them.
void comment_on_hubs(const TangentGraph& graph, std::size_t sources, Journal& journal) {
  constexpr double long_work = 3e8;  // about a minute
  std::size_t most = 0;
  for (Index i = 0; i < graph.size(); ++i) most = std::max(most, graph.star(i).degree());
  if (const auto degree = static_cast<double>(most); degree * static_cast<double>(std::min(most, sources)) > long_work)
    journal.add_warning(
        fmt::format("a vertex has {} neighbors, and each map around it is solved on all of them: this takes long; "
                    "select fewer rows with --sources",
                    most));
}

/// Warns if most neighborhoods have no neighbors: the radius is in another unit, or too small for the edges.
void comment_on_lonely(const RowLocalMaps& maps, const LocalMapsOptions& options, const Input& input,
                       Journal& journal) {
  Index lonely = 0;
  for (Index s = 0; s < maps.sources(); ++s) lonely += maps.indptr[s + 1] - maps.indptr[s] == 1;
  if (options.radius > 0 && options.k != 1 && 2 * lonely > maps.sources())
    journal.add_warning(fmt::format(
        "--radius {}: neighborhoods without neighbors: {} of {}; the mean edge length is {:.4g}, raise --radius",
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

  LocalMapOptions map_options{.k = options.k, .method = options.solve.method};
  const Method method = suggested_method(input.surface(), map_options);
  if (method == Method::heat) comment_on_hubs(input.graph(), vertices.size(), journal);

  journal.start("solve");
  map_options.method = method;
  map_options.radius = options.radius;
  map_options.quality = options.quality;
  map_options.heat = options.solve.diffusion();
  map_options.memory = options.solve.memory;
  map_options.heat.progress = journal.progress();
  const std::vector<SurfacePoint> sources(wanted.begin(), wanted.end());
  const RowLocalMaps maps = row_local_maps(input.surface(), sources, map_options);

  if (std::any_of(maps.weights.begin(), maps.weights.end(), [](double w) { return std::isnan(w); }))
    journal.add_warning("weight: the squares of the lengths overflow; they are written as nan");

  comment_on_lonely(maps, options, input, journal);

  journal.start("write");
  write(options, maps, wanted, input.graph(), vertices);

  const double mean = static_cast<double>(maps.neighbors.size()) / static_cast<double>(wanted.size());
  nlohmann::ordered_json j = summary("ahm local-maps", options.input.path, options.output, input);
  j["method"] = to_string(method);
  if (options.radius > 0) j["radius"] = options.radius;
  j["sources"] = wanted.size();
  j["entries"] = maps.neighbors.size();
  j["mean_neighbors"] = mean;
  deliver(j,
          fmt::format("{} with {:.1f} vertices on average, method {}\n", counted(wanted.size(), "neighborhood"), mean,
                      to_string(method)),
          options.output, journal);
}

void offer(CLI::App& app, LocalMapsOptions& o) {
  add_input(app, o.input);
  add_parsed(app, "--radius", o.radius, parse_positive, "R", "Radius of the neighborhoods, along the surface");
  add_output(app, o.output)->required()->description("Output file, .npz");
  add_parsed(app, "--k", o.k, integer_parser(1), "K",
             "Keep the K nearest vertices, including the source; without --radius at any distance");
  add_parsed(app, "--sources", o.sources, non_empty, "all|FILE",
             "all (default), or a file with row numbers of INPUT, counted from 0");
  app.add_flag("--pad", o.pad, "Write K entries per source and a mask; requires --k");
  app.add_flag("--float32", o.float32, "Write numbers in single precision");
  app.add_flag("--quality", o.quality, "Also write how reliable each vector is");
  add_method(app, o.solve, {Method::polar}, true);
  add_variant(app, o.solve);
  add_backend(app, o.input);
  add_t_coef(app, o.solve);
  add_drop_nan(app, o.input);
  add_normals(app, o.input);
  add_smooth(app, o.input);
  add_mesh_options(app, o.input);
  add_threads(app, o.input, &o.solve);
  add_json(app, o.output);
  add_verbosity(app, o.output.verbosity);
  app.callback([&o] {
    if (o.radius == 0 && o.k == 0) throw CLI::RequiredError("--radius, or --k");
    if (o.pad && o.k == 0) throw CLI::ValidationError("--pad", "requires --k");
  });
}

}  // namespace

Subcommand add_local_maps(CLI::App& program) {
  return subcommand<LocalMapsOptions>(program, "local-maps",
                                      "Log maps of the neighborhood of each vertex, for learning on surfaces",
                                      local_maps_footer, offer, run);
}

}  // namespace ahm::app
