/// \file
/// A graph on disk as tiles. Memory holds only tiles that were read, up to a limit.
///
/// \code
/// const ahm::tiles::TiledGraph graph("tiles", std::size_t{1} << 30);
/// ahm::stream_log_map(graph, ahm::Source::at_vertex(graph.vertex_of_row(ahm::Row{7}).value()), {}, {}, sink);
/// \endcode
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/tiles/array_file.hpp"
#include "ahm/tiles/manifest.hpp"

namespace ahm::tiles {

/// The graph of a folder of built tiles. Maps a tile into memory and checks its checksums when it is first used. Only the parts of a
/// tile that are read take memory; above the limit the least recently used tiles are released. Stars are valid during the lifetime of
/// the graph. Unlike other graphs, only one thread may use it at a time.
class TiledGraph final : public TangentGraph {
 public:
  /// @param memory  limit for mapped files of this process, bytes; the current tile may exceed it
  /// @throws IoError (missing or damaged), InvalidArgument (the tiles are not built)
  TiledGraph(const std::filesystem::path& folder, std::size_t memory);

  Index size() const noexcept override { return first_.back(); }
  int dimension() const noexcept override { return 2; }
  TransportKind transport_kind() const noexcept override { return manifest_.kind; }
  double mean_edge_length() const noexcept override { return manifest_.mean_edge_length; }
  /// @throws IoError (a tile is missing or damaged), as all members that read a tile
  double component_edge_length(Index vertex) const override;
  double mass(Index vertex) const override;
  Star star(Index vertex) const override;
  Offset edge_count() const noexcept override { return edges_; }
  double length_unit() const noexcept override { return unit_; }
  bool is_delaunay() const noexcept override { return manifest_.is_delaunay; }
  /// The frame of the surface; for clouds the axes x and y of `pointcloud::PointCloudSurface`.
  std::optional<Frame> frame(Index vertex) const override;

  /// Component of a vertex. Components are numbered in the order of their first vertices.
  Index component(Index vertex) const;
  /// Mean edge lengths of all components, graph units.
  std::span<const double> component_edge_lengths() const noexcept { return edge_lengths_; }
  /// The first vertex of an input row; none if the row was removed. Reads all tiles.
  /// @throws InvalidArgument (no such row)
  std::optional<Vertex> vertex_of_row(Row row) const;
  /// The first vertices of several input rows. Reads all tiles once. @throws InvalidArgument (no such row)
  std::vector<std::optional<Vertex>> vertices_of_rows(std::span<const Row> rows) const;
  /// The vertex nearest to a position, world units, among those with a row. Reads all tiles.
  Vertex nearest_vertex(const Vec3& position) const;

  const Manifest& manifest() const noexcept { return manifest_; }
  std::size_t tiles() const noexcept { return manifest_.tiles.size(); }
  std::size_t tile_of(Index vertex) const;
  Index first_vertex(std::size_t tile) const { return first_[tile]; }
  /// Mean position of the vertices of each tile, world units. @throws IoError (tiles of an older version without them)
  std::vector<Vec3> middles() const;
  /// The input rows of a tile. Those of its vertex i are rows[begin[i]] to rows[begin[i + 1] - 1].
  struct TileRows {
    std::span<const Index> begin, rows, removed, component;
    std::span<const Vec3> positions;  ///< positions of the vertices, world units
  };
  TileRows rows(std::size_t tile) const;
  /// Rows with several vertices, where a mesh was cut, ascending.
  std::vector<Index> shared_rows() const;
  /// Number of times that the memory of a tile was released.
  std::int64_t releases() const noexcept { return releases_; }

 private:
  struct Tile;
  const Tile& tile(std::size_t number) const;
  const Tile& tile_at(Index& vertex) const;
  void release_memory() const;

  std::filesystem::path folder_;
  Manifest manifest_;
  std::size_t memory_, width_;
  std::vector<Index> first_;
  std::vector<double> edge_lengths_;
  Offset edges_ = 0;
  double unit_ = 1;
  mutable std::vector<std::shared_ptr<Tile>> tiles_;
  mutable std::size_t last_ = 0;
  mutable std::int64_t clock_ = 0, releases_ = 0;
};

}  // namespace ahm::tiles
