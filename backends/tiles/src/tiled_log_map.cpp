#include "tiled_log_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "ahm/maps/straight_line.hpp"
#include "ahm/util/vec.hpp"
#include "map_writer.hpp"
#include "maps/affine_heat.hpp"
#include "maps/streamed_log_map.hpp"
#include "row_values.hpp"
#include "tile_distances.hpp"

namespace ahm::tiles {
namespace {

std::uint64_t identity_of(const TiledGraph& graph, const Source& source) {
  std::vector<std::uint64_t> parts = graph.manifest().identity(0);
  const auto add = [&](auto values) { parts.push_back(checksum(std::as_bytes(values))); };
  add(source.vertices()), add(source.weights()), add(source.offsets()), add(source.axes());
  return checksum(std::as_bytes(std::span(parts)));
}

/// Identity of a map: the graph, the source and the options, without the number of ranks.
std::uint64_t identity_of(std::uint64_t graph_and_source, const TiledMapOptions& options) {
  std::vector<std::uint64_t> parts{graph_and_source};
  const HeatOptions& heat = options.heat;
  for (double x : {heat.t_coef, heat.accuracy, options.radius}) parts.push_back(std::bit_cast<std::uint64_t>(x));
  parts.push_back(static_cast<std::uint64_t>(options.coordinates ? static_cast<int>(heat.variant) : -1));
  return checksum(std::as_bytes(std::span(parts)));
}

nlohmann::json as_json(const TiledMapSummary& s, const TiledGraph& graph, const Source& source,
                       const TiledMapOptions& options) {
  nlohmann::json sources = nlohmann::json::array();
  for (Vertex vertex : source.vertices()) sources.push_back(vertex.index);
  nlohmann::json whole{
      {"vertices", graph.size()},
      {"source_vertices", sources},
      {"coordinates", options.coordinates},
      {"variant", std::string(to_string(options.coordinates ? options.heat.variant : Variant::localized))},
      {"t_coef", options.heat.t_coef},
      {"ok", s.ok},
      {"farthest", s.farthest},
      {"bands", s.march.bands},
      {"largest_band", s.march.largest_band},
      {"solved", s.march.solved}};
  if (std::isfinite(options.radius)) whole["radius"] = options.radius;
  return whole;
}

void check(const TiledGraph& graph, const Source& source, const TiledMapOptions& options) {
  if (options.checkpoint < 0)
    throw InvalidArgument("checkpoint is " + std::to_string(options.checkpoint) + "; it must be at least 0");
  check_streamed_map(graph, source, options.heat, {.radius = options.radius});
}

}  // namespace

TiledMapSummary write_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                              const TiledMapOptions& options) {
  SingleMember team(graph.dimension());
  return team_log_map(graph, source, folder, options, team, {0, 1, std::vector<int>(graph.tiles(), 0)});
}

TiledMapSummary team_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                             const TiledMapOptions& options, MarchTeam& team, const TileOwners& owners) {
  check(graph, source, options);
  std::filesystem::create_directories(folder);
  const auto first_alone = [&](const auto& task) {  // runs on the first member, while the others wait
    if (owners.rank == 0) task();
    team.sum(0);
  };
  const std::uint64_t input = identity_of(graph, source);
  MapCheckpoint checkpoint(folder, identity_of(input, options), options.checkpoint, graph, team, owners);
  first_alone([&] { std::filesystem::remove(folder / "map.json"); });

  const std::filesystem::path distances_folder = folder / "distances";
  std::optional<TileDistances> distances;
  if (unfolds(graph, source)) {
    first_alone([&] {
      find_distances(graph, source, options.radius, distances_folder, options.memory, input, options.heat.progress);
    });
    distances.emplace(graph, distances_folder);
  }
  const MarchGoal goal = options.coordinates ? MarchGoal::map : MarchGoal::distances;
  MapWriter writer(graph, folder, goal, options.memory, owners);
  checkpoint.keep(writer);
  TiledMapSummary s;
  const std::int64_t releases = graph.releases();
  s.march = ahm::team_log_map(graph, source, options.heat, {.radius = options.radius}, writer, team,
                              {.goal = goal, .keeper = &checkpoint, .distances = distances ? &*distances : nullptr});
  writer.finish(source, options.radius);
  s.begun_at = checkpoint.begun_at();
  s.ok = team.sum(writer.ok());
  s.farthest = team.greatest(writer.farthest());
  s.spills = team.sum(writer.spills());
  s.releases = team.sum(graph.releases() - releases);
  // All members have written their tiles.
  first_alone([&] {
    write_finished(folder, as_json(s, graph, source, options));
    std::filesystem::remove_all(distances_folder);
  });
  checkpoint.remove();
  return s;
}

namespace {

/// Position of the source of a map with a single source, world units; otherwise none.
std::optional<Vec3> place_of_source(const TiledGraph& graph, const nlohmann::json& summary) {
  const auto sources = summary.value("source_vertices", std::vector<Index>());
  if (sources.size() != 1 || sources[0] < 0 || sources[0] >= graph.size()) return std::nullopt;
  return source_position(graph, Source::at_vertex(Vertex(sources[0])));
}

}  // namespace

void write_rows(const TiledGraph& graph, const std::filesystem::path& folder, const std::filesystem::path& csv) {
  const nlohmann::json whole = read_finished(folder);
  if (!whole.is_object() || whole.value("vertices", Index{-1}) != graph.size())
    throw IoError("cannot read '" + (folder / "map.json").string() +
                  "': the map is not finished, or belongs to other tiles");
  const MarchGoal goal = whole.value("coordinates", true) ? MarchGoal::map : MarchGoal::distances;
  const std::optional<Vec3> source = place_of_source(graph, whole);
  const double radius = whole.value("radius", std::numeric_limits<double>::infinity());
  const std::string none = goal == MarchGoal::distances ? ",," : ",,,,,";
  io::AtomicFile file(csv);
  file.write(goal == MarchGoal::distances ? "row,distance,status\n" : "row,u,v,distance,spread,status\n");
  RowLines lines(file, graph);
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    const MapTile tile(Manifest::file(folder, MapTile::kind, t), goal);
    const TiledGraph::TileRows rows = graph.rows(t);
    if (tile.status.size() + 1 != rows.begin.size())
      throw IoError("the map's tile " + std::to_string(t) + " belongs to other tiles; make the map again");
    const auto line_of = [&](std::size_t i) -> VertexLine {
      // As in `Surface::to_rows`: computed distances may be below the straight-line distance, which is a lower bound.
      const double d = bounded_distance(source ? ahm::distance(rows.positions[i], *source) : 0, tile.distance[i]);
      if (d > radius) return {none + std::string(to_string(Status::beyond_radius)), tile.distance[i]};
      std::string line;
      const auto add = [&](double number) { append_number(line += ',', number); };
      if (goal == MarchGoal::map) add(tile.coordinates[2 * i]), add(tile.coordinates[2 * i + 1]);
      add(d);
      if (goal == MarchGoal::map) add(tile.spread[i]);
      return {line + "," + std::string(to_string(static_cast<Status>(tile.status[i]))), tile.distance[i]};
    };
    lines.add(rows, line_of, none + std::string(to_string(Status::removed)));
  }
  lines.finish();
  file.commit();
}

}  // namespace ahm::tiles
