/// \file
/// The triangles that a front unfolds across.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ahm/maps/wavefront.hpp"

namespace ahm {

/// The corners around vertices, counterclockwise.
///
/// Where a triangulation is coarse, each of its triangles is cut into four along the midpoints of its sides, which are points
/// of the front like vertices: what one point cannot tell of the ways around a corner is an error of an edge length.
class Wavefront::OneRings {
 public:
  /// @param halved  of every vertex, whether its triangles are cut; one per connected component. Left whole are flat components
  ///                and those with a triangle in doubt: too thin, one-sided, two equally long edges between the same vertices
  /// @param all     whether to keep the corners of the other vertices, too. None are kept in other dimensions than 2
  OneRings(const TangentGraph& graph, std::vector<std::uint8_t> halved, bool all, unsigned threads = 1);

  /// Vertices and, after them, midpoints.
  Index size() const noexcept { return size_; }
  /// Empty where they are not kept.
  std::span<const Corner> of(Index point) const {
    if (begin_.empty()) return {};
    return std::span(corners_).subspan(static_cast<std::size_t>(begin_[point]),
                                       static_cast<std::size_t>(begin_[point + 1] - begin_[point]));
  }

  /// Whether the corners of a point are kept.
  bool keeps(Index point) const { return !of(point).empty(); }
  /// Gaussian curvature at a point that is kept; at a midpoint the mean of the ends.
  double curvature(Index point) const { return curvatures_[point]; }
  /// What the angles of a whole star miss of the full turn, for each of its share of the triangles' area; 0 where the star is
  /// open, or where it may be rounding.
  static double curvature_of(std::span<const Corner> corners);

  /// An edge of a vertex that is cut at its midpoint.
  struct CutEdge {
    Index end, midpoint;
    double half;  ///< half its length
  };
  /// Those of a vertex, by their ends, without the ones that lead to the same end; none where triangles are whole.
  void find_cut_edges(Index vertex, std::vector<CutEdge>& edges) const;

  /// Appends the corners of a vertex; `neighbors` is workspace.
  static void append_corners(const TangentGraph& graph, Index vertex, std::vector<Neighbor>& neighbors,
                             std::vector<Corner>& corners);

 private:
  class Halving;

  /// The neighbours of a vertex, counterclockwise.
  static void find_neighbors(const TangentGraph& graph, Index vertex, std::vector<Neighbor>& neighbors);

  Index vertices_, size_;
  std::vector<Offset> begin_;
  std::vector<Corner> corners_;
  std::vector<double> curvatures_;  ///< of the points, where they are kept
};

/// Components of no more vertices are halved: it makes a front four times the work.
inline constexpr Index most_halved = 10000;

/// Which vertices are of such components.
std::vector<std::uint8_t> halved_vertices(std::span<const Index> component, std::span<const Index> sizes);
/// None where distances are not unfolded.
std::vector<std::uint8_t> halved_vertices(const TangentGraph& graph);

}  // namespace ahm
