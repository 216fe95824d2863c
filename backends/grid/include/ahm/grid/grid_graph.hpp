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
#include <optional>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"

namespace ahm::grid {

/// A box of vertices in R^d, d = 2 or 3. The cells between them are the domain, less the blocked ones.
struct Grid {
  std::vector<Index> shape;  ///< vertices along each axis, d numbers >= 2
  /// d lengths > 0. Where they differ by more than about a thousand times, the solver refuses the graph.
  std::vector<double> spacing;
  std::vector<double> origin;  ///< position of vertex 0, d numbers; empty: zero
  /// One byte per cell, not 0: an obstacle. The first axis runs fastest, and there is one cell fewer than vertices along
  /// each axis. Empty: no obstacles.
  std::vector<std::uint8_t> blocked;
};

/// The tangent graph of a grid: an edge to every neighbour along an axis, the finite volume (5 or 7 point) Laplacian, and
/// the coordinate axes as the frame of every vertex. The first axis runs fastest in the numbering of vertices.
///
/// No star is stored: the graph takes one byte per cell where there are obstacles, and nothing otherwise.
/// The span `neighbors` of a star holds until the next call of `star` on the same thread on this or another grid.
///
/// **Obstacles.** Vertices inside an obstacle have no edges and get `Status::disconnected`, like rooms without a door. Cells
/// that touch in a corner are joined there. Transport along a way round an obstacle is the identity as everywhere on a
/// flat domain, so the log map stays the identity, `position - source`: where a vertex lies as the crow flies, not the
/// way to walk there. `LogMap::distance` is the straight distance, also through walls; `map_quality` sees them where the way
/// around is longer by a tenth and an edge, and `Wavefront` (cells, farthest points) goes around them.
class GridGraph final : public TangentGraph {
 public:
  /// @throws InvalidGeometry (not 2 or 3 axes, an axis of fewer than 2 vertices, a length or position not finite or not
  /// in range, a number of blocked bytes that is not that of the cells, no free cell), ResourceExhausted (more vertices
  /// than an `Index` counts)
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
  /// @throws InvalidArgument when a step is outside the grid
  Vertex vertex(std::span<const Index> steps) const;
  /// Position of a vertex in world units; the third number is 0 for d = 2.
  Vec3 position(Vertex vertex) const;
  /// The source at a point of the domain (d numbers, world units), its axes those of the grid: the corners of its cell
  /// with multilinear weights.
  /// @throws InvalidArgument when the point is outside the grid or inside an obstacle
  Source source_at(std::span<const double> point) const;

  const Grid& grid() const noexcept { return grid_; }

 private:
  using Steps = std::array<Index, 3>;

  /// The star of every vertex with the same free cells about it.
  struct Pattern {
    std::size_t degree = 0;
    double mass = 0;
    std::array<Index, 6> jumps;      ///< from the number of a vertex to that of its neighbour
    std::array<double, 6> weights;   ///< area of the dual face / length of the edge
    std::array<double, 6 * 3> logs;  ///< degree x d
  };

  Steps steps(Index vertex) const;
  bool is_free(const Steps& cell) const;
  std::size_t pattern_at(Index vertex) const;
  Pattern make_pattern(std::size_t free_cells) const;
  /// How many vertices have each pattern.
  std::vector<Offset> count_patterns() const;
  Source source_in_cell(const Steps& cell, const Vec3& share, std::span<const double> point) const;

  Grid grid_;
  int dimension_;
  Index size_ = 1;
  double length_unit_;
  Offset edge_count_ = 0;
  double mean_edge_length_ = 0;
  std::vector<Pattern> patterns_;   ///< one per subset of the 2^d cells about a vertex
  std::vector<double> transports_;  ///< 2 d times the identity
};

}  // namespace ahm::grid
