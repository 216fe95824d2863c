#include <algorithm>
#include <cstring>
#include <fstream>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/vec.hpp"
#include "cut_points.hpp"
#include "surroundings.hpp"
#include "tile_folder.hpp"

namespace ahm::tiles {
namespace {

std::vector<CutPoint> read_cut(const TileFolder& folder, std::size_t tile) {
  const TileFacts& facts = folder.manifest().tiles[tile];
  const auto path = folder.file(cut_kind, tile);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError("cannot read '" + path.string() + "': " + std::strerror(errno) + "; plan the tiles again");
  std::vector<CutPoint> points(facts.cut);
  const auto bytes = static_cast<std::streamsize>(points.size() * sizeof(CutPoint));
  if (!file.read(reinterpret_cast<char*>(points.data()), bytes) || file.peek() != std::ifstream::traits_type::eof() ||
      checksum(std::as_bytes(std::span(points))) != facts.hash)
    throw IoError("cannot read '" + path.string() + "': it is damaged (its checksum is wrong); plan the tiles again");
  return points;
}

}  // namespace

/// Sorts the points of a tile along the curve, and merges equal points, with a list of the input rows of each point.
void sort_points(TileFolder& folder, std::size_t tile) {
  const pointcloud::Placement placement = folder.placement();
  const std::vector<CutPoint> cut = read_cut(folder, tile);
  struct Key {
    Vec3 placed;
    std::size_t at;
  };
  std::vector<Key> order;
  order.reserve(cut.size());
  for (std::size_t i = 0; i < cut.size(); ++i) order.push_back({placement.place(cut[i].point), i});
  std::sort(order.begin(), order.end(), [&](const Key& a, const Key& b) {
    return a.placed == b.placed ? cut[a.at].row < cut[b.at].row : pointcloud::before_on_curve(a.placed, b.placed);
  });
  std::vector<Vec3> points, placed;
  std::vector<Index> rows, row_begin{0};
  for (const Key& key : order) {
    if (placed.empty() || placed.back() != key.placed) {
      if (!placed.empty()) row_begin.push_back(static_cast<Index>(rows.size()));
      placed.push_back(key.placed);
      points.push_back(cut[key.at].point);
    }
    rows.push_back(static_cast<Index>(cut[key.at].row));
  }
  if (!placed.empty()) row_begin.push_back(static_cast<Index>(rows.size()));
  folder.write(
      kind::points, tile,
      {array("points", points), array("rows", rows), array("row_begin", row_begin), array("boxes", boxes_of(placed))});
}

/// Counts the distinct points of all tiles, and sets the number of neighbors. @throws InvalidGeometry (fewer than 3 points)
void index_points(TileFolder& folder) {
  std::int64_t all = 0;
  for (std::size_t t = 0; t < folder.tiles(); ++t) {
    const auto count = static_cast<Index>(folder.open(kind::points, t).get<Vec3>("points").size());
    folder.manifest().tiles[t].points = count;
    all += count;
  }
  if (all < 3)
    throw InvalidGeometry("the cloud has " + std::to_string(all) +
                          " distinct finite point(s); at least 3 are required");
  const Index wanted = folder.manifest().options.k > 0 ? folder.manifest().options.k : 30;
  folder.manifest().k = static_cast<Index>(std::min<std::int64_t>(wanted, all - 1));
  folder.finish(Stage::indexed);
}

}  // namespace ahm::tiles
