#include "ahm/distributed/tiled_log_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "ahm/maps/place_in_space.hpp"
#include "ahm/util/vec.hpp"
#include "csv_rows.hpp"
#include "map_checkpoint.hpp"
#include "map_summary.hpp"
#include "map_writer.hpp"
#include "maps/heat_distance.hpp"
#include "maps/team_log_map.hpp"
#include "second_order.hpp"
#include "team_map.hpp"
#include "tile_distances.hpp"

namespace ahm::distributed {
namespace {

std::uint64_t identity_of(const TiledGraph& graph, const Source& source) {
  std::vector<std::uint64_t> parts = graph.manifest().identity(0);
  const auto add = [&](auto values) { parts.push_back(checksum(std::as_bytes(values))); };
  add(source.vertices()), add(source.weights()), add(source.offsets()), add(source.axes());
  return checksum(std::as_bytes(std::span(parts)));
}

/// What the map is made of, whoever makes it.
std::uint64_t identity_of(std::uint64_t graph_and_source, const TiledMapOptions& options) {
  std::vector<std::uint64_t> parts{graph_and_source};
  const HeatOptions& heat = options.heat;
  for (double x : {heat.t_coef, heat.accuracy, options.radius}) parts.push_back(std::bit_cast<std::uint64_t>(x));
  for (int x : {options.coordinates ? static_cast<int>(heat.variant) : -1, heat.order})
    parts.push_back(static_cast<std::uint64_t>(x));
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
      {"order", options.heat.order},
      {"t_coef", options.heat.t_coef},
      {"ok", s.ok},
      {"farthest", s.farthest},
      {"bands", s.march.bands},
      {"largest_band", s.march.largest_band},
      {"solved", s.march.solved}};
  if (std::isfinite(options.radius)) whole["radius"] = options.radius;
  return whole;
}

/// A map of all members, in the making.
class Making {
 public:
  Making(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
         const TiledMapOptions& options, MarchTeam& team, const TileOwners& owners)
      : graph_(graph),
        source_(source),
        folder_(folder),
        options_(options),
        team_(team),
        owners_(owners),
        input_(identity_of(graph, source)),
        identity_(identity_of(input_, options)) {}

  TiledMapSummary first_order() {
    MapCheckpoint checkpoint(folder_, identity_, options_.checkpoint, graph_, team_, owners_);
    first_alone([&] { std::filesystem::remove(folder_ / "map.json"); });
    std::optional<TileDistances> distances;
    if (unfolds(graph_, source_)) distances.emplace(distances_as_far_as(options_.radius));
    const TiledMapSummary s = march(folder_, options_.radius, nullptr, distances ? &*distances : nullptr, checkpoint);
    finish(s);
    checkpoint.remove();
    return s;
  }

  /// The maps of several times, each in a folder of its own, and out of these the map.
  TiledMapSummary second_order() {
    const TiledTimes times(graph_, source_, options_.heat, team_, owners_);
    const double radius = times.radius_of_each(options_.radius);
    MapCheckpoint claim(folder_, identity_, 0, graph_, team_, owners_);
    claim.record();
    first_alone([&] { std::filesystem::remove(folder_ / "map.json"); });
    const bool unfolded = unfolds(graph_, source_);
    const TileDistances distances = distances_as_far_as(unfolded ? radius : longest_way * radius);
    TiledMapSummary sum;
    std::vector<std::filesystem::path> folders;
    for (std::size_t k = 0; k < times.count(); ++k) {
      folders.push_back(folder_ / ("time" + std::to_string(k)));
      const auto scales = times.scales(k);
      const TiledMapSummary s = map_of_time(folders.back(), k, radius, *scales, unfolded ? &distances : nullptr);
      sum.march += s.march;
      sum.begun_at += s.begun_at, sum.spills += s.spills, sum.releases += s.releases;
    }
    const CombinedRows rows = times.combine(folders, unfolded ? std::filesystem::path() : distances_folder(), folder_,
                                            options_.radius, owners_);
    sum.ok = team_.sum(rows.ok);
    sum.farthest = team_.greatest(rows.farthest);
    finish(sum);
    claim.remove();
    first_alone([&] {
      for (const auto& one : folders) std::filesystem::remove_all(one);
    });
    return sum;
  }

 private:
  /// By the first member, while the others wait.
  template <class Task>
  void first_alone(const Task& task) {
    if (owners_.rank == 0) task();
    team_.sum(0);
  }

  std::filesystem::path distances_folder() const { return folder_ / "distances"; }

  TileDistances distances_as_far_as(double radius) {
    first_alone([&] {
      find_distances(graph_, source_, radius, distances_folder(), options_.memory, input_, options_.heat.progress);
    });
    return {graph_, distances_folder()};
  }

  TiledMapSummary march(const std::filesystem::path& folder, double radius, const MarchScales* scales,
                        const KnownDistances* distances, MapCheckpoint& checkpoint) {
    const MarchGoal goal = options_.coordinates ? MarchGoal::map : MarchGoal::distances;
    MapWriter writer(graph_, folder, goal, options_.memory, owners_);
    checkpoint.keep(writer);
    HeatOptions heat = options_.heat;
    heat.order = 1;
    TiledMapSummary s;
    const std::int64_t releases = graph_.releases();
    s.march = ahm::team_log_map(graph_, source_, heat, {.radius = radius}, writer, team_,
                                {.goal = goal,
                                 .keeper = &checkpoint,
                                 .scales = scales,
                                 .distances = distances,
                                 .tells_beyond = options_.heat.order == 2});
    writer.finish(source_, radius);
    s.begun_at = checkpoint.begun_at();
    s.ok = team_.sum(writer.ok());
    s.farthest = team_.greatest(writer.farthest());
    s.spills = team_.sum(writer.spills());
    s.releases = team_.sum(graph_.releases() - releases);
    return s;
  }

  /// That of time k, unless it is there.
  TiledMapSummary map_of_time(const std::filesystem::path& folder, std::size_t k, double radius,
                              const MarchScales& scales, const KnownDistances* distances) {
    const std::uint64_t parts[] = {identity_, k};
    const std::uint64_t identity = checksum(std::as_bytes(std::span(parts)));
    const bool is_there = is_finished(folder, identity);
    team_.sum(0);  // all have looked
    if (is_there) {
      const nlohmann::json whole = read_finished(folder);
      TiledMapSummary s;
      s.march = {whole.value("bands", Index{0}), whole.value("largest_band", Index{0}),
                 whole.value("solved", Offset{0})};
      s.begun_at = s.march.bands;
      return s;
    }
    first_alone([&] { std::filesystem::create_directories(folder); });
    MapCheckpoint checkpoint(folder, identity, options_.checkpoint, graph_, team_, owners_);
    const TiledMapSummary s = march(folder, radius, &scales, distances, checkpoint);
    first_alone([&] {
      nlohmann::json whole = as_json(s, graph_, source_, options_);
      whole["order"] = 1;
      whole["identity"] = identity;
      write_finished(folder, whole);
    });
    checkpoint.remove();
    return s;
  }

  /// All tiles of all members are there.
  void finish(const TiledMapSummary& s) {
    first_alone([&] {
      write_finished(folder_, as_json(s, graph_, source_, options_));
      std::filesystem::remove_all(distances_folder());
    });
  }

  const TiledGraph& graph_;
  const Source& source_;
  const std::filesystem::path& folder_;
  const TiledMapOptions& options_;
  MarchTeam& team_;
  const TileOwners& owners_;
  std::uint64_t input_, identity_;
};

void check(const TiledGraph& graph, const Source& source, const TiledMapOptions& options) {
  if (options.checkpoint < 0)
    throw InvalidArgument("checkpoint is " + std::to_string(options.checkpoint) + "; it must be at least 0 bands");
  HeatOptions heat = options.heat;
  if (heat.order == 2) {
    if (!options.coordinates) throw InvalidArgument("distances alone have order 1");
    heat.order = 1;
  }
  check_streamed_map(graph, source, heat, {.radius = options.radius});
}

}  // namespace

TiledMapSummary write_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                              const TiledMapOptions& options) {
  Alone alone(graph.dimension());
  return team_log_map(graph, source, folder, options, alone, {0, 1, std::vector<int>(graph.tiles(), 0)});
}

TiledMapSummary team_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                             const TiledMapOptions& options, MarchTeam& team, const TileOwners& owners) {
  check(graph, source, options);
  std::filesystem::create_directories(folder);
  Making making(graph, source, folder, options, team, owners);
  return options.heat.order == 1 ? making.first_order() : making.second_order();
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
  const nlohmann::json whole = read_finished(folder);
  if (!whole.is_object() || whole.value("vertices", Index{-1}) != graph.size())
    throw IoError("cannot read '" + (folder / "map.json").string() +
                  "': the map is not finished, or not one of these tiles");
  const MarchGoal goal = whole.value("coordinates", true) ? MarchGoal::map : MarchGoal::distances;
  const std::optional<Vec3> source = place_of_source(graph, whole);
  const double radius = whole.value("radius", std::numeric_limits<double>::infinity());
  const bool has_error = whole.value("order", 1) == 2;
  const std::string none = goal == MarchGoal::distances ? ",," : has_error ? ",,,,,," : ",,,,,";
  io::AtomicFile file(csv);
  file.write(goal == MarchGoal::distances ? "row,distance,status\n"
             : has_error                  ? "row,u,v,distance,spread,error_estimate,status\n"
                                          : "row,u,v,distance,spread,status\n");
  RowLines lines(file, graph);
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    const MapTile tile(Manifest::file(folder, MapTile::kind, t), goal);
    const TiledGraph::TileRows rows = graph.rows(t);
    if (tile.status.size() + 1 != rows.begin.size())
      throw IoError("the map's tile " + std::to_string(t) + " is not one of these tiles; make the map again");
    const auto line_of = [&](std::size_t i) -> VertexLine {
      // As on the rows of a surface: distances may be below the straight line, which no way on it is.
      const double d = no_shorter_than(source ? ahm::distance(rows.positions[i], *source) : 0, tile.distance[i]);
      if (d > radius) return {none + std::string(to_string(Status::beyond_radius)), tile.distance[i]};
      std::string line;
      const auto add = [&](double number) { append_number(line += ',', number); };
      if (goal == MarchGoal::map) add(tile.coordinates[2 * i]), add(tile.coordinates[2 * i + 1]);
      add(d);
      if (goal == MarchGoal::map) add(tile.spread[i]);
      if (has_error) add(tile.error[i]);
      return {line + "," + std::string(to_string(static_cast<Status>(tile.status[i]))), tile.distance[i]};
    };
    lines.add(rows, line_of, none + std::string(to_string(Status::removed)));
  }
  lines.finish();
  file.commit();
}

}  // namespace ahm::distributed
