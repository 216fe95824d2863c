#include "ahm/distributed/tiled_log_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "ahm/maps/place_in_space.hpp"
#include "ahm/util/vec.hpp"
#include "csv_rows.hpp"
#include "map_checkpoint.hpp"
#include "map_writer.hpp"
#include "maps/team_log_map.hpp"
#include "team_map.hpp"

namespace ahm::distributed {
namespace {

/// What the map is made of, and by whom.
std::uint64_t identity_of(const TiledGraph& graph, const Source& source, const TiledMapOptions& options,
                          const TileOwners& owners) {
  std::vector<std::uint64_t> parts = graph.manifest().identity(0);
  const auto add = [&](auto values) { parts.push_back(checksum(std::as_bytes(values))); };
  add(source.vertices()), add(source.weights()), add(source.offsets()), add(source.axes());
  add(std::span(owners.of_tile));
  const HeatOptions& heat = options.heat;
  for (double x : {heat.t_coef, heat.accuracy, options.radius}) parts.push_back(std::bit_cast<std::uint64_t>(x));
  for (int x : {options.coordinates ? static_cast<int>(heat.variant) : -1, owners.ranks})
    parts.push_back(static_cast<std::uint64_t>(x));
  return checksum(std::as_bytes(std::span(parts)));
}

/// That the map is finished, and what it is.
void write_summary(const TiledMapSummary& s, const TiledGraph& graph, const Source& source,
                   const std::filesystem::path& folder, const TiledMapOptions& options) {
  nlohmann::json sources = nlohmann::json::array();
  for (Vertex vertex : source.vertices()) sources.push_back(vertex.index);
  const nlohmann::json whole{
      {"version", format_version},
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
  io::AtomicFile file(folder / "map.json");
  file.write(whole.dump(1) + "\n");
  file.commit();
}

}  // namespace

TiledMapSummary write_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                              const TiledMapOptions& options) {
  Alone alone(graph.dimension());
  return team_log_map(graph, source, folder, options, alone, {0, 1, std::vector<int>(graph.tiles(), 0)});
}

TiledMapSummary team_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                             const TiledMapOptions& options, MarchTeam& team, const TileOwners& owners) {
  if (options.checkpoint < 0)
    throw InvalidArgument("checkpoint is " + std::to_string(options.checkpoint) + "; it must be at least 0 bands");
  std::filesystem::create_directories(folder);
  const MarchGoal goal = options.coordinates ? MarchGoal::map : MarchGoal::distances;
  MapWriter writer(graph, folder, goal, options.memory, owners);
  MapCheckpoint checkpoint(folder, identity_of(graph, source, options, owners), options.checkpoint, writer, team,
                           owners);
  if (owners.rank == 0) std::filesystem::remove(folder / "map.json");
  TiledMapSummary s;
  s.march = ahm::team_log_map(graph, source, options.heat, {.radius = options.radius}, writer, team, goal, &checkpoint);
  writer.finish(source, options.radius);
  s.begun_at = checkpoint.begun_at();
  s.ok = team.sum(writer.ok());
  s.farthest = team.greatest(writer.farthest());
  s.spills = team.sum(writer.spills());
  s.releases = team.sum(graph.releases());
  if (owners.rank == 0) write_summary(s, graph, source, folder, options);
  checkpoint.remove();
  return s;
}

namespace {

/// Where a map of one source has it.
std::optional<Vec3> place_of_source(const TiledGraph& graph, const nlohmann::json& summary) {
  const auto sources = summary.value("source_vertices", std::vector<Index>());
  if (sources.size() != 1 || sources[0] < 0 || sources[0] >= graph.size()) return std::nullopt;
  return place_in_space(graph, Source::at_vertex(Vertex(sources[0])));
}

}  // namespace

void write_rows(const TiledGraph& graph, const std::filesystem::path& folder, const std::filesystem::path& csv) {
  std::ifstream summary(folder / "map.json");
  const auto whole = nlohmann::json::parse(summary, nullptr, false);
  if (whole.is_discarded() || whole.value("vertices", Index{-1}) != graph.size())
    throw IoError("cannot read '" + (folder / "map.json").string() +
                  "': the map is not finished, or not one of these tiles");
  const MarchGoal goal = whole.value("coordinates", true) ? MarchGoal::map : MarchGoal::distances;
  const std::optional<Vec3> source = graph.is_delaunay() ? std::nullopt : place_of_source(graph, whole);
  io::AtomicFile file(csv);
  file.write(goal == MarchGoal::map ? "row,u,v,distance,spread,status\n" : "row,distance,status\n");
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    const MapTile tile(Manifest::file(folder, MapTile::kind, t), goal);
    const TiledGraph::TileRows rows = graph.rows(t);
    if (tile.status.size() + 1 != rows.begin.size())
      throw IoError("the map's tile " + std::to_string(t) + " is not one of these tiles; make the map again");
    const auto values = [&](std::size_t i) {
      // As on the rows of a surface: distances of heat may be below the straight line, which no way on it is.
      const double d = source && !std::isnan(tile.distance[i])
                           ? std::max(tile.distance[i], ahm::distance(rows.positions[i], *source))
                           : tile.distance[i];
      std::string line;
      const auto add = [&](double number) { append_number(line += ',', number); };
      if (goal == MarchGoal::map) add(tile.coordinates[2 * i]), add(tile.coordinates[2 * i + 1]);
      add(d);
      if (goal == MarchGoal::map) add(tile.spread[i]);
      return line += "," + std::string(to_string(static_cast<Status>(tile.status[i])));
    };
    write_tile_rows(file, rows, values,
                    (goal == MarchGoal::map ? ",,,,," : ",,") + std::string(to_string(Status::removed)));
  }
  file.commit();
}

}  // namespace ahm::distributed
