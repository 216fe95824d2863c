/// \file
/// A folder of tiles during the build: its manifest, its files, and functions that the steps share.
#pragma once

#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/tiles/array_file.hpp"
#include "ahm/tiles/build_tiles.hpp"
#include "ahm/tiles/manifest.hpp"
#include "clean_points.hpp"

namespace ahm::tiles {

/// Checks the number of points per tile. @throws InvalidArgument
inline void check_tile_points(Index tile_points) {
  if (tile_points < 100)
    throw InvalidArgument("tile_points is " + std::to_string(tile_points) + "; it must be at least 100");
}
/// Checks that a folder does not contain tiles. @throws InvalidArgument
inline void check_no_tiles(const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder / "manifest.json"))
    throw InvalidArgument("'" + folder.string() + "' already contains tiles; build them, or remove the folder");
}

/// The kinds of files that steps write.
namespace kind {
inline constexpr std::string_view points = "points", surroundings = "around", neighbors = "neighbors", noise = "noise",
                                  triangles = "triangles", lengths = "lengths", edges = "edges", vertices = "vertices",
                                  graph = "graph";
}

/// A folder of tiles with its manifest.
class TileFolder {
 public:
  TileFolder(std::filesystem::path folder, const BuildOptions& options)
      : path_(std::move(folder)), options_(options), manifest_(Manifest::read(path_)) {}

  const std::filesystem::path& path() const { return path_; }
  const BuildOptions& options() const { return options_; }
  Manifest& manifest() { return manifest_; }
  const Manifest& manifest() const { return manifest_; }
  std::size_t tiles() const { return manifest_.tiles.size(); }

  std::filesystem::path file(std::string_view kind, std::size_t tile) const {
    return Manifest::file(path_, kind, tile);
  }
  bool has(std::string_view kind, std::size_t tile) const { return std::filesystem::exists(file(kind, tile)); }
  ArrayFile open(std::string_view kind, std::size_t tile) const { return ArrayFile(file(kind, tile), kind); }
  void write(std::string_view kind, std::size_t tile, const std::vector<NamedArray>& arrays) const {
    write_arrays(file(kind, tile), kind, arrays);
  }
  /// Records that a stage is reached, and removes files that are not needed after it.
  void finish(Stage stage) {
    manifest_.stage = stage;
    manifest_.write(path_);
    tidy();
  }
  /// Removes files that later stages do not need, unless `BuildOptions::keep` is set.
  void tidy() const;

  pointcloud::Placement placement() const { return {manifest_.exponent}; }
  pointcloud::CloudOptions cloud_options() const {
    pointcloud::CloudOptions result;
    if (manifest_.options.k > 0) result.k = manifest_.options.k;
    result.max_edge_ratio = manifest_.options.max_edge_ratio;
    result.threads = options_.threads;
    return result;
  }
  /// Number of the first point of a tile. Valid from the stage `indexed`.
  Index first_point(std::size_t tile) const { return manifest_.first_points()[tile]; }

 private:
  std::filesystem::path path_;
  BuildOptions options_;
  Manifest manifest_;
};

/// The steps in their order, for one tile or for all tiles.
void sort_points(TileFolder& folder, std::size_t tile);
void index_points(TileFolder& folder);
void find_planes(TileFolder& folder, std::size_t tile);
void measure_noise(TileFolder& folder);
void triangulate(TileFolder& folder, std::size_t tile);
void find_mollification(TileFolder& folder);
void weigh_edges(TileFolder& folder, std::size_t tile);
void orient(TileFolder& folder);
void make_graph(TileFolder& folder, std::size_t tile);
void finish_graph(TileFolder& folder);

}  // namespace ahm::tiles
