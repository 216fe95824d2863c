/// \file
/// Regular grids in the plane and in space, with or without obstacles.
///
/// \code
/// ahm::grid::GridGraph grid({.shape = {200, 100}, .spacing = {0.05, 0.05}});   // 200 x 100 vertices
/// ahm::LogMapSolver solver(grid);
/// ahm::LogMap map = solver.solve(grid.source_at(std::array{1.02, 3.4}));
/// auto where = map.coordinates(grid.vertex(std::array{7, 30}));                // = position - (1.02, 3.4)
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/source.hpp"

namespace ahm::grid {

/// A box of vertices in R^d, d = 2 or 3. The domain consists of the cells between them that are not blocked.
struct Grid {
  std::vector<Index> shape;  ///< number of vertices along each axis, d numbers >= 2
  /// d lengths > 0. The solver rejects the graph if they differ by a factor of more than about a thousand.
  std::vector<double> spacing;
  std::vector<double> origin;  ///< position of vertex 0, d numbers; empty: zero
  /// One byte per cell; nonzero: an obstacle. The first axis runs fastest. Along each axis there is one cell fewer than
  /// vertices. Empty: no obstacles.
  std::vector<std::uint8_t> blocked;
};

/// The tangent graph of a grid: an edge to every neighbor along an axis, the finite volume (5 or 7 point) Laplacian, and the
/// coordinate axes as the frame of every vertex. The first axis runs fastest in the numbering of vertices.
///
/// The graph stores no stars. It takes one byte per cell with obstacles, and no memory per cell otherwise. The span `neighbors`
/// of a star is valid until the next call of `star` on the same thread, for this or another grid.
///
/// **Obstacles.** Vertices inside an obstacle have no edges and get `Status::disconnected`, like rooms without a door. Cells
/// that touch at a corner are connected there. Transport along any path around an obstacle is the identity, because the domain
/// is flat. So the log map is `position - source`: the straight-line direction to a vertex, not that of the shortest path
/// around obstacles. `LogMap::distance` is also the straight-line distance, through walls. `map_quality` is low where the path
/// around is longer by a tenth and an edge. `Wavefront` (cells, farthest points) goes around obstacles.
class GridGraph final : public TangentGraph {
 public:
  /// @throws InvalidGeometry (not 2 or 3 axes, an axis of fewer than 2 vertices, a length or position not finite or not
  /// in range, a number of blocked bytes that differs from the number of cells, no free cell), ResourceExhausted (more vertices
  /// than fit in an `Index`)
  explicit GridGraph(Grid grid);

  Index size() const noexcept override { return size_; }
  int dimension() const noexcept override { return dimension_; }
  TransportKind transport_kind() const noexcept override {
    return dimension_ == 2 ? TransportKind::rotation2 : TransportKind::block;
  }
  double mean_edge_length() const noexcept override { return mean_edge_length_; }
  double mass(Index vertex) const override;
  Star star(Index vertex) const override;
  Offset edge_count() const noexcept override { return edge_count_; }
  double length_unit() const noexcept override { return length_unit_; }
  std::optional<Frame> frame(Index vertex) const override;

  /// Number of the vertex at these d steps along the axes.
  /// @throws InvalidArgument (a step outside the grid)
  Vertex vertex(std::span<const Index> steps) const;
  /// Position of a vertex in world units; the third number is 0 for d = 2.
  Vec3 position(Vertex vertex) const;
  /// The source at a point of the domain (d numbers, world units), with the axes of the grid: the corners of the point's cell
  /// with multilinear weights.
  /// @throws InvalidArgument (a point outside the grid or inside an obstacle)
  Source source_at(std::span<const double> point) const;

  const Grid& grid() const noexcept { return grid_; }

  /// As `Surface::suggested_method`: polar in the plane, heat in space.
  Method suggested_method() const { return dimension_ == 2 ? Method::polar : Method::heat; }

 private:
  using Steps = std::array<Index, 3>;

  struct StarPattern;

  Steps steps(Index vertex) const;
  bool is_free(const Steps& cell) const;
  std::size_t pattern_at(Index vertex) const;
  StarPattern make_pattern(std::size_t free_cells) const;
  const StarPattern& pattern(Index vertex) const;
  /// Number of vertices with each pattern.
  std::vector<Offset> count_patterns() const;
  Source source_in_cell(const Steps& cell, const Vec3& share, std::span<const double> point) const;

  Grid grid_;
  int dimension_;
  Index size_ = 1;
  double length_unit_;
  Offset edge_count_ = 0;
  double mean_edge_length_ = 0;
  std::shared_ptr<const std::vector<StarPattern>> patterns_;  ///< one per subset of the 2^d cells around a vertex
  std::vector<double> transports_;                            ///< 2 d times the identity
};

}  // namespace ahm::grid
