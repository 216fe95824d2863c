#include "ahm/distributed/tiled_log_map.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "maps/team_log_map.hpp"
#include "team_map.hpp"

namespace ahm::distributed {
namespace {

constexpr std::string_view map_kind = "map";
constexpr std::uint8_t untold = 255;

/// The rows of one tile.
struct MapTile {
  explicit MapTile(std::size_t vertices)
      : coordinates(2 * vertices, NAN), distance(vertices, NAN), spread(vertices, NAN), status(vertices, untold) {}

  explicit MapTile(const std::filesystem::path& path) {
    const ArrayFile file(path, map_kind);
    const auto take = [&]<class T>(std::vector<T>& into, std::string_view name) {
      const auto values = file.get<T>(name);
      into.assign(values.begin(), values.end());
    };
    take(coordinates, "coordinates");
    take(distance, "distance");
    take(spread, "spread");
    take(status, "status");
  }
  void write(const std::filesystem::path& path) const {
    write_arrays(path, map_kind,
                 {array("coordinates", coordinates), array("distance", distance), array("spread", spread),
                  array("status", status)});
  }
  std::size_t bytes() const { return distance.size() * (4 * sizeof(double) + 1); }

  std::vector<double> coordinates, distance, spread;
  std::vector<std::uint8_t> status;
  std::int64_t used = 0;
};

/// Takes rows, and writes a tile when it has all of its, or when memory is short.
class MapWriter final : public MapSink {
 public:
  MapWriter(const TiledGraph& graph, const std::filesystem::path& folder, std::size_t memory,
            const std::function<bool(std::size_t)>& owns_tile)
      : graph_(graph),
        folder_(folder),
        memory_(memory),
        owns_tile_(owns_tile),
        tiles_(graph.tiles()),
        left_(graph.tiles()),
        begun_(graph.tiles()) {
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
      left_[t] = graph.manifest().tiles[t].vertices;
      if (owns_tile(t)) std::filesystem::remove(path(t));
    }
  }

  void put(Index vertex, const MapRow& row) override {
    const std::size_t number = graph_.tile_of(vertex);
    MapTile& tile = open(number);
    const auto i = static_cast<std::size_t>(vertex - graph_.first_vertex(number));
    std::copy_n(row.coordinates.begin(), 2, tile.coordinates.begin() + static_cast<std::ptrdiff_t>(2 * i));
    tile.distance[i] = row.distance;
    tile.spread[i] = row.spread;
    tile.status[i] = static_cast<std::uint8_t>(row.status);
    if (row.status == Status::ok) {
      ++summary.ok;
      summary.farthest = std::max(summary.farthest, row.distance);
    }
    if (--left_[number] == 0) close(number);
  }

  /// Says of the vertices that the march did not come to why.
  void finish(const Source& source, double radius) {
    std::set<Index> reached;  // components of the source
    for (Vertex vertex : source.vertices()) reached.insert(graph_.component(vertex.index));
    const Status why = std::isinf(radius) ? Status::unreached : Status::beyond_radius;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
      if (!owns_tile_(t) || (left_[t] == 0 && begun_[t])) continue;
      MapTile& tile = open(t);
      const auto component = graph_.rows(t).component;
      for (std::size_t i = 0; i < tile.status.size(); ++i)
        if (tile.status[i] == untold)
          tile.status[i] = static_cast<std::uint8_t>(reached.contains(component[i]) ? why : Status::disconnected);
      close(t);
    }
  }

  TiledMapSummary summary;

 private:
  std::filesystem::path path(std::size_t tile) const { return Manifest::file(folder_, map_kind, tile); }

  MapTile& open(std::size_t number) {
    std::unique_ptr<MapTile>& tile = tiles_[number];
    if (!tile) {
      tile = begun_[number]
                 ? std::make_unique<MapTile>(path(number))
                 : std::make_unique<MapTile>(static_cast<std::size_t>(graph_.manifest().tiles[number].vertices));
      begun_[number] = 1;
      bytes_ += tile->bytes();
      while (bytes_ > memory_ && spill(number)) continue;
    }
    tile->used = ++clock_;
    return *tile;
  }
  bool spill(std::size_t keep) {
    std::size_t oldest = tiles_.size();
    for (std::size_t t = 0; t < tiles_.size(); ++t)
      if (tiles_[t] && t != keep && (oldest == tiles_.size() || tiles_[t]->used < tiles_[oldest]->used)) oldest = t;
    if (oldest == tiles_.size()) return false;
    ++summary.spills;
    close(oldest);
    return true;
  }
  void close(std::size_t number) {
    tiles_[number]->write(path(number));
    bytes_ -= tiles_[number]->bytes();
    tiles_[number].reset();
  }

  const TiledGraph& graph_;
  std::filesystem::path folder_;
  std::size_t memory_, bytes_ = 0;
  const std::function<bool(std::size_t)>& owns_tile_;
  std::vector<std::unique_ptr<MapTile>> tiles_;
  std::vector<Index> left_;  ///< vertices not told of yet
  std::vector<char> begun_;
  std::int64_t clock_ = 0;
};

/// That the map is finished, and what it is.
void write_summary(const TiledMapSummary& s, const TiledGraph& graph, const Source& source,
                   const std::filesystem::path& folder, const HeatOptions& heat) {
  nlohmann::json sources = nlohmann::json::array();
  for (Vertex vertex : source.vertices()) sources.push_back(vertex.index);
  const nlohmann::json whole{{"version", format_version},
                             {"vertices", graph.size()},
                             {"source_vertices", sources},
                             {"variant", std::string(to_string(heat.variant))},
                             {"t_coef", heat.t_coef},
                             {"ok", s.ok},
                             {"farthest", s.farthest},
                             {"bands", s.march.bands},
                             {"largest_band", s.march.largest_band},
                             {"solved", s.march.solved}};
  io::AtomicFile file(folder / "map.json");
  file.write(whole.dump(1) + "\n");
  file.commit();
}

/// Shortest text that reads back as the same number; nothing for NaN.
void append(std::string& line, double value) {
  char text[32];
  if (std::isfinite(value)) line.append(text, std::to_chars(text, text + sizeof(text), value).ptr);
  line += ',';
}

}  // namespace

TiledMapSummary write_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                              const TiledMapOptions& options) {
  Alone alone(graph.dimension());
  return team_log_map(graph, source, folder, options, alone, [](std::size_t) { return true; });
}

TiledMapSummary team_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                             const TiledMapOptions& options, MarchTeam& team,
                             const std::function<bool(std::size_t)>& owns_tile) {
  std::filesystem::create_directories(folder);
  if (owns_tile(0)) std::filesystem::remove(folder / "map.json");
  MapWriter writer(graph, folder, options.memory, owns_tile);
  TiledMapSummary& s = writer.summary;
  s.march = ahm::team_log_map(graph, source, options.heat, {.radius = options.radius}, writer, team);
  writer.finish(source, options.radius);
  s.ok = team.sum(s.ok);
  s.farthest = team.greatest(s.farthest);
  s.spills = team.sum(s.spills);
  s.releases = team.sum(graph.releases());
  if (owns_tile(0)) write_summary(s, graph, source, folder, options.heat);
  return s;
}

void write_rows(const TiledGraph& graph, const std::filesystem::path& folder, const std::filesystem::path& csv) {
  std::ifstream summary(folder / "map.json");
  const auto whole = nlohmann::json::parse(summary, nullptr, false);
  if (whole.is_discarded() || whole.value("vertices", Index{-1}) != graph.size())
    throw IoError("cannot read '" + (folder / "map.json").string() +
                  "': the map is not finished, or not one of these tiles");
  io::AtomicFile file(csv);
  file.write("row,u,v,distance,spread,status\n");
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    const MapTile tile(Manifest::file(folder, map_kind, t));
    const TiledGraph::TileRows rows = graph.rows(t);
    if (tile.status.size() + 1 != rows.begin.size())
      throw IoError("the map's tile " + std::to_string(t) + " is not one of these tiles; make the map again");
    std::string line;
    for (std::size_t i = 0; i < tile.status.size(); ++i) {
      std::string values = ",";
      for (double value : {tile.coordinates[2 * i], tile.coordinates[2 * i + 1], tile.distance[i], tile.spread[i]})
        append(values, value);
      values += to_string(static_cast<Status>(tile.status[i]));
      for (Index r = rows.begin[i]; r < rows.begin[i + 1]; ++r) line += std::to_string(rows.rows[r]) + values + "\n";
      if (line.size() > 1 << 20) file.write(line), line.clear();
    }
    for (Index row : rows.removed)
      line += std::to_string(row) + ",,,,," + std::string(to_string(Status::removed)) + "\n";
    file.write(line);
  }
  file.commit();
}

}  // namespace ahm::distributed
