/// \file
/// From coordinates back to the surface: the point, normal and axes that lie at (u, v).
///
/// \code
/// ahm::LogMap map = solver.solve(source, {.frames = true});
/// ahm::InverseMap inverse = ahm::inverse_map(surface, map);          // or of a graph that knows frames
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
  Vec3 position;                  ///< on the flat triangle; world units
  Vec3 normal;                    ///< unit: those of the corners, interpolated
  Vec3 du, dv;                    ///< derivatives of the position, constant on a triangle
  Triangle vertices;              ///< the triangle's corners
  std::array<double, 3> weights;  ///< barycentric, >= 0 up to rounding, sum 1

  /// Axes in space: x is the heading of u, perpendicular to the normal; y is the normal turned, not dv.
  Frame frame() const;
};

/// A map and the surface under it: what `InverseMap` needs. Views only, read during the construction.
struct MappedSurface {
  std::span<const Vec3> positions;      ///< n
  std::span<const Vec3> normals;        ///< n, unit, on one side of the surface
  std::span<const double> coordinates;  ///< n x 2, row major, world units
  std::span<const std::uint8_t> valid;  ///< n; 0: the vertex is not to be trusted
  std::span<const Triangle> triangles;  ///< counter-clockwise as seen from the side of the normals; may overlap
  std::span<const Index> sources =
      {};  ///< where the map starts, in the numbers of these arrays; empty: the valid vertex of least |phi|
  std::optional<InversePoint> origin =
      {};  ///< what lies at (0, 0), where it is known, whatever the triangles there are like
};

struct InverseMapOptions {
  /// Triangles with an edge this many times longer or shorter in the plane than in space are left out; > 1.
  double max_stretch = 4;
  /// For `inverse_map`: vertices of a lower `map_quality` are left out; 0: none. It means nothing on maps from a curve
  /// with coordinates of its own.
  double min_quality = trusted_quality;
  std::span<const double> quality =
      {};                ///< of the map's vertices, where it is known already (`map_quality`); empty: found
  unsigned threads = 0;  ///< for the quality; 0: one per core
};

/// The inverse of a map where it has one: answers from triangles that keep their orientation in the plane, have valid
/// corners and are not stretched beyond bounds.
///
/// Where several such triangles lie over (u, v), as behind a fold, the one nearest to the source by graph answers: the
/// length of the shortest way from the source along the edges of the triangles above. Between vertices positions are
/// linear, so off the surface by O(h^2) where it is curved; phi(at(q)) = q to rounding.
class InverseMap {
 public:
  /// O(n log n).
  /// @throws InvalidArgument (lengths, indices, max_stretch)
  explicit InverseMap(const MappedSurface& surface, const InverseMapOptions& options = {});

  /// What lies at (u, v), world units; nothing outside the valid region, but for the source at (0, 0). Thread-safe.
  std::optional<InversePoint> at(double u, double v) const;

  /// The triangles that answer, nearest to the source first.
  std::span<const Triangle> triangles() const noexcept { return triangles_; }
  double max_stretch() const noexcept { return max_stretch_; }
  /// Its corners in the plane.
  std::array<Vec2, 3> corners(const Triangle& triangle) const;
  /// n, as they were given.
  std::span<const Vec3> positions() const noexcept { return positions_; }
  std::span<const Vec3> normals() const noexcept { return normals_; }

 private:
  void make_buckets();
  Index bucket(std::size_t axis, double x) const;
  std::optional<InversePoint> in_triangles(const Vec2& q) const;
  std::optional<InversePoint> in_triangle(const Triangle& triangle, const Vec2& q) const;

  double max_stretch_;
  double unit_ = 1;  // power of two; `plane_` is divided by it
  std::vector<Vec3> positions_, normals_;
  std::vector<Vec2> plane_;
  std::vector<Triangle> triangles_;
  std::optional<InversePoint> origin_;
  Vec2 low_{}, high_{};
  double side_ = 1;  // of a bucket
  std::array<Index, 2> buckets_{};
  std::vector<Offset> bucket_begin_;
  std::vector<Index> bucket_triangles_;
};

/// The inverse of a map on any graph that knows frames: triangles are those of `star_triangles`, valid is what has
/// coordinates and the quality asked for.
/// @param map  with frames, of this graph, of dimension 2
/// @throws InvalidArgument
InverseMap inverse_map(const TangentGraph& graph, const LogMap& map, const InverseMapOptions& options = {});

/// The inverse of a map on a surface, by rows: vertices of the inverse are rows of the input. Where there are faces, it
/// answers with points on them, whatever the graph looks like (of several vertices of a row the one nearest to the source
/// counts); else with the triangles of the graph, of rows that are the first ones of their vertices.
/// @param map  with frames, of the surface's graph
/// @throws InvalidArgument
InverseMap inverse_map(const Surface& surface, const LogMap& map, const InverseMapOptions& options = {});

}  // namespace ahm
