/// \file
/// The source of a log map: a weighted set of vertices with offsets. The solver treats a vertex, a point inside a face and a curve alike.
///
/// \code
/// auto vertex = ahm::Source::at_vertex(ahm::Vertex{7});                        // u axis = first axis of frame 7
/// auto turned = ahm::Source::at_vertex(ahm::Vertex{7}, std::array{0.0, 1.0});  // u axis = second axis of frame 7
/// ahm::Source between(2);  // the midpoint of vertices 3 and 4, whose distance is 1
/// between.add(ahm::Vertex{3}, 0.5, std::array{-0.5, 0.0}, axes_in_frame_3);
/// between.add(ahm::Vertex{4}, 0.5, std::array{+0.5, 0.0}, axes_in_frame_4);
/// \endcode
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "ahm/types.hpp"

namespace ahm {

/// A source point p with its frame. Each sample k has a weight b_k, the position z_k of its vertex relative to p in the source's frame,
/// and the source's axes U_k, parallel transported to the frame of its vertex.
class Source {
 public:
  /// An empty source in dimension d >= 1; fill it with `add`.
  explicit Source(int dimension);

  /// A vertex, in any dimension. The source's axes are those of the vertex's frame.
  static Source at_vertex(Vertex vertex);
  /// A vertex, d = 2. The u axis points along `direction` (2 numbers, frame of the vertex, any length > 0); v is u rotated by +90 degrees.
  /// @throws InvalidArgument when the direction is zero or not finite
  static Source at_vertex(Vertex vertex, std::span<const double> direction);

  /// Several vertices of weight 1 each, in any dimension. Each vertex of the graph gets coordinates relative to the nearest source vertex,
  /// in the frame of that source vertex.
  static Source at_vertices(std::span<const Vertex> vertices);
  /// Several points. Each vertex of the graph gets coordinates relative to the nearest of the points, in the axes of that point.
  /// @param points  sources of one point each, not curves; all dimensions that are set are equal
  /// @throws InvalidArgument
  static Source joined(std::span<const Source> points);

  /// The place of a sample on the surface, for curves and other sets of points whose coordinates are not positions on the surface.
  struct Place {
    Index point = 0;                   ///< number of the source point that the sample belongs to, from 0
    double distance = 0;               ///< distance of the vertex from that point, world units
    std::array<double, 2> position{};  ///< coordinates of that point, d = 2, world units
  };

  /// Adds a sample of the single point p.
  /// @param weight  b_k >= 0, finite: barycentric or quadrature weight
  /// @param offset  z_k, d numbers in world units: position of the vertex in the source's frame
  /// @param axes    U_k, d x d orthogonal, row major: column a is source axis a in the frame of `vertex`.
  ///                Empty: the axes of that frame
  /// @throws InvalidArgument
  Source& add(Vertex vertex, double weight, std::span<const double> offset, std::span<const double> axes = {});
  /// Adds a sample of a curve. @throws InvalidArgument
  Source& add(Vertex vertex, double weight, std::span<const double> offset, std::span<const double> axes,
              const Place& place);

  /// A copy in which vertex i has the number `number(i)`.
  Source renumbered(const std::function<Vertex(Vertex)>& number) const;

  /// Dimension d. Not set for `at_vertex(vertex)`, `at_vertices` and sources `joined` from these, which fit every dimension.
  std::optional<int> dimension() const noexcept { return dimension_; }
  std::span<const Vertex> vertices() const noexcept { return vertices_; }
  std::span<const double> weights() const noexcept { return weights_; }
  /// z_k of all samples, d numbers each, world units. Empty if the dimension is not set; they are then zero.
  std::span<const double> offsets() const noexcept { return offsets_; }
  /// U_k of all samples, d x d numbers each. Empty if the dimension is not set; they are then the identity.
  std::span<const double> axes() const noexcept { return axes_; }
  /// The place of sample k. A curve returns the one passed to `add`. `at_vertices` returns point k at distance 0, `joined` the number of
  /// the point at distance |z_k|. Other sources return point 0 at distance |z_k|.
  Place place(std::size_t k) const { return places_[k]; }
  /// Whether the coordinates may differ from positions relative to a point.
  bool is_curve() const noexcept { return is_curve_; }

 private:
  Source() = default;
  void append(Vertex vertex, double weight, std::span<const double> offset, std::span<const double> axes,
              const Place& place);

  std::optional<int> dimension_;
  std::vector<Vertex> vertices_;
  std::vector<double> weights_;
  std::vector<double> offsets_;
  std::vector<double> axes_;
  std::vector<Place> places_;
  bool is_curve_ = false;
};

}  // namespace ahm
