#include "map_checkpoint.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "ahm/distributed/array_file.hpp"
#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"

namespace ahm::distributed {
namespace {

constexpr std::string_view front_kind = "front";

}  // namespace

MapCheckpoint::MapCheckpoint(const std::filesystem::path& folder, std::uint64_t identity, Index every,
                             MapWriter& writer, MarchTeam& team, const TileOwners& owners)
    : folder_(folder), identity_(identity), every_(every), writer_(writer), team_(team), owners_(owners) {
  if (owners_.rank > 0) team_.sum(0);  // what is wrong is said once
  read_record();
  if (owners_.rank == 0) team_.sum(0);
}

void MapCheckpoint::read_record() {
  if (!std::filesystem::exists(record())) return;
  std::ifstream file(record());
  const auto whole = nlohmann::json::parse(file, nullptr, false);
  if (!whole.is_object() || whole.value("version", 0u) != format_version)
    throw IoError("cannot read '" + record().string() + "': it is damaged; remove the folder to begin the map anew");
  if (whole.value("identity", std::uint64_t{0}) != identity_)
    throw InvalidArgument("'" + folder_.string() +
                          "' has a map that is not finished, of other tiles, sources or options, or by other ranks; "
                          "go on with those, or remove the folder");
  begun_at_ = last_ = whole.value("bands", Index{0});
  slot_ = whole.value("slot", 0);
}

std::filesystem::path MapCheckpoint::state_file(int slot) const {
  return Manifest::file(folder_, std::string(front_kind) + std::to_string(slot),
                        static_cast<std::size_t>(owners_.rank));
}

std::vector<std::uint64_t> MapCheckpoint::identity_of(Index bands) const {
  return {identity_, static_cast<std::uint64_t>(owners_.rank), static_cast<std::uint64_t>(bands)};
}

std::optional<MarchState> MapCheckpoint::begin() {
  if (begun_at_ == 0) {
    writer_.begin_anew();
    return std::nullopt;
  }
  const ArrayFile file(state_file(slot_), front_kind);
  if (!std::ranges::equal(file.get<std::uint64_t>("identity"), identity_of(begun_at_)))
    throw IoError("cannot read '" + file.path().string() +
                  "': it is not of this map; remove the folder to begin the map anew");
  MarchState state;
  const auto take = [&]<class T>(std::vector<T>& into, std::string_view name) {
    const auto values = file.get<T>(name);
    into.assign(values.begin(), values.end());
  };
  const auto counts = file.get<std::int64_t>("counts");
  const auto lengths = file.get<double>("lengths");
  state.statistics = {.bands = begun_at_, .largest_band = static_cast<Index>(counts[0]), .solved = counts[1]};
  state.accepted = counts[2];
  state.depth = lengths[0];
  take(state.front, "front");
  take(state.vertices, "vertices");
  take(state.values, "values");
  take(state.exponents, "exponents");
  take(state.passed, "passed");
  writer_.go_on(state, counts[3], lengths[1]);
  return state;
}

void MapCheckpoint::end_band(const March& march) {
  const MarchStatistics& s = march.statistics();
  if (every_ == 0 || s.bands - last_ < every_) return;
  writer_.save();
  const MarchState state = march.state();
  const std::vector<std::uint64_t> identity = identity_of(s.bands);
  const std::vector<std::int64_t> counts{s.largest_band, s.solved, state.accepted, writer_.ok()};
  const std::vector<double> lengths{state.depth, writer_.farthest()};
  write_arrays(state_file(1 - slot_), front_kind,
               {array("identity", identity), array("counts", counts), array("lengths", lengths),
                array("front", state.front), array("vertices", state.vertices), array("values", state.values),
                array("exponents", state.exponents), array("passed", state.passed)});
  last_ = s.bands;
  slot_ = 1 - slot_;
  team_.sum(0);  // all have written theirs
  if (owners_.rank == 0) {
    const nlohmann::json whole{
        {"version", format_version}, {"identity", identity_}, {"bands", s.bands}, {"slot", slot_}};
    io::AtomicFile file(record());
    file.write(whole.dump(1) + "\n");
    file.commit();
  }
  team_.sum(0);  // nobody writes over the one before until it is not needed
}

void MapCheckpoint::remove() {
  team_.sum(0);
  if (owners_.rank == 0) std::filesystem::remove(record());
  team_.sum(0);
  for (int slot : {0, 1}) std::filesystem::remove(state_file(slot));
}

}  // namespace ahm::distributed
