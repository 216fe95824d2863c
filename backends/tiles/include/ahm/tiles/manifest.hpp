/// \file
/// What is known of a folder of tiles as a whole, and how far they are built.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/graph/transport.hpp"
#include "ahm/types.hpp"

namespace ahm::tiles {

/// What the tiles of a cloud are built with.
struct TileOptions {
  Index tile_points = 500'000;   ///< wanted per tile
  Index k = 0;                   ///< as `pointcloud::CloudOptions`; 0: 30, unless the cloud is noisy, which is an error
  double max_edge_ratio = 3;     ///< as `pointcloud::CloudOptions`
  bool drop_non_finite = false;  ///< as `pointcloud::CloudOptions`
  bool ignore_normals = false;   ///< normals of the file are not used; otherwise a file that has some is refused
};

/// The steps between which something is found out of all tiles together.
enum class Stage { planned, indexed, measured, triangulated, oriented, built };
std::string_view to_string(Stage stage) noexcept;

struct TileFacts {
  std::uint64_t cut = 0;   ///< points as they were cut
  std::uint64_t hash = 0;  ///< checksum of them
  Index points = 0;        ///< distinct ones
  Index vertices = 0;
  std::int64_t edges = 0;  ///< directed
};

/// The version of manifest.json of clouds, and of surfaces that were built in memory; others are refused.
inline constexpr std::uint32_t cloud_version = 5, surface_version = 4;

/// The file manifest.json of a folder.
struct Manifest {
  std::string input;
  TileOptions options;
  Stage stage = Stage::planned;
  std::uint64_t points = 0, non_finite = 0;  ///< rows of the input
  int exponent = 0;                          ///< `pointcloud::Placement`
  Index k = 0;                               ///< neighbours used
  double noise = 0;                          ///< across the surface, units of the placed points
  double mollification = 0;                  ///< the same units
  TransportKind kind = TransportKind::rotation2;
  std::int64_t reflections = 0;
  Index components = 0;
  double mean_edge_length = 0;
  bool is_surface = false;   ///< built in memory (`tile_surface`); of such, the next, too
  bool is_delaunay = false;  ///< `TangentGraph::is_delaunay`
  std::vector<TileFacts> tiles;

  /// @throws IoError (missing, damaged, of another version)
  static Manifest read(const std::filesystem::path& folder);
  /// @throws IoError
  void write(const std::filesystem::path& folder) const;
  /// Where a file of a tile is.
  static std::filesystem::path file(const std::filesystem::path& folder, std::string_view kind, std::size_t tile);
  /// Of a tile's part of the graph: of which points, built how, and which tile it is.
  std::vector<std::uint64_t> identity(std::size_t tile) const;
  /// Number of the first point, or vertex, of each tile, and their sum.
  std::vector<Index> first_points() const;
  std::vector<Index> first_vertices() const;
};

}  // namespace ahm::tiles
