#include "ahm/tiles/build_tiles.hpp"

#include <algorithm>
#include <new>
#include <string>

#include "ahm/error.hpp"
#include "cut_points.hpp"
#include "tile_folder.hpp"

namespace ahm::tiles {
namespace {

/// What a step needs to be done, and what it leaves.
struct Rule {
  Step step;
  Stage stage;                ///< that must have been reached, and from which on it is done if it leads to the next one
  std::string_view result{};  ///< kind of file it leaves
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

/// Kinds of files, and the stage from which on they are not needed.
struct Passing {
  std::string_view kind;
  Stage stage;
};
constexpr Passing passing[] = {{cut_kind, Stage::indexed},           {kind::noise, Stage::measured},
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
  throw InvalidArgument("step '" + std::string(name) + "' is none of " + names);
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

/// The tiles that a step for all together would miss.
void require_tiles(const TileFolder& folder, const Rule& rule) {
  const Rule& before = *(&rule - 1);
  for (std::size_t t = 0; t < folder.tiles(); ++t)
    if (!folder.has(before.result, t))
      throw InvalidArgument("step '" + std::string(rule.step.name) + "' needs step '" + std::string(before.step.name) +
                            "' of all tiles, and that of tile " + std::to_string(t) + " is not done");
}

/// What tiles were made from is gone when all are built, so that a single one cannot be made again.
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
  for (const Passing& p : passing)
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
    throw InvalidArgument("step '" + std::string(name) +
                          (rule.step.per_tile ? "' is one of a tile" : "' is one of all tiles"));
  if (tile && *tile >= folder.tiles())
    throw InvalidArgument("tile " + std::to_string(*tile) + " is not there; there are " +
                          std::to_string(folder.tiles()));
  require_graph(folder, path);
  if (now > rule.stage) return false;
  if (now < rule.stage)
    throw InvalidArgument("step '" + std::string(name) +
                          "' needs what all tiles have in common before it; the tiles are " +
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
  TileFolder(path, options).tidy();  // after a process that was killed while it did so
}

}  // namespace ahm::tiles
