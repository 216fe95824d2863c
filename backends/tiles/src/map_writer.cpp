#include "map_writer.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"

namespace ahm::tiles {
namespace {

std::filesystem::path summary_file(const std::filesystem::path& folder) { return folder / "map.json"; }

}  // namespace

nlohmann::json read_finished(const std::filesystem::path& folder) {
  std::ifstream file(summary_file(folder));
  return nlohmann::json::parse(file, nullptr, false);
}

bool is_finished(const std::filesystem::path& folder, std::uint64_t identity) {
  const nlohmann::json whole = read_finished(folder);
  return whole.is_object() && whole.value("version", 0u) == format_version &&
         whole.value("identity", std::uint64_t{0}) == identity;
}

void write_finished(const std::filesystem::path& folder, const nlohmann::json& summary) {
  nlohmann::json whole{{"version", format_version}};
  whole.update(summary);
  io::AtomicFile file(summary_file(folder));
  file.write(whole.dump(1) + "\n");
  file.commit();
}

MapTile::MapTile(std::size_t vertices, MarchGoal goal) : distance(vertices, NAN), status(vertices, not_set) {
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
  status[row] = not_set;
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

void MapWriter::remove_own_files() {
  for (std::size_t t = 0; t < tiles_.size(); ++t)
    if (owners_.owns(t)) std::filesystem::remove(path(t));
}

void MapWriter::resume_from(const MarchState& state, std::int64_t ok, double farthest) {
  ok_ = ok;
  farthest_ = farthest;
  std::vector<char> is_done;
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    if (!owners_.owns(t)) continue;
    const Index first = graph_.first_vertex(t), last = graph_.first_vertex(t + 1);
    is_done.assign(static_cast<std::size_t>(vertices(t)), 0);
    const auto mark_done = [&](Index begin, Index end) {
      for (Index i = std::max(begin, first); i < std::min(end, last); ++i)
        is_done[static_cast<std::size_t>(i - first)] = 1;
    };
    auto at = std::lower_bound(state.vertices.begin(), state.vertices.end(), first);
    for (; at != state.vertices.end() && *at < last; ++at) mark_done(*at, *at + 1);
    // Begins and ends ascend, so an odd number of them up to `first` means that `first` is inside a run.
    const auto up_to = std::upper_bound(state.passed.begin(), state.passed.end(), first) - state.passed.begin();
    for (auto run = static_cast<std::size_t>(up_to - up_to % 2); run < state.passed.size() && state.passed[run] < last;
         run += 2)
      mark_done(state.passed[run], state.passed[run + 1]);
    const auto count = static_cast<Index>(std::count(is_done.begin(), is_done.end(), 1));
    left_[t] -= count;
    begun_[t] = count > 0;
    if (count == 0) std::filesystem::remove(path(t));
    if (count == 0 || left_[t] == 0) continue;
    MapTile& tile = open(t);
    for (std::size_t i = 0; i < is_done.size(); ++i)
      if (is_done[i] == 0) tile.clear(i);
    tile.is_saved = false;
  }
}

void MapWriter::add(Index vertex, const MapRow& row) {
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
  std::set<Index> reached;  // components with a source
  for (Vertex vertex : source.vertices()) reached.insert(graph_.component(vertex.index));
  const Status why = std::isinf(radius) ? Status::unreached : Status::beyond_radius;
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    if (!owners_.owns(t) || (left_[t] == 0 && begun_[t])) continue;
    MapTile& tile = open(t);
    const auto component = graph_.rows(t).component;
    for (std::size_t i = 0; i < tile.status.size(); ++i)
      if (tile.status[i] == MapTile::not_set)
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

namespace {

constexpr std::string_view front_kind = "front";

}  // namespace

MapCheckpoint::MapCheckpoint(const std::filesystem::path& folder, std::uint64_t identity, Index every,
                             const TiledGraph& graph, MarchTeam& team, const TileOwners& owners)
    : folder_(folder), identity_(identity), every_(every), graph_(graph), team_(team), owners_(owners) {
  if (owners_.rank > 0) team_.sum(0);  // the first rank reads alone, so that an error is reported once
  read_record();
  if (owners_.rank == 0) team_.sum(0);
  team_.sum(0);  // waits until all ranks have read it
}

void MapCheckpoint::read_record() {
  if (!std::filesystem::exists(record_file())) return;
  std::ifstream file(record_file());
  const auto whole = nlohmann::json::parse(file, nullptr, false);
  if (!whole.is_object() || whole.value("version", 0u) != format_version)
    throw IoError("cannot read '" + record_file().string() +
                  "': it is damaged; remove the folder to start the map again");
  if (whole.value("identity", std::uint64_t{0}) != identity_)
    throw InvalidArgument("'" + folder_.string() +
                          "' contains an unfinished map of other tiles, sources or options; use the same arguments, or "
                          "remove the folder");
  begun_at_ = last_ = whole.value("bands", Index{0});
  slot_ = whole.value("slot", 0);
  ranks_ = whole.value("ranks", 1);
}

std::filesystem::path MapCheckpoint::state_file(int slot, int rank) const {
  return Manifest::file(folder_, std::string(front_kind) + std::to_string(slot), static_cast<std::size_t>(rank));
}

std::vector<std::uint64_t> MapCheckpoint::identity_of(Index bands, int rank) const {
  return {identity_, static_cast<std::uint64_t>(rank), static_cast<std::uint64_t>(bands)};
}

ArrayFile MapCheckpoint::open_state(int rank) const {
  ArrayFile file(state_file(slot_, rank), front_kind);
  if (!std::ranges::equal(file.get<std::uint64_t>("identity"), identity_of(begun_at_, rank)))
    throw IoError("cannot read '" + file.path().string() +
                  "': it belongs to another map; remove the folder to start the map again");
  return file;
}

std::optional<MarchState> MapCheckpoint::begin() {
  if (begun_at_ == 0) {
    writer_->remove_own_files();
    return std::nullopt;
  }
  const bool is_own = ranks_ == owners_.ranks && std::ranges::equal(open_state(0).get<int>("owners"), owners_.of_tile);
  return is_own ? own_state() : redistributed_state();
}

namespace {

/// The part of the state that is the same for all members: statistics and depth.
MarchState begin_state(const ArrayFile& file, Index bands) {
  MarchState state;
  const auto counts = file.get<std::int64_t>("counts");
  state.statistics = {.bands = bands, .largest_band = static_cast<Index>(counts[0]), .solved = counts[1]};
  state.depth = file.get<double>("lengths")[0];
  return state;
}

}  // namespace

MarchState MapCheckpoint::own_state() {
  const ArrayFile file = open_state(owners_.rank);
  MarchState state = begin_state(file, begun_at_);
  const auto take = [&]<class T>(std::vector<T>& into, std::string_view name) {
    const auto values = file.get<T>(name);
    into.assign(values.begin(), values.end());
  };
  const auto counts = file.get<std::int64_t>("counts");
  state.accepted = counts[2];
  take(state.front, "front");
  take(state.vertices, "vertices");
  take(state.values, "values");
  take(state.exponents, "exponents");
  take(state.passed, "passed");
  writer_->resume_from(state, counts[3], file.get<double>("lengths")[1]);
  return state;
}

/// Whether this member owns a vertex or one of its neighbors.
bool MapCheckpoint::is_near(Index vertex) const {
  return team_.owns(vertex) ||
         std::ranges::any_of(graph_.star(vertex).neighbors, [&](Index j) { return team_.owns(j); });
}

/// The state of this member from the states of all former members: each vertex from its former owner.
MarchState MapCheckpoint::redistributed_state() {
  MarchState state;
  std::vector<std::pair<Index, Index>> passed;
  struct Place {
    Index vertex;
    std::size_t file, row;
  };
  std::vector<Place> places;
  std::vector<ArrayFile> files;
  std::int64_t ok = 0;
  double farthest = 0;
  for (int rank = 0; rank < ranks_; ++rank) {
    const ArrayFile& file = files.emplace_back(open_state(rank));
    const auto owners = file.get<int>("owners");
    if (owners.size() != graph_.tiles())
      throw IoError("cannot read '" + file.path().string() +
                    "': it belongs to other tiles; remove the folder to start the map again");
    if (rank == 0) state = begin_state(file, begun_at_);
    ok += file.get<std::int64_t>("counts")[3];
    farthest = std::max(farthest, file.get<double>("lengths")[1]);
    const auto vertices = file.get<Index>("vertices"), runs = file.get<Index>("passed");
    for (std::size_t k = 0; k < vertices.size(); ++k)
      if (owners[graph_.tile_of(vertices[k])] == rank && is_near(vertices[k]))
        places.push_back({vertices[k], files.size() - 1, k});
    for (const Index vertex : file.get<Index>("front"))
      if (team_.owns(vertex)) state.front.push_back(vertex);
    for (std::size_t run = 0; run + 1 < runs.size(); run += 2)
      for (Index begin = runs[run]; begin < runs[run + 1];) {
        const std::size_t tile = graph_.tile_of(begin);
        const Index end = std::min(runs[run + 1], graph_.first_vertex(tile + 1));
        if (owners[tile] == rank) passed.emplace_back(begin, end);
        begin = end;
      }
  }
  std::sort(state.front.begin(), state.front.end());
  std::sort(passed.begin(), passed.end());
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.vertex < b.vertex; });
  for (const auto& [begin, end] : passed) {
    if (owners_.owns(graph_.tile_of(begin))) state.accepted += end - begin;
    if (!state.passed.empty() && state.passed.back() == begin)
      state.passed.back() = end;
    else
      state.passed.insert(state.passed.end(), {begin, end});
  }
  for (const Place& place : places) {
    const ArrayFile& file = files[place.file];
    const auto exponents = file.get<HeatExponents>("exponents");
    const auto values = file.get<double>("values");
    const std::size_t width = values.size() / exponents.size();
    state.vertices.push_back(place.vertex);
    state.exponents.push_back(exponents[place.row]);
    const auto row = values.subspan(place.row * width, width);
    state.values.insert(state.values.end(), row.begin(), row.end());
    state.accepted += team_.owns(place.vertex) ? 1 : 0;
  }
  writer_->resume_from(state, owners_.rank == 0 ? ok : 0, farthest);
  return state;
}

void MapCheckpoint::end_band(const March& march) {
  const MarchStatistics& s = march.statistics();
  if (every_ == 0 || s.bands - last_ < every_) return;
  writer_->save();
  const MarchState state = march.state();
  const std::vector<std::uint64_t> identity = identity_of(s.bands, owners_.rank);
  const std::vector<std::int64_t> counts{s.largest_band, s.solved, state.accepted, writer_->ok()};
  const std::vector<double> lengths{state.depth, writer_->farthest()};
  write_arrays(state_file(1 - slot_, owners_.rank), front_kind,
               {array("identity", identity), array("owners", owners_.of_tile), array("counts", counts),
                array("lengths", lengths), array("front", state.front), array("vertices", state.vertices),
                array("values", state.values), array("exponents", state.exponents), array("passed", state.passed)});
  last_ = s.bands;
  slot_ = 1 - slot_;
  team_.sum(0);  // waits until all ranks have written their states
  record();
}

void MapCheckpoint::record() {
  if (owners_.rank == 0) {
    const nlohmann::json whole{{"version", format_version},
                               {"identity", identity_},
                               {"bands", last_},
                               {"slot", slot_},
                               {"ranks", owners_.ranks}};
    io::AtomicFile file(record_file());
    file.write(whole.dump(1) + "\n");
    file.commit();
  }
  team_.sum(0);  // no rank overwrites the previous checkpoint before the new one is recorded
}

void MapCheckpoint::remove() {
  team_.sum(0);
  if (owners_.rank == 0) {
    std::filesystem::remove(record_file());
    std::vector<std::filesystem::path> states;  // also those of former ranks, which may have been more
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (entry.path().extension().string().starts_with("." + std::string(front_kind))) states.push_back(entry.path());
    for (const auto& state : states) std::filesystem::remove(state);
  }
  team_.sum(0);
}

}  // namespace ahm::tiles
