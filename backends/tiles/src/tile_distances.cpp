#include "tile_distances.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "ahm/maps/wavefront.hpp"
#include "map_writer.hpp"

namespace ahm::tiles {

void find_distances(const TiledGraph& graph, const Source& source, double radius, const std::filesystem::path& folder,
                    std::size_t memory, std::uint64_t identity, const Progress& progress) {
  const std::uint64_t parts[] = {identity, std::bit_cast<std::uint64_t>(radius)};
  identity = checksum(std::as_bytes(std::span(parts)));
  if (is_finished(folder, identity)) return;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const TileOwners alone{0, 1, std::vector<int>(graph.tiles(), 0)};
  MapWriter writer(graph, folder, MarchGoal::distances, memory, alone);
  progress.step("unfold", 0);
  Wavefront front(graph);
  front.add(source);
  front.run(radius, progress.stop);
  for (Index i = 0; i < graph.size(); ++i) writer.add(i, {Status::ok, {}, front.distance(Vertex(i)), NAN});
  write_finished(folder, {{"identity", identity}});
}

TileDistances::TileDistances(const TiledGraph& graph, const std::filesystem::path& folder)
    : graph_(graph), folder_(folder), files_(graph.tiles()) {}

double TileDistances::of(Index vertex) const {
  const std::size_t tile = graph_.tile_of(vertex);
  if (tile != last_ && files_[last_]) files_[last_]->release();
  last_ = tile;
  if (!files_[tile])
    files_[tile] = std::make_unique<const ArrayFile>(Manifest::file(folder_, MapTile::kind, tile), MapTile::kind);
  const double distance = files_[tile]->get<double>("distance")[vertex - graph_.first_vertex(tile)];
  return std::isnan(distance) ? std::numeric_limits<double>::infinity() : distance;
}

}  // namespace ahm::tiles
