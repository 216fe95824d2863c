/// \file
/// A graph on disk, tile by tile, of which as much is in memory as is asked for and fits.
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

/// The graph of a folder of tiles that are built. Tiles are mapped, and their checksums tested, when they are first asked for;
/// of mapped tiles only what is read takes memory, and is given back, those first that were not asked for longest, when it becomes
/// too much. Stars live as long as the graph. Unlike other graphs it serves one thread at a time.
class TiledGraph final : public TangentGraph {
 public:
  /// @param memory  bytes that files mapped by this process may take, beside the tile at hand
  /// @throws IoError (missing or damaged), InvalidArgument (the tiles are not built)
  TiledGraph(const std::filesystem::path& folder, std::size_t memory);

  Index size() const noexcept override { return first_.back(); }
  int dimension() const noexcept override { return 2; }
  TransportKind transport_kind() const noexcept override { return manifest_.kind; }
  double mean_edge_length() const noexcept override { return manifest_.mean_edge_length; }
  /// @throws IoError, as all that asks for a tile: it is missing, or damaged
  double component_edge_length(Index vertex) const override;
  double mass(Index vertex) const override;
  Star star(Index vertex) const override;
  Offset edge_count() const noexcept override { return edges_; }
  double length_unit() const noexcept override { return unit_; }
  bool is_delaunay() const noexcept override { return manifest_.is_delaunay; }
  /// As the surface has them; of clouds x and y as `pointcloud::PointCloudSurface`.
  std::optional<Frame> frame(Index vertex) const override;

  /// Component of a vertex, numbered in the order of their first vertices.
  Index component(Index vertex) const;
  /// Mean edge lengths of all components, graph units.
  std::span<const double> component_edge_lengths() const noexcept { return edge_lengths_; }
  /// The first vertex of an input row; none where it was removed. Reads all tiles.
  /// @throws InvalidArgument (no such row)
  std::optional<Vertex> vertex_of_row(Row row) const;
  /// Of many, by one pass over the tiles.
  std::vector<std::optional<Vertex>> vertices_of_rows(std::span<const Row> rows) const;
  /// The vertex at a row that is nearest to a position in world units. Reads all tiles.
  Vertex nearest_vertex(const Vec3& position) const;

  const Manifest& manifest() const noexcept { return manifest_; }
  std::size_t tiles() const noexcept { return manifest_.tiles.size(); }
  std::size_t tile_of(Index vertex) const;
  Index first_vertex(std::size_t tile) const { return first_[tile]; }
  /// Mean position of each tile's vertices, world units. @throws IoError (tiles built before these were kept)
  std::vector<Vec3> middles() const;
  /// Input rows at the vertices of a tile: those of its vertex i are rows[begin[i]] to rows[begin[i + 1]].
  struct TileRows {
    std::span<const Index> begin, rows, removed, component;
    std::span<const Vec3> positions;  ///< of vertices, world units
  };
  TileRows rows(std::size_t tile) const;
  /// Rows with several vertices, where a mesh was cut; ascending.
  std::vector<Index> shared_rows() const;
  /// Times that memory of tiles was given back.
  std::int64_t releases() const noexcept { return releases_; }

 private:
  struct Tile {
    explicit Tile(ArrayFile mapped, std::size_t width);
    ArrayFile file;
    std::span<const Offset> row_begin;
    std::span<const Index> neighbors, component;
    std::span<const double> weights, logs, transports, masses;
    std::int64_t used = 0;
  };
  const Tile& tile(std::size_t number) const;
  const Tile& tile_at(Index& vertex) const;
  void give_back() const;

  std::filesystem::path folder_;
  Manifest manifest_;
  std::size_t memory_, width_;
  std::vector<Index> first_;
  std::vector<double> edge_lengths_;
  Offset edges_ = 0;
  double unit_ = 1;
  mutable std::vector<std::unique_ptr<Tile>> tiles_;
  mutable std::size_t last_ = 0;
  mutable std::int64_t clock_ = 0, releases_ = 0;
};

}  // namespace ahm::tiles
