#include "ahm/tiles/build_tiles.hpp"

#include <algorithm>
#include <new>
#include <string>

#include "ahm/error.hpp"
#include "cut_points.hpp"
#include "tile_folder.hpp"

namespace ahm::tiles {
namespace {

/// A step with its prerequisites, its results and its functions.
struct Rule {
  Step step;
  Stage stage;                ///< stage at which the step runs; at later stages it is finished
  std::string_view result{};  ///< kind of file that it writes per tile
  void (*tile)(TileFolder&, std::size_t) = nullptr;
  void (*all)(TileFolder&) = nullptr;
};

const std::vector<Rule>& rules() {
  static const std::vector<Rule> table{{{"sort", true}, Stage::planned, kind::points, sort_points, nullptr},
                                       {{"index", false}, Stage::planned, {}, nullptr, index_points},
                                       {{"planes", true}, Stage::indexed, kind::surroundings, find_planes, nullptr},
                                       {{"measure", false}, Stage::indexed, {}, nullptr, measure_noise},
                                       {{"cover", true}, Stage::measured, kind::triangles, triangulate, nullptr},
                                       {{"mollify", false}, Stage::measured, {}, nullptr, find_mollification},
                                       {{"edges", true}, Stage::triangulated, kind::edges, weigh_edges, nullptr},
                                       {{"orient", false}, Stage::triangulated, {}, nullptr, orient},
                                       {{"graph", true}, Stage::oriented, kind::graph, make_graph, nullptr},
                                       {{"finish", false}, Stage::oriented, {}, nullptr, finish_graph}};
  return table;
}

/// A kind of intermediate file, and the stage from which it is not needed.
struct TemporaryFile {
  std::string_view kind;
  Stage stage;
};
constexpr TemporaryFile temporary_files[] = {
    {cut_kind, Stage::indexed},           {kind::noise, Stage::measured},
    {kind::lengths, Stage::triangulated}, {kind::neighbors, Stage::triangulated},
    {kind::triangles, Stage::oriented},   {kind::surroundings, Stage::built},
    {kind::edges, Stage::built},          {kind::vertices, Stage::built},
    {kind::points, Stage::built}};

const Rule& rule_of(std::string_view name) {
  std::string names;
  for (const Rule& rule : rules()) {
    if (rule.step.name == name) return rule;
    names += (names.empty() ? "" : ", ") + std::string(rule.step.name);
  }
  throw InvalidArgument("step '" + std::string(name) + "' is not one of " + names);
}

bool run_tile(TileFolder& folder, const Rule& rule, std::size_t tile) {
  if (folder.has(rule.result, tile)) return false;
  try {
    rule.tile(folder, tile);
  } catch (const std::bad_alloc&) {
    throw ResourceExhausted("out of memory in step '" + std::string(rule.step.name) + "' of tile " +
                            std::to_string(tile) + "; plan smaller tiles");
  }
  return true;
}

/// Checks that the preceding step is finished for all tiles. @throws InvalidArgument
void require_tiles(const TileFolder& folder, const Rule& rule) {
  const Rule& before = *(&rule - 1);
  for (std::size_t t = 0; t < folder.tiles(); ++t)
    if (!folder.has(before.result, t))
      throw InvalidArgument("step '" + std::string(rule.step.name) + "' requires step '" +
                            std::string(before.step.name) + "' of all tiles; run it for tile " + std::to_string(t) +
                            " first");
}

/// Checks that no tile of a built folder is missing. The intermediate files are gone, so a single tile cannot be built again.
/// @throws IoError
void require_graph(const TileFolder& folder, const std::filesystem::path& path) {
  if (folder.manifest().stage != Stage::built) return;
  for (std::size_t t = 0; t < folder.tiles(); ++t)
    if (!folder.has(kind::graph, t))
      throw IoError("tile " + std::to_string(t) + " in '" + path.string() +
                    "' is missing; remove the folder and make it again");
}

}  // namespace

void TileFolder::tidy() const {
  if (options_.keep) return;
  for (const TemporaryFile& p : temporary_files)
    for (std::size_t t = 0; manifest_.stage >= p.stage && t < tiles(); ++t) std::filesystem::remove(file(p.kind, t));
}

const std::vector<Step>& steps() {
  static const std::vector<Step> result = [] {
    std::vector<Step> all;
    for (const Rule& rule : rules()) all.push_back(rule.step);
    return all;
  }();
  return result;
}

bool run_step(const std::filesystem::path& path, std::string_view name, std::optional<std::size_t> tile,
              const BuildOptions& options) {
  const Rule& rule = rule_of(name);
  TileFolder folder(path, options);
  const Stage now = folder.manifest().stage;
  if (rule.step.per_tile != tile.has_value())
    throw InvalidArgument(
        "step '" + std::string(name) +
        (rule.step.per_tile ? "' runs for one tile; set its number" : "' runs for all tiles; leave the tile out"));
  if (tile && *tile >= folder.tiles())
    throw InvalidArgument("tile " + std::to_string(*tile) + " does not exist; the number of tiles is " +
                          std::to_string(folder.tiles()));
  require_graph(folder, path);
  if (now > rule.stage) return false;
  if (now < rule.stage)
    throw InvalidArgument("step '" + std::string(name) +
                          "' requires the earlier steps of all tiles; the tiles are only " +
                          std::string(to_string(now)));
  if (tile) return run_tile(folder, rule, *tile);
  require_tiles(folder, rule);
  rule.all(folder);
  return true;
}

void build_tiles(const std::filesystem::path& path, const BuildOptions& options) {
  for (const Rule& rule : rules()) {
    TileFolder folder(path, options);
    if (folder.manifest().stage > rule.stage) continue;
    options.progress.step(rule.step.name, 0);
    for (std::size_t t = 0; rule.tile && t < folder.tiles(); ++t) {
      run_tile(folder, rule, t);
      options.progress.step(rule.step.name, static_cast<double>(t + 1) / static_cast<double>(folder.tiles()));
    }
    if (rule.all) rule.all(folder);
  }
  require_graph(TileFolder(path, options), path);
  TileFolder(path, options).tidy();  // in case a process was killed during that
}

}  // namespace ahm::tiles
