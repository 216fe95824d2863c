/// \file
/// Where a log map starts: a weighted set of vertices with offsets, so that a vertex, a point inside a face and a
/// curve are one and the same thing to the solver.
///
/// \code
/// auto vertex = ahm::Source::at_vertex(ahm::Vertex{7});                        // u axis = first axis of frame 7
/// auto turned = ahm::Source::at_vertex(ahm::Vertex{7}, std::array{0.0, 1.0});  // u axis = second axis of frame 7
/// ahm::Source between(2);  // half way between vertices 3 and 4, one apart
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

/// A source p with its frame: for each sample k a weight b_k, the position z_k of vertex k relative to p in the
/// source's frame, and the source's axes U_k carried to the frame of vertex k.
class Source {
 public:
  /// An empty source in dimension d >= 1; fill it with `add`.
  explicit Source(int dimension);

  /// The vertex itself; the source's axes are those of the vertex's frame, in any dimension.
  static Source at_vertex(Vertex vertex);
  /// d = 2: the vertex itself; the u axis points along `direction` (2 numbers, frame of the vertex, any length > 0), v
  /// is u turned by +90 degrees.
  /// @throws InvalidArgument when the direction is zero or not finite
  static Source at_vertex(Vertex vertex, std::span<const double> direction);

  /// All these vertices at once, weight 1 each: every vertex gets the coordinates that it has from the nearest of them,
  /// with the axes of that vertex's frame; in any dimension.
  static Source at_vertices(std::span<const Vertex> vertices);
  /// All these points at once, in the same sense: every vertex gets the coordinates that it has from the nearest of them,
  /// with the axes of that one.
  /// @param points  each of one point (not a curve); those with a dimension have the same
  /// @throws InvalidArgument
  static Source joined(std::span<const Source> points);

  /// A sample of a curve or another set of points, whose coordinates are not its place on the surface: the point of the
  /// source that it belongs to, from 0, how far the vertex is from that point, and (d = 2) the coordinates of the point; world
  /// units.
  struct Place {
    Index point = 0;
    double distance = 0;
    std::array<double, 2> position{};
  };

  /// Adds a sample of the one point p.
  /// @param weight  b_k >= 0, finite: barycentric or quadrature weight
  /// @param offset  z_k, d numbers in world units: where the vertex lies in the source's frame
  /// @param axes    U_k, d x d orthogonal, row major: column a is source axis a in the frame of `vertex`
  ///                Empty: those of the frame itself
  /// @throws InvalidArgument
  Source& add(Vertex vertex, double weight, std::span<const double> offset, std::span<const double> axes = {});
  /// Adds a sample of a curve. @throws InvalidArgument
  Source& add(Vertex vertex, double weight, std::span<const double> offset, std::span<const double> axes,
              const Place& place);

  /// The same source where vertex i has the number `number(i)`.
  Source renumbered(const std::function<Vertex(Vertex)>& number) const;

  /// None for `at_vertex(vertex)`, `at_vertices` and what is `joined` of these, which fit every dimension.
  std::optional<int> dimension() const noexcept { return dimension_; }
  std::span<const Vertex> vertices() const noexcept { return vertices_; }
  std::span<const double> weights() const noexcept { return weights_; }
  /// z_k; empty without a dimension: all zero.
  std::span<const double> offsets() const noexcept { return offsets_; }
  /// U_k; empty without a dimension: identity.
  std::span<const double> axes() const noexcept { return axes_; }
  /// Of sample k: of a curve as it was given, of `at_vertices` point k, of `joined` its point at |z_k|, else point 0 at |z_k|.
  Place place(std::size_t k) const { return places_[k]; }
  /// Whether coordinates may be something else than positions relative to a point.
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
