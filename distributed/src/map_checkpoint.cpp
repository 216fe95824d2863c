#include "map_checkpoint.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "ahm/distributed/array_file.hpp"
#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"

namespace ahm::distributed {
namespace {

constexpr std::string_view front_kind = "front";

}  // namespace

MapCheckpoint::MapCheckpoint(const std::filesystem::path& folder, std::uint64_t identity, Index every,
                             const TiledGraph& graph, MarchTeam& team, const TileOwners& owners)
    : folder_(folder), identity_(identity), every_(every), graph_(graph), team_(team), owners_(owners) {
  if (owners_.rank > 0) team_.sum(0);  // what is wrong is said once
  read_record();
  if (owners_.rank == 0) team_.sum(0);
  team_.sum(0);  // all have read it
}

void MapCheckpoint::read_record() {
  if (!std::filesystem::exists(record_file())) return;
  std::ifstream file(record_file());
  const auto whole = nlohmann::json::parse(file, nullptr, false);
  if (!whole.is_object() || whole.value("version", 0u) != format_version)
    throw IoError("cannot read '" + record_file().string() +
                  "': it is damaged; remove the folder to begin the map anew");
  if (whole.value("identity", std::uint64_t{0}) != identity_)
    throw InvalidArgument("'" + folder_.string() +
                          "' has a map that is not finished, of other tiles, sources or options; go on with those, or "
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
                  "': it is not of this map; remove the folder to begin the map anew");
  return file;
}

std::optional<MarchState> MapCheckpoint::begin() {
  if (begun_at_ == 0) {
    writer_->begin_anew();
    return std::nullopt;
  }
  const bool is_own = ranks_ == owners_.ranks && std::ranges::equal(open_state(0).get<int>("owners"), owners_.of_tile);
  return is_own ? own_state() : dealt_state();
}

namespace {

/// What a state says of the march as a whole, the same for all members.
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
  writer_->go_on(state, counts[3], file.get<double>("lengths")[1]);
  return state;
}

/// Whether a vertex, or a neighbour of it, is this member's own.
bool MapCheckpoint::is_near(Index vertex) const {
  return team_.owns(vertex) ||
         std::ranges::any_of(graph_.star(vertex).neighbors, [&](Index j) { return team_.owns(j); });
}

/// Of each vertex what its owner knew.
MarchState MapCheckpoint::dealt_state() {
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
      throw IoError("cannot read '" + file.path().string() + "': it is of other tiles");
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
  writer_->go_on(state, owners_.rank == 0 ? ok : 0, farthest);
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
  team_.sum(0);  // all have written theirs
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
  team_.sum(0);  // nobody writes over the one before until it is not needed
}

void MapCheckpoint::remove() {
  team_.sum(0);
  if (owners_.rank == 0) {
    std::filesystem::remove(record_file());
    std::vector<std::filesystem::path> states;  // also of members before, who may have been more
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (entry.path().extension().string().starts_with("." + std::string(front_kind))) states.push_back(entry.path());
    for (const auto& state : states) std::filesystem::remove(state);
  }
  team_.sum(0);
}

}  // namespace ahm::distributed
