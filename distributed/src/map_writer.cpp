#include "map_writer.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "ahm/distributed/array_file.hpp"

namespace ahm::distributed {

MapTile::MapTile(std::size_t vertices, MarchGoal goal) : distance(vertices, NAN), status(vertices, untold) {
  if (goal == MarchGoal::distances) return;
  coordinates.assign(2 * vertices, NAN);
  spread.assign(vertices, NAN);
}

MapTile::MapTile(const std::filesystem::path& path, MarchGoal goal) : is_saved(true) {
  const ArrayFile file(path, kind);
  const auto take = [&]<class T>(std::vector<T>& into, std::string_view name) {
    const auto values = file.get<T>(name);
    into.assign(values.begin(), values.end());
  };
  take(distance, "distance");
  take(status, "status");
  if (goal == MarchGoal::distances) return;
  take(coordinates, "coordinates");
  take(spread, "spread");
}

void MapTile::write(const std::filesystem::path& path) const {
  std::vector<NamedArray> arrays;
  const auto has_map = !coordinates.empty() || distance.empty();
  if (has_map) arrays.push_back(array("coordinates", coordinates));
  arrays.push_back(array("distance", distance));
  if (has_map) arrays.push_back(array("spread", spread));
  arrays.push_back(array("status", status));
  write_arrays(path, kind, arrays);
}

void MapTile::clear(std::size_t row) {
  distance[row] = NAN;
  status[row] = untold;
  if (coordinates.empty()) return;
  coordinates[2 * row] = coordinates[2 * row + 1] = spread[row] = NAN;
}

std::size_t MapTile::bytes() const {
  return (coordinates.size() + distance.size() + spread.size()) * sizeof(double) + status.size();
}

MapWriter::MapWriter(const TiledGraph& graph, const std::filesystem::path& folder, MarchGoal goal, std::size_t memory,
                     const TileOwners& owners)
    : graph_(graph),
      folder_(folder),
      goal_(goal),
      memory_(memory),
      owners_(owners),
      tiles_(graph.tiles()),
      begun_(graph.tiles()) {
  for (std::size_t t = 0; t < tiles_.size(); ++t) left_.push_back(vertices(t));
}

void MapWriter::begin_anew() {
  for (std::size_t t = 0; t < tiles_.size(); ++t)
    if (owners_.owns(t)) std::filesystem::remove(path(t));
}

void MapWriter::go_on(const MarchState& state, std::int64_t ok, double farthest) {
  ok_ = ok;
  farthest_ = farthest;
  std::vector<char> told;
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    if (!owners_.owns(t)) continue;
    const Index first = graph_.first_vertex(t), last = graph_.first_vertex(t + 1);
    told.assign(static_cast<std::size_t>(vertices(t)), 0);
    const auto tell = [&](Index begin, Index end) {
      for (Index i = std::max(begin, first); i < std::min(end, last); ++i)
        told[static_cast<std::size_t>(i - first)] = 1;
    };
    auto at = std::lower_bound(state.vertices.begin(), state.vertices.end(), first);
    for (; at != state.vertices.end() && *at < last; ++at) tell(*at, *at + 1);
    // Begins and ends ascend: an odd number of them up to here is the inside of a run.
    const auto up_to = std::upper_bound(state.passed.begin(), state.passed.end(), first) - state.passed.begin();
    for (auto run = static_cast<std::size_t>(up_to - up_to % 2); run < state.passed.size() && state.passed[run] < last;
         run += 2)
      tell(state.passed[run], state.passed[run + 1]);
    const auto count = static_cast<Index>(std::count(told.begin(), told.end(), 1));
    left_[t] -= count;
    begun_[t] = count > 0;
    if (count == 0) std::filesystem::remove(path(t));
    if (count == 0 || left_[t] == 0) continue;
    MapTile& tile = open(t);
    for (std::size_t i = 0; i < told.size(); ++i)
      if (told[i] == 0) tile.clear(i);
    tile.is_saved = false;
  }
}

void MapWriter::put(Index vertex, const MapRow& row) {
  const std::size_t number = graph_.tile_of(vertex);
  MapTile& tile = open(number);
  const auto i = static_cast<std::size_t>(vertex - graph_.first_vertex(number));
  tile.distance[i] = row.distance;
  tile.status[i] = static_cast<std::uint8_t>(row.status);
  if (goal_ == MarchGoal::map) {
    std::copy_n(row.coordinates.begin(), 2, tile.coordinates.begin() + static_cast<std::ptrdiff_t>(2 * i));
    tile.spread[i] = row.spread;
  }
  tile.is_saved = false;
  if (row.status == Status::ok) {
    ++ok_;
    farthest_ = std::max(farthest_, row.distance);
  }
  if (--left_[number] == 0) close(number);
}

void MapWriter::save() {
  for (std::size_t t = 0; t < tiles_.size(); ++t)
    if (tiles_[t]) save(t);
}

void MapWriter::finish(const Source& source, double radius) {
  std::set<Index> reached;  // components of the source
  for (Vertex vertex : source.vertices()) reached.insert(graph_.component(vertex.index));
  const Status why = std::isinf(radius) ? Status::unreached : Status::beyond_radius;
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    if (!owners_.owns(t) || (left_[t] == 0 && begun_[t])) continue;
    MapTile& tile = open(t);
    const auto component = graph_.rows(t).component;
    for (std::size_t i = 0; i < tile.status.size(); ++i)
      if (tile.status[i] == MapTile::untold)
        tile.status[i] = static_cast<std::uint8_t>(reached.contains(component[i]) ? why : Status::disconnected);
    tile.is_saved = false;
    close(t);
  }
}

MapTile& MapWriter::open(std::size_t number) {
  std::unique_ptr<MapTile>& tile = tiles_[number];
  if (!tile) {
    tile = begun_[number] ? std::make_unique<MapTile>(path(number), goal_)
                          : std::make_unique<MapTile>(static_cast<std::size_t>(vertices(number)), goal_);
    begun_[number] = 1;
    bytes_ += tile->bytes();
    while (bytes_ > memory_ && spill(number)) continue;
  }
  tile->used = ++clock_;
  return *tile;
}

bool MapWriter::spill(std::size_t keep) {
  std::size_t oldest = tiles_.size();
  for (std::size_t t = 0; t < tiles_.size(); ++t)
    if (tiles_[t] && t != keep && (oldest == tiles_.size() || tiles_[t]->used < tiles_[oldest]->used)) oldest = t;
  if (oldest == tiles_.size()) return false;
  ++spills_;
  close(oldest);
  return true;
}

void MapWriter::close(std::size_t number) {
  save(number);
  bytes_ -= tiles_[number]->bytes();
  tiles_[number].reset();
}

void MapWriter::save(std::size_t number) {
  if (!tiles_[number]->is_saved) tiles_[number]->write(path(number));
  tiles_[number]->is_saved = true;
}

}  // namespace ahm::distributed
