#include "ahm/applications/cells.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/subcommand.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

constexpr const char* cells_footer =
    "SOURCES is a list separated by blanks, or a file with one entry per line. An entry is a vertex of INPUT\n"
    "(123, counted from 0) or a position (1.5,0,-2: the nearest vertex; in files also 1.5 0 -2).\n"
    "\n"
    "OUTPUT  .csv, .jsonl, .ply, .pcd or .vtp; one row per vertex of INPUT, in the same order:\n"
    "        index,x,y,z,distance,status,label\n"
    "          label     number of the nearest source, counted from 0\n"
    "          distance  distance from that source along the surface\n"
    "\n"
    "Examples:\n"
    "  ahm cells scan.ply --count 40 -o cells.csv --view cells.png\n"
    "  ahm cells part.stl --sources '12 480 901' -o cells.ply";

struct CellsOptions {
  InputOptions input;
  bool is_exact = false;  ///< distances by straight lines over the faces instead of a wavefront
  OutputOptions output;
  std::vector<SourceSpec> sources;
  Index count = 0;  ///< number of spread sources; 0: use `sources`
  std::optional<SourceSpec> start;
};

ExactMapOptions exact_options(const CellsOptions& options, Journal& journal) {
  return {.progress = journal.progress(), .threads = options.input.threads};
}

/// The vertices of the graph at the sources.
/// @throws InvalidArgument (two sources at one vertex)
std::vector<Vertex> vertices_of(const Input& input, const std::vector<SourceSpec>& specs) {
  std::vector<Vertex> result;
  std::vector<bool> taken(static_cast<std::size_t>(input.graph().size()), false);
  for (const SourceSpec& spec : specs) {
    const Vertex vertex = vertex_at(input, spec, "--sources");
    if (taken[vertex.index])
      throw InvalidArgument(fmt::format("--sources {}: an earlier source is at the same vertex; list every vertex once",
                                        to_string(spec)));
    taken[vertex.index] = true;
    result.push_back(vertex);
  }
  return result;
}

/// Vertices that are spread over the surface, each the farthest from those before it.
/// @param geodesics  for exact distances; none: distances by the front
std::vector<Vertex> spread(const CellsOptions& options, const Input& input,
                           const std::optional<ExactGeodesics>& geodesics, std::optional<Wavefront>& front,
                           Journal& journal) {
  journal.start("spread");
  const std::vector<Vertex> among = vertices_with_rows(input.surface().rows());
  if (options.count > std::ssize(among))
    throw InvalidArgument(
        fmt::format("--count {}: larger than the number of vertices, {}", options.count, among.size()));
  if (options.start) comment_on_positions(input, std::span(&*options.start, 1), "--start", journal);
  const Vertex first =
      options.start ? vertex_at(input, *options.start, "--start") : first_vertex(input.surface().rows());
  return geodesics ? farthest_points(*geodesics, first, options.count, exact_options(options, journal), among)
                   : farthest_points(*front, first, options.count, journal.progress(), among);
}

/// Distance, cell and status of every row of the input.
struct CellRows {
  std::vector<double> distance, label;
  std::vector<Index> labels;  ///< -1: in no cell
  std::vector<Status> status;
};

/// Cells by row. A row with several vertices takes the vertex that is nearest to its source.
CellRows rows_of(const Input& input, const VoronoiCells& of_vertices) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto away = [&](Vertex v) { return of_vertices.distances[v.index]; };
  const std::size_t n = input.rows();
  CellRows cells{std::vector<double>(n, nan), std::vector<double>(n, nan), std::vector<Index>(n, -1), {}};
  const RowMap& rows = input.surface().rows();
  for (std::size_t r = 0; r < n; ++r) {
    const Row row(static_cast<Index>(r));
    const std::optional<Vertex> vertex = rows.least(row, away);
    cells.status.push_back(vertex ? Status::ok : rows.vertex(row) ? Status::disconnected : Status::removed);
    if (!vertex) continue;
    cells.distance[r] = of_vertices.distances[vertex->index];
    cells.label[r] = cells.labels[r] = of_vertices.labels[vertex->index];
  }
  return cells;
}

struct Cell {
  Index vertices = 0;
  double area = 0;  ///< world units squared; NaN where it overflows
};

std::vector<Cell> sizes(const TangentGraph& graph, const std::vector<Index>& labels, std::size_t count) {
  std::vector<Cell> cells(count);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] < 0) continue;
    Cell& cell = cells[labels[i]];
    ++cell.vertices;
    cell.area += graph.mass(static_cast<Index>(i));
  }
  for (Cell& cell : cells) cell.area = world_mass(graph, cell.area);
  return cells;
}

void write_results(const CellRows& rows, const std::vector<Vec3>& sources, Results& results, Journal& journal) {
  io::Table table = results.table();
  table.add("distance", rows.distance);
  table.add("status", rows.status);
  table.add("label", rows.label);
  render::Scene scene = results.scene();
  scene.labels = rows.labels;
  scene.distance = rows.distance;
  scene.source = sources.front();
  scene.dots = sources;
  render::PictureOptions picture;
  picture.pattern = render::Pattern::cells;
  results.write(table, scene, journal, picture);
}

void report(const CellsOptions& options, const Input& input, const std::vector<Index>& rows,
            const std::vector<Vec3>& positions, const std::vector<Cell>& cells, double farthest, Journal& journal) {
  nlohmann::ordered_json j = summary("ahm cells", options.input.path, options.output, input);
  const auto [smallest, largest] =
      std::minmax_element(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.area < b.area; });
  if (std::any_of(cells.begin(), cells.end(), [](const Cell& cell) { return std::isnan(cell.area); }))
    journal.add_warning("areas: the squares of the lengths overflow; they are written as nan");
  j["largest_distance"] = farthest;
  j["smallest_area"] = smallest->area;
  j["largest_area"] = largest->area;
  for (std::size_t k = 0; k < rows.size() && !options.output.json.empty(); ++k)  // 2 kB per source
    j["sources"].push_back({{"label", k},
                            {"row", rows[k]},
                            {"position", positions[k]},
                            {"vertices", cells[k].vertices},
                            {"area", cells[k].area}});
  const std::size_t shown = std::min<std::size_t>(rows.size(), 12);
  const std::string text =
      fmt::format("{} around {} {}{}\nareas {:.4g} to {:.4g}, farthest point {:.6g} from its source\n",
                  counted(rows.size(), "cell"), noun_after(rows.size(), "vertex"),
                  fmt::join(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(shown), " "),
                  shown < rows.size() ? " ..." : "", smallest->area, largest->area, farthest);
  deliver(std::move(j), text, options.output, journal);
}

void run(const CellsOptions& options) {
  check_results(options.input.path, options.output);
  Journal journal(options.output.verbosity);
  std::vector<SourceSpec> named = options.sources;
  if (options.start) named.push_back(*options.start);
  const Input input = open_input(with_named_points(options.input, named), journal);
  const TangentGraph& graph = input.graph();
  std::vector<Vertex> sources = vertices_of(input, options.sources);
  comment_on_positions(input, options.sources, "--sources", journal);
  std::optional<ExactGeodesics> geodesics;
  std::optional<Wavefront> front;
  if (options.is_exact)
    geodesics.emplace(input.surface());
  else
    front.emplace(graph, Wavefront::one_rings(graph, options.input.threads));
  if (options.count > 0) sources = spread(options, input, geodesics, front, journal);

  journal.start("cells");
  const VoronoiCells cells =
      geodesics ? voronoi_cells(*geodesics, sources, exact_options(options, journal)) : voronoi_cells(*front, sources);
  const CellRows rows = rows_of(input, cells);
  comment_on_statuses(rows.status, options.input.path, journal);

  std::vector<Index> source_rows;
  std::vector<Vec3> positions;
  for (Vertex vertex : sources) {
    source_rows.push_back(input.surface().rows().row(vertex).value_or(Row(-1)).index);
    positions.push_back(graph.frame(vertex.index)->origin);
  }
  double farthest = 0;
  for (double d : rows.distance) farthest = std::max(farthest, std::isnan(d) ? 0 : d);
  Results results(options.output, input, options.input);
  write_results(rows, positions, results, journal);
  report(options, input, source_rows, positions, sizes(graph, cells.labels, sources.size()), farthest, journal);
}

void offer(CLI::App& app, CellsOptions& o) {
  add_input(app, o.input);
  auto* sources = add_parsed(app, "--sources", o.sources, parse_sources, "SOURCES", "Sources: list or file, see below");
  auto* count = add_parsed(app, "--count", o.count, integer_parser(1), "K",
                           "Number of spread sources, each the farthest from those before it");
  add_parsed(app, "--start", o.start, parse_source, "SPEC", "First of the --count sources (default: the first row)")
      ->needs(count);
  app.callback([=] {
    if ((sources->count() > 0) == (count->count() > 0))
      throw CLI::ValidationError("--sources", "use either --sources or --count");
  });
  add_table_output(app, o.output)->required();
  add_parsed(app, "--method", o.is_exact, choice_of<bool>({{"wavefront", false}, {"exact", true}}), "NAME",
             "Distances by a wavefront over the graph: wavefront (default),\n"
             "or by straight lines over the faces of a mesh: exact");
  add_backend(app, o.input);
  add_threads(app, o.input);
  add_cloud_options(app, o.input);
  add_mesh_options(app, o.input);
  add_map_results(app, o.output);
}

}  // namespace

Subcommand add_cells(CLI::App& program) {
  return subcommand<CellsOptions>(program, "cells", "Geodesic Voronoi cells of listed or evenly spread points",
                                  cells_footer, offer, run);
}

}  // namespace ahm::app
