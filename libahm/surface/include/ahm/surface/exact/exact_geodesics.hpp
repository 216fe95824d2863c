/// \file
/// Exact geodesics in terms of a surface's input: log maps that stand beside those of heat, shortest paths, and straight
/// lines. Exact means: of the flat triangles, up to rounding.
///
/// \code
/// auto surface = ahm::trimesh::TriangleMeshSurface::build(positions, faces);
/// const ahm::ExactGeodesics geodesics(surface);
/// ahm::LogMap map = geodesics.log_map(ahm::Row{42});
/// ahm::RowLogMap rows = surface.to_rows(map);                     // as from a map by heat
/// ahm::exact::GeodesicPath path = geodesics.path(std::array<ahm::SurfacePoint, 2>{ahm::Row{3}, ahm::Row{42}});
/// for (const auto& point : path.points) use(geodesics.position(point));
/// \endcode
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ahm/maps/log_map.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/progress.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/surface/exact/geodesic_path.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm {

/// Of all that is made by exact maps.
struct ExactMapOptions {
  /// Vertices farther than this get `Status::beyond_radius`, and the work ends there. World units; > 0.
  double radius = std::numeric_limits<double>::infinity();
  /// How far distances may be off, relative to the true ones, in [0, 0.1]. 0: exact. Above, nearly linear in the number
  /// of vertices (`exact::ExactOptions`); directions may be off by about sqrt(2 tolerance), as those of paths that much
  /// longer are, and are any of those of two ways that differ by less.
  double tolerance = 0;
  Offset max_windows = 0;  ///< as of `exact::ExactOptions`
  bool frames = false;     ///< fill `LogMap::frames`
  Progress progress;
  unsigned threads = 0;  ///< of what makes several maps; 0: one per core
};

/// One of several sources of an exact map; of a curve, one of its points.
struct ExactSource {
  SurfacePoint point;
  std::optional<Vec3> u_axis = {};  ///< as of `Surface::source`
  Vec2 position{};                  ///< coordinates of the point, world units
  double angle = 0;                 ///< of the u axis in the plane of coordinates, radians
  bool mirrored = false;            ///< v to the right of the u axis
};

/// A map from several sources, and which of them each vertex is nearest to; -1 where the status is not ok.
struct LabelledLogMap {
  LogMap map;
  std::vector<Index> labels;
};

/// A surface laid out in triangles, once for many maps and paths. Immutable; all members may be called from many threads at
/// once. Refers to the surface, which has to stay where it is.
class ExactGeodesics {
 public:
  /// Time and memory linear in the number of faces.
  /// @throws as `Surface::flat_triangles`
  explicit ExactGeodesics(const Surface& surface);
  explicit ExactGeodesics(Surface&&) = delete;
  /// Over other triangles than the faces: `Surface::flat_approximation`, to which the maps are exact.
  ExactGeodesics(const Surface& surface, FlatTriangles triangles);

  const Surface& surface() const noexcept { return *surface_; }
  const FlatTriangles& triangles() const noexcept { return flat_; }

  /// The log map from a point, with the axes, statuses and vertices that a map by heat has. `LogMap::method` is exact;
  /// its `map_quality` is low where neighbours jump, at the cut locus, and it has no error estimate. Its frames turn the
  /// direction in which the shortest path leaves the source to that in which it arrives, so that U_i phi_i / |phi_i| is
  /// the gradient of the distance; they are rotations, also where the path reverses the orientation (surfaces that are
  /// not orientable).
  /// @param u_axis  as of `Surface::source`
  /// @throws InvalidArgument (as `Surface::source`, `exact::exact_map`), ResourceExhausted, Cancelled
  LogMap log_map(const SurfacePoint& source, const std::optional<Vec3>& u_axis = {},
                 const ExactMapOptions& options = {}) const;
  /// The map from a vertex of the graph, in the axes of its frame. @throws as above
  LogMap log_map(Vertex source, const ExactMapOptions& options = {}) const;
  /// The map from several points at once: every vertex is seen from the nearest, whose number is its label, in the axes
  /// of that one, turned by its angle and moved on from its position. From points of a curve, with u axes along it and
  /// positions by arclength, these are coordinates along the curve and across it (`SurfaceCurve::samples`).
  /// @throws InvalidArgument (no source), as above
  LabelledLogMap log_map(std::span<const ExactSource> sources, const ExactMapOptions& options = {}) const;

  /// The same polar coordinates, of the vertices that the options let the windows reach: where a front can go on from.
  /// @param options  frames: whether the arrivals are wanted, too
  /// @throws as above
  std::vector<Wavefront::Seed> seeds(const SurfacePoint& source, const std::optional<Vec3>& u_axis = {},
                                     const ExactMapOptions& options = {}) const;
  std::vector<Wavefront::Seed> seeds(Vertex source, const ExactMapOptions& options = {}) const;

  /// The shortest path through points in their order. Its length is in world units; `position` tells where its points lie.
  /// @throws InvalidArgument (fewer than two points; as `Surface::source`)
  exact::GeodesicPath path(std::span<const SurfacePoint> stops, bool closed = false) const;

  /// Shortest paths between many pairs of points (`exact::geodesic_paths`).
  /// @throws InvalidArgument (as `Surface::source`), Cancelled
  std::vector<exact::GeodesicPath> paths(std::span<const std::array<SurfacePoint, 2>> pairs,
                                         const Progress& progress = {}, unsigned threads = 0) const;
  /// The same curve made locally shortest: pulled taut, its ends apart. `closed`: a loop, no point of which is kept.
  /// @throws as `exact::shortened_path`
  exact::GeodesicPath shortened(std::span<const exact::MeshPoint> curve, bool closed = false) const;
  /// A locally shortest path, without an exact map: fast on surfaces of any size, not always the shortest
  /// (`exact::locally_shortest_path`). @throws InvalidArgument (as `Surface::source`)
  exact::GeodesicPath locally_shortest_path(const SurfacePoint& from, const SurfacePoint& to) const;

  /// The straightest geodesic from a point along a vector of space, projected to the surface.
  /// @param length  >= 0, world units, as of the result
  /// @throws InvalidArgument (as `Surface::source`, `exact::trace`)
  exact::TracedPath trace(const SurfacePoint& from, const Vec3& direction, double length) const;

  /// A point of the surface as one of the triangles.
  /// @throws InvalidArgument (a point that the surface does not have)
  exact::MeshPoint point(const SurfacePoint& point) const;
  /// Where a point of the triangles lies, world units. @throws InvalidArgument (no positions)
  Vec3 position(const exact::MeshPoint& point) const;

 private:
  /// Axes of a source in the tangent plane in which `exact::ExactMap::direction` counts: u is (a[0], a[2]), v (a[1], a[3]).
  using Axes = std::array<double, 4>;
  /// The sources as heat has them, and what they are in the triangles.
  struct Placed {
    std::vector<exact::MeshPoint> points;
    std::vector<Axes> axes;
    std::vector<Source> sources;
    std::vector<Vec2> positions;
  };
  static Placed at_vertex(const FlatTriangles& flat, Vertex source);
  exact::ExactMap exact_map(const Placed& from, const ExactMapOptions& options) const;
  LabelledLogMap log_map(const Placed& from, Source source, const ExactMapOptions& options) const;
  std::vector<Wavefront::Seed> seeds(const Placed& from, const ExactMapOptions& options) const;
  Placed placed(std::span<const ExactSource> sources) const;
  static Source joined(std::span<const ExactSource> given, const Placed& placed);
  std::vector<double> jumps(std::span<const double> coordinates, std::span<const Index> labels, bool of_curve) const;
  Axes axes(const SurfacePoint& at, const SurfaceSource& placed, const exact::MeshPoint& point) const;
  Axes vertex_axes(const SurfaceSource& placed) const;
  exact::TracedPath trace_to(const SurfaceSource& placed) const;
  double u_beyond_row(const SurfaceSource& placed) const;
  double u_in_face(const SurfacePoint& at, const SurfaceSource& placed, Index face) const;
  Axes at_corner(exact::Half corner, double u) const;

  const Surface* surface_;
  FlatTriangles flat_;
};

/// One map. @throws as `ExactGeodesics`
LogMap exact_log_map(const Surface& surface, const SurfacePoint& source, const std::optional<Vec3>& u_axis = {},
                     const ExactMapOptions& options = {});

}  // namespace ahm
