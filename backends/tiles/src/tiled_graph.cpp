#include "ahm/tiles/tiled_graph.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/vec.hpp"
#include "tangent_planes.hpp"
#include "tile_folder.hpp"

namespace ahm::tiles {
namespace {

/// Resident memory of mapped files of the process, bytes: the third number of /proc/self/statm, in pages.
std::size_t resident_file_bytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t all = 0, resident = 0, shared = 0;
  file >> all >> resident >> shared;
  return shared * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace

struct TiledGraph::Tile {
  explicit Tile(ArrayFile mapped, std::size_t width);
  ArrayFile file;
  std::span<const Offset> row_begin;
  std::span<const Index> neighbors, component;
  std::span<const double> weights, logs, transports, masses;
  std::int64_t used = 0;
};

TiledGraph::Tile::Tile(ArrayFile mapped, std::size_t width)
    : file(std::move(mapped)),
      row_begin(file.get<Offset>("row_begin")),
      neighbors(file.get<Index>("neighbors")),
      component(file.get<Index>("component")),
      weights(file.get<double>("weights")),
      logs(file.get<double>("logs")),
      transports(file.get<double>("transports")),
      masses(file.get<double>("masses")) {
  const std::size_t edges = neighbors.size(), vertices = masses.size();
  if (row_begin.size() != vertices + 1 || component.size() != vertices || weights.size() != edges ||
      logs.size() != 2 * edges || transports.size() != width * edges || row_begin.back() != static_cast<Offset>(edges))
    throw IoError("cannot read '" + file.path().string() +
                  "': its arrays have inconsistent sizes; remove its folder and make it again");
}

TiledGraph::TiledGraph(const std::filesystem::path& folder, std::size_t memory)
    : folder_(folder),
      manifest_(Manifest::read(folder)),
      memory_(memory),
      width_(TransportLayout{manifest_.kind, 2}.width()),
      first_(manifest_.first_vertices()),
      unit_(std::scalbn(1.0, manifest_.exponent)),
      tiles_(manifest_.tiles.size()) {
  if (manifest_.stage != Stage::built)
    throw InvalidArgument("the tiles in '" + folder.string() + "' are only " + std::string(to_string(manifest_.stage)) +
                          "; build them first");
  for (const TileFacts& facts : manifest_.tiles) edges_ += facts.edges;
  const ArrayFile components(folder / "components", "components");
  const auto lengths = components.get<double>("edge_lengths");
  edge_lengths_.assign(lengths.begin(), lengths.end());
}

std::size_t TiledGraph::tile_of(Index vertex) const {
  if (vertex >= first_[last_] && vertex < first_[last_ + 1]) return last_;
  return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), vertex) - first_.begin() - 1);
}

/// Releases the least recently used tiles until half of the memory limit is free.
void TiledGraph::release_memory() const {
  if (resident_file_bytes() <= memory_) return;
  std::vector<std::pair<std::int64_t, std::size_t>> order;
  for (std::size_t t = 0; t < tiles_.size(); ++t)
    if (tiles_[t] && tiles_[t]->used > 0) order.emplace_back(tiles_[t]->used, t);
  std::sort(order.begin(), order.end());
  for (const auto& [used, t] : order) {
    if (resident_file_bytes() <= memory_ / 2) return;
    tiles_[t]->file.release();
    tiles_[t]->used = 0;
    ++releases_;
  }
}

const TiledGraph::Tile& TiledGraph::tile(std::size_t number) const {
  if (!tiles_[number]) {
    auto mapped = std::make_shared<Tile>(ArrayFile(Manifest::file(folder_, kind::graph, number), kind::graph), width_);
    const auto identity = mapped->file.get<std::uint64_t>("identity");
    if (!std::ranges::equal(identity, manifest_.identity(number)))
      throw IoError("cannot read '" + mapped->file.path().string() +
                    "': it is another tile, or belongs to another graph; remove its folder and make it again");
    mapped->file.release();  // because checking the checksums has read the whole file
    tiles_[number] = std::move(mapped);
  }
  constexpr std::int64_t often = 8192;  // each call reads at most some hundred bytes
  if (++clock_ % often == 0) release_memory();
  tiles_[number]->used = clock_;
  last_ = number;
  return *tiles_[number];
}

/// The tile of a vertex. @param vertex  replaced by its index in the tile
const TiledGraph::Tile& TiledGraph::tile_at(Index& vertex) const {
  const std::size_t number = tile_of(vertex);
  vertex -= first_[number];
  return tile(number);
}

double TiledGraph::component_edge_length(Index vertex) const { return edge_lengths_[component(vertex)]; }

Index TiledGraph::component(Index vertex) const { return tile_at(vertex).component[vertex]; }

double TiledGraph::mass(Index vertex) const { return tile_at(vertex).masses[vertex]; }

Star TiledGraph::star(Index vertex) const {
  const Tile& t = tile_at(vertex);
  const auto begin = static_cast<std::size_t>(t.row_begin[vertex]),
             degree = static_cast<std::size_t>(t.row_begin[vertex + 1]) - begin;
  return {2, t.neighbors.subspan(begin, degree), t.weights.subspan(begin, degree),
          t.logs.subspan(2 * begin, 2 * degree), t.transports.subspan(width_ * begin, width_ * degree)};
}

std::optional<Frame> TiledGraph::frame(Index vertex) const {
  const Tile& t = tile_at(vertex);
  const Vec3 normal = t.file.get<Vec3>("normals")[vertex], origin = t.file.get<Vec3>("positions")[vertex];
  if (manifest_.is_surface)
    return Frame{origin, t.file.get<Vec3>("x_axes")[vertex], t.file.get<Vec3>("y_axes")[vertex], normal};
  const pointcloud::PlaneAxes axes(normal);
  return Frame{origin, axes.x, axes.y, normal};
}

std::vector<Vec3> TiledGraph::middles() const {
  const ArrayFile file(folder_ / "components", "components");
  if (!file.has("middles"))
    throw IoError("the tiles in '" + folder_.string() +
                  "' have no middles, which older versions did not store; use --deal cards, or build the tiles again");
  const auto middles = file.get<Vec3>("middles");
  return {middles.begin(), middles.end()};
}

std::vector<Index> TiledGraph::shared_rows() const {
  const ArrayFile file(folder_ / "components", "components");
  if (!file.has("shared_rows")) return {};
  const auto rows = file.get<Index>("shared_rows");
  return {rows.begin(), rows.end()};
}

TiledGraph::TileRows TiledGraph::rows(std::size_t number) const {
  const Tile& t = tile(number);
  return {t.file.get<Index>("point_rows"), t.file.get<Index>("rows"), t.file.get<Index>("removed"), t.component,
          t.file.get<Vec3>("positions")};
}

std::optional<Vertex> TiledGraph::vertex_of_row(Row row) const { return vertices_of_rows({&row, 1})[0]; }

std::vector<std::optional<Vertex>> TiledGraph::vertices_of_rows(std::span<const Row> wanted) const {
  std::vector<std::pair<Index, std::size_t>> places;  // each row with its index in `wanted`
  for (const Row row : wanted) {
    if (row.index < 0 || static_cast<std::uint64_t>(row.index) >= manifest_.points)
      throw InvalidArgument("row " + std::to_string(row.index) + " is out of range [0, " +
                            std::to_string(manifest_.points) + ")");
    places.emplace_back(row.index, places.size());
  }
  std::sort(places.begin(), places.end());
  std::vector<std::optional<Vertex>> found(wanted.size());
  std::size_t left = wanted.size();
  for (std::size_t t = 0; t < tiles() && left > 0; ++t) {
    const TileRows here = rows(t);
    for (std::size_t i = 0; i + 1 < here.begin.size(); ++i)
      for (Index r = here.begin[i]; r < here.begin[i + 1]; ++r) {
        const Index row = here.rows[r];
        auto at = std::lower_bound(places.begin(), places.end(), std::pair(row, std::size_t{0}));
        for (; at != places.end() && at->first == row; ++at)
          if (!found[at->second]) found[at->second] = Vertex(first_[t] + static_cast<Index>(i)), --left;
      }
  }
  return found;
}

Vertex TiledGraph::nearest_vertex(const Vec3& position) const {
  double least = std::numeric_limits<double>::infinity();
  Index nearest = 0;
  for (std::size_t t = 0; t < tiles(); ++t) {
    const TileRows here = rows(t);
    for (std::size_t i = 0; i < here.positions.size(); ++i)
      if (const double d = norm(here.positions[i] - position); d < least && here.begin[i] < here.begin[i + 1]) {
        least = d;
        nearest = first_[t] + static_cast<Index>(i);
      }
  }
  return Vertex(nearest);
}

}  // namespace ahm::tiles
