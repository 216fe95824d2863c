/// \file
/// The one-rings of vertices and midpoints, across whose triangles a front unfolds.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ahm/maps/wavefront.hpp"

namespace ahm {

/// The corners around each vertex, counterclockwise.
///
/// In coarse triangulations each triangle is cut into four at the midpoints of its sides. The front visits midpoints like vertices. One
/// vertex cannot represent the different paths around a corner; without midpoints this causes errors of the order of an edge length.
class Wavefront::OneRings {
 public:
  /// A neighbor of a vertex, and the angle from it to the next neighbor counterclockwise.
  struct Corner {
    Index neighbor;
    bool reflects;  ///< whether the transport along the edge is a reflection
    bool is_far;  ///< whether the neighbor is the far corner of a square, between the two corners that have edges to it
    double length;
    double cosine, sine;  ///< of the angle; NaN if there is no triangle between the two neighbors
  };
  /// A neighbor of a vertex in its tangent plane.
  struct Neighbor {
    Index vertex;
    Vec2 log;
    double length, turn;
    std::size_t edge;
    bool reflects;
  };

  /// @param halved  for each vertex whether its triangles are cut; equal within a connected component. Flat components stay whole. So do
  ///                components with an ambiguous triangle: too thin, one-sided, or with two equally long edges between the same vertices
  /// @param all     whether to store the corners of the other vertices, too. In other dimensions than 2 none are stored
  OneRings(const TangentGraph& graph, std::vector<std::uint8_t> halved, bool all, unsigned threads = 1);

  /// Number of vertices and midpoints. Midpoints have the numbers after the vertices.
  Index size() const noexcept { return size_; }
  /// The corners of a point; empty if they are not stored.
  std::span<const Corner> of(Index point) const {
    if (begin_.empty()) return {};
    return std::span(corners_).subspan(static_cast<std::size_t>(begin_[point]),
                                       static_cast<std::size_t>(begin_[point + 1] - begin_[point]));
  }

  /// Whether the corners of a point are stored.
  bool keeps(Index point) const { return all_ || !of(point).empty(); }
  /// Gaussian curvature at a point whose corners are stored; at a midpoint the mean of the ends.
  double curvature(Index point) const { return curvatures_[point]; }
  /// Gaussian curvature: the angle defect divided by a third of the area of the triangles. 0 at the boundary, and if the defect may be
  /// rounding.
  static double curvature_of(std::span<const Corner> corners);

  /// An edge of a vertex that is cut at its midpoint.
  struct CutEdge {
    Index end, midpoint;
    double half;  ///< half of its length
  };
  /// Finds the cut edges of a vertex, in order of their ends. Parallel edges are left out.
  void find_cut_edges(Index vertex, std::vector<CutEdge>& edges) const;

  /// Appends the corners of a vertex; `neighbors` is workspace.
  static void append_corners(const TangentGraph& graph, Index vertex, std::vector<Neighbor>& neighbors,
                             std::vector<Corner>& corners);

 private:
  class Halving;

  /// Finds the neighbors of a vertex, counterclockwise.
  static void find_neighbors(const TangentGraph& graph, Index vertex, std::vector<Neighbor>& neighbors);

  Index vertices_, size_;
  bool all_ = false;  ///< whether the corners of all points are stored
  std::vector<Offset> begin_;
  std::vector<Corner> corners_;
  std::vector<double> curvatures_;  ///< Gaussian curvature at the stored points
};

/// The largest number of vertices of a component whose triangles are cut. Midpoints make a front four times as expensive.
inline constexpr Index most_halved = 10000;

/// For each vertex whether its component has at most `most_halved` vertices.
/// @param component  component of each vertex
/// @param sizes      number of vertices of each component
std::vector<std::uint8_t> halved_vertices(std::span<const Index> component, std::span<const Index> sizes);
/// For each vertex of a graph whether its component is small; empty if the graph is not a Delaunay triangulation.
std::vector<std::uint8_t> halved_vertices(const TangentGraph& graph);

}  // namespace ahm
