/// \file
/// The manifest of a folder of tiles: its options, its figures, and how far it is built.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/graph/transport.hpp"
#include "ahm/types.hpp"

namespace ahm::tiles {

/// Options of the tiles of a cloud.
struct TileOptions {
  Index tile_points = 500'000;   ///< target number of points per tile
  Index k = 0;                   ///< `pointcloud::CloudOptions::k`; 0: 30, and noisy clouds are errors
  double max_edge_ratio = 3;     ///< `pointcloud::CloudOptions::max_edge_ratio`
  bool drop_non_finite = false;  ///< `pointcloud::CloudOptions::drop_non_finite`
  bool ignore_normals = false;   ///< ignore the normals of the file; false: files with normals are errors
};

/// Stages of the build. Each one ends with a step of all tiles.
enum class Stage { planned, indexed, measured, triangulated, oriented, built };
std::string_view to_string(Stage stage) noexcept;

/// Figures of one tile.
struct TileFacts {
  std::uint64_t cut = 0;   ///< points of the input in the tile
  std::uint64_t hash = 0;  ///< checksum of these points
  Index points = 0;        ///< distinct points
  Index vertices = 0;
  std::int64_t edges = 0;  ///< directed edges
};

/// Versions of manifest.json for clouds, and for surfaces that were built in memory. Other versions are errors.
inline constexpr std::uint32_t cloud_version = 5, surface_version = 4;

/// The contents of the file manifest.json.
struct Manifest {
  std::string input;
  TileOptions options;
  Stage stage = Stage::planned;
  std::uint64_t points = 0, non_finite = 0;  ///< rows of the input, and those that are not finite
  int exponent = 0;                          ///< exponent of `pointcloud::Placement`
  Index k = 0;                               ///< neighbors per point
  double noise = 0;                          ///< noise across the surface, units of the placed points
  double mollification = 0;                  ///< length added to all edges, units of the placed points
  TransportKind kind = TransportKind::rotation2;
  std::int64_t reflections = 0;
  Index components = 0;
  double mean_edge_length = 0;
  bool is_surface = false;   ///< built in memory (`tile_surface`)
  bool is_delaunay = false;  ///< `TangentGraph::is_delaunay`; only if `is_surface`
  std::vector<TileFacts> tiles;

  /// Reads the manifest of a folder. @throws IoError (missing, damaged, of another version)
  static Manifest read(const std::filesystem::path& folder);
  /// Writes the manifest to a folder. @throws IoError
  void write(const std::filesystem::path& folder) const;
  /// The path of a file of a tile.
  static std::filesystem::path file(const std::filesystem::path& folder, std::string_view kind, std::size_t tile);
  /// Identity of a tile's part of the graph: checksums of the points and options, and the number of the tile.
  std::vector<std::uint64_t> identity(std::size_t tile) const;
  /// Number of the first point or vertex of each tile, and last the total number.
  std::vector<Index> first_points() const;
  std::vector<Index> first_vertices() const;
};

}  // namespace ahm::tiles
