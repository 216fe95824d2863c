/// \file
/// From coordinates back to the surface: the point, the normal and the axes at (u, v).
///
/// \code
/// ahm::LogMap map = solver.solve(source, {.frames = true});
/// ahm::InverseMap inverse = ahm::inverse_map(surface, map);          // or of a graph with frames
/// if (auto point = inverse.at(0.3, -0.1)) use(point->position, point->normal, point->frame().x);
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/surface/surface.hpp"
#include "ahm/surface/surface_triangles.hpp"

namespace ahm {

/// A point of the surface and the map's derivatives there.
struct InversePoint {
  Vec3 position;                  ///< on the flat triangle, world units
  Vec3 normal;                    ///< unit length, interpolated from the normals of the corners
  Vec3 du, dv;                    ///< derivatives of the position by u and v, constant on a triangle
  Triangle vertices;              ///< corners of the triangle
  std::array<double, 3> weights;  ///< barycentric weights, >= 0 up to rounding, sum 1

  /// Axes in space: x is the direction of du, perpendicular to the normal; y is x turned about the normal by 90 degrees,
  /// not dv.
  Frame frame() const;
};

/// Input of `InverseMap`: a map and the surface under it. Views only; they are read during the construction.
struct MappedSurface {
  std::span<const Vec3> positions;      ///< n positions, world units
  std::span<const Vec3> normals;        ///< n unit normals, on one side of the surface
  std::span<const double> coordinates;  ///< (u, v) of each vertex: n x 2, row major, world units
  std::span<const std::uint8_t> valid;  ///< n flags; 0: the vertex is not used
  std::span<const Triangle> triangles;  ///< counter-clockwise as seen from the side of the normals; may overlap
  /// Indices of the vertices where the map starts; empty: the valid vertex of smallest |phi|.
  std::span<const Index> sources = {};
  /// The point at (0, 0), if it is known. It is returned there whatever the triangles are.
  std::optional<InversePoint> origin = {};
};

struct InverseMapOptions {
  /// Triangles are left out if an edge is longer or shorter in the plane than in space by more than this factor; > 1.
  double max_stretch = 4;
  /// `inverse_map` leaves out vertices of a lower `map_quality`; 0: none. The quality has no meaning for maps from a curve
  /// with user-defined coordinates.
  double min_quality = reliable_quality;
  /// Quality of each vertex of the map (`map_quality`), if it is known already; empty: it is computed.
  std::span<const double> quality = {};
  unsigned threads = 0;  ///< number of threads that compute the quality; 0: one per core
};

/// The inverse of a map, where it has one. Results come from triangles that have valid corners, keep their orientation in
/// the plane and are stretched by at most `max_stretch`.
///
/// Where several such triangles cover (u, v), as behind a fold, the one nearest to the source is used: by the length of
/// edge paths in these triangles. Positions are interpolated linearly, so they are off a curved surface by O(h^2).
/// phi(at(q)) = q to rounding.
class InverseMap {
 public:
  /// Takes O(n log n) time.
  /// @throws InvalidArgument (lengths, indices, max_stretch)
  explicit InverseMap(const MappedSurface& surface, const InverseMapOptions& options = {});

  /// The point at (u, v), world units; empty outside the valid region, except for the source at (0, 0). Thread-safe.
  std::optional<InversePoint> at(double u, double v) const;

  /// The triangles in use, nearest to the source first.
  std::span<const Triangle> triangles() const noexcept { return triangles_; }
  double max_stretch() const noexcept { return max_stretch_; }
  /// Corners of a triangle in the plane, world units.
  std::array<Vec2, 3> corners(const Triangle& triangle) const;
  /// The n positions and normals passed to the constructor.
  std::span<const Vec3> positions() const noexcept { return positions_; }
  std::span<const Vec3> normals() const noexcept { return normals_; }

 private:
  void make_buckets();
  Index bucket(std::size_t axis, double x) const;
  std::optional<InversePoint> in_triangles(const Vec2& q) const;
  std::optional<InversePoint> in_triangle(const Triangle& triangle, const Vec2& q) const;

  double max_stretch_;
  double unit_ = 1;  // power of two; `plane_` is in this unit
  std::vector<Vec3> positions_, normals_;
  std::vector<Vec2> plane_;
  std::vector<Triangle> triangles_;
  std::optional<InversePoint> origin_;
  Vec2 low_{}, high_{};
  double side_ = 1;  // side of a bucket
  std::array<Index, 2> buckets_{};
  std::vector<Offset> bucket_begin_;
  std::vector<Index> bucket_triangles_;
};

/// The inverse of a map on any graph with frames, by the triangles of `star_triangles`. A vertex is valid if it has
/// coordinates and at least the quality `min_quality`.
/// @param map  with frames, of this graph, of dimension 2
/// @throws InvalidArgument
InverseMap inverse_map(const TangentGraph& graph, const LogMap& map, const InverseMapOptions& options = {});

/// The inverse of a map on a surface, by rows: vertices of the inverse are rows of the input. On surfaces with faces it
/// returns points of the faces; if a row has several vertices, the one nearest to the source is used. Otherwise it uses the
/// triangles of the graph, and of merged rows the first one.
/// @param map  with frames, of the surface's graph
/// @throws InvalidArgument
InverseMap inverse_map(const Surface& surface, const LogMap& map, const InverseMapOptions& options = {});

}  // namespace ahm
