/// \file
/// Exact geodesics in terms of a surface's input: log maps like those of the heat method, shortest paths, and straightest
/// geodesics. They are exact on the flat triangles, up to rounding.
///
/// \code
/// auto surface = ahm::trimesh::TriangleMeshSurface::build(positions, faces);
/// const ahm::ExactGeodesics geodesics(surface);
/// ahm::LogMap map = geodesics.log_map(ahm::Row{42});
/// ahm::RowLogMap rows = surface.to_rows(map);                     // the same as for heat maps
/// ahm::exact::GeodesicPath path = geodesics.path(std::array<ahm::SurfacePoint, 2>{ahm::Row{3}, ahm::Row{42}});
/// for (const auto& point : path.points) use(geodesics.position(point));
/// \endcode
#pragma once

#include <array>
#include <limits>
#include <memory>
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

namespace exact {
class Propagation;
struct ExactOptions;
}  // namespace exact

/// Options of exact maps and of everything that uses them.
struct ExactMapOptions {
  /// Vertices farther than this get `Status::beyond_radius`, and the propagation ends there. World units; > 0.
  double radius = std::numeric_limits<double>::infinity();
  Offset max_windows = 0;  ///< as in `exact::ExactOptions`
  Index max_vertices = 0;  ///< as in `exact::ExactOptions`
  bool frames = false;     ///< fill `LogMap::frames`
  Progress progress;
  unsigned threads = 0;  ///< threads of functions that compute several maps; 0: one per core
};

/// One of several sources of an exact map, or one point of a curve.
struct ExactSource {
  SurfacePoint point;
  std::optional<Vec3> u_axis = {};  ///< as in `Surface::source`
  Vec2 position{};                  ///< coordinates of the point, world units
  double angle = 0;                 ///< angle of the u axis in the plane of coordinates, radians
  bool mirrored = false;            ///< v is to the right of the u axis
};

/// A map from several sources, with the number of the source nearest to each vertex; -1 where the status is not ok.
struct LabelledLogMap {
  LogMap map;
  std::vector<Index> labels;
};

/// A surface laid out in triangles, prepared for many maps and paths. Immutable; all members may be called from many threads at
/// once. Refers to the surface, which must not move.
class ExactGeodesics {
 public:
  /// Time and memory linear in the number of faces.
  /// @throws as `Surface::flat_triangles`
  explicit ExactGeodesics(const Surface& surface);
  explicit ExactGeodesics(const Surface&&) = delete;
  /// Uses other triangles than the faces: `Surface::flat_approximation`. The maps are exact on these triangles.
  ExactGeodesics(const Surface& surface, FlatTriangles triangles);

  const Surface& surface() const noexcept { return *surface_; }
  const FlatTriangles& triangles() const noexcept { return flat_; }

  /// The log map from a point, with the axes, statuses and vertices of a heat map. `LogMap::method` is exact. `map_quality` is
  /// low where coordinates of neighbors jump, at the cut locus. There is no error estimate. The frames rotate the direction in
  /// which the shortest path leaves the source to the direction in which it arrives: U_i phi_i / |phi_i| is the gradient of
  /// the distance. They are rotations even where the path reverses the orientation (surfaces that are not orientable).
  /// @param u_axis  as in `Surface::source`
  /// @throws InvalidArgument (as `Surface::source`, `exact::exact_map`), ResourceExhausted, Cancelled
  LogMap log_map(const SurfacePoint& source, const std::optional<Vec3>& u_axis = {},
                 const ExactMapOptions& options = {}) const;
  /// The map from a vertex of the graph, in the axes of its frame. @throws as `log_map` of a point
  LogMap log_map(Vertex source, const ExactMapOptions& options = {}) const;
  /// The map from several sources at once. The label of a vertex is the number of its nearest source. Its coordinates are in
  /// the axes of that source, rotated by the source's angle and shifted by its position. From points of a curve, with u axes
  /// along it and positions by arclength, these are coordinates along the curve and across it (`SurfaceCurve::samples`).
  /// @throws InvalidArgument (no source), as `log_map` of a point
  LabelledLogMap log_map(std::span<const ExactSource> sources, const ExactMapOptions& options = {}) const;

  /// Memory of `seeds`, for many calls on the same geodesics; one per thread. It takes 150 bytes per vertex.
  class Workspace {
   public:
    explicit Workspace(const ExactGeodesics& geodesics);
    ~Workspace();
    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;

   private:
    friend class ExactGeodesics;
    std::unique_ptr<exact::Propagation> windows_;
  };
  /// Polar coordinates of the vertices around a source.
  struct Seeds {
    std::vector<Wavefront::Seed> vertices;
    /// The vertices contain all connected ones up to this distance, world units: the radius, or less if `max_windows` or
    /// `max_vertices` ended the propagation.
    double horizon = 0;
  };
  /// The polar coordinates of `log_map`, for the vertices that windows reach within the options. A front can continue from
  /// them. Without the time to make a workspace, the time depends on the number of windows, not on the size of the surface.
  /// @param options  frames: whether arrival directions and orientations are computed, too
  /// @throws as `log_map` of a point
  Seeds seeds(const SurfacePoint& source, const std::optional<Vec3>& u_axis, const ExactMapOptions& options,
              Workspace& workspace) const;
  Seeds seeds(Vertex source, const ExactMapOptions& options, Workspace& workspace) const;

  /// The shortest path through points in their order. Its length is in world units; `position` converts its points to space.
  /// @throws InvalidArgument (fewer than two points; as `Surface::source`)
  exact::GeodesicPath path(std::span<const SurfacePoint> stops, bool closed = false) const;

  /// Shortest paths between many pairs of points (`exact::geodesic_paths`).
  /// @throws InvalidArgument (as `Surface::source`), Cancelled
  std::vector<exact::GeodesicPath> paths(std::span<const std::array<SurfacePoint, 2>> pairs,
                                         const Progress& progress = {}, unsigned threads = 0) const;
  /// Makes a curve locally shortest: pulls it taut between its ends. `closed`: a loop, of which every point may move.
  /// @throws as `exact::shortened_path`
  exact::GeodesicPath shortened(std::span<const exact::MeshPoint> curve, bool closed = false) const;
  /// A locally shortest path, without an exact map. It is fast on surfaces of any size, but not always the shortest
  /// (`exact::locally_shortest_path`). @throws InvalidArgument (as `Surface::source`)
  exact::GeodesicPath locally_shortest_path(const SurfacePoint& from, const SurfacePoint& to) const;

  /// The straightest geodesic from a point along a vector of space, projected to the surface.
  /// @param length  >= 0, world units; so is the length of the result
  /// @throws InvalidArgument (as `Surface::source`, `exact::trace`)
  exact::TracedPath trace(const SurfacePoint& from, const Vec3& direction, double length) const;

  /// Converts a point of the surface to a point of the triangles.
  /// @throws InvalidArgument (a point that is not on the surface)
  exact::MeshPoint point(const SurfacePoint& point) const;
  /// Position of a point of the triangles, world units. @throws InvalidArgument (no positions)
  Vec3 position(const exact::MeshPoint& point) const;

 private:
  /// Axes of a source in the tangent plane of `exact::ExactMap::direction`: u is (a[0], a[2]), v is (a[1], a[3]).
  using Axes = std::array<double, 4>;
  struct PlacedSources;
  static PlacedSources at_vertex(const FlatTriangles& flat, Vertex source);
  exact::ExactMap exact_map(const PlacedSources& from, const ExactMapOptions& options) const;
  LabelledLogMap log_map(const PlacedSources& from, Source source, const ExactMapOptions& options) const;
  Seeds seeds(const PlacedSources& from, const ExactMapOptions& options, Workspace& workspace) const;
  exact::ExactOptions window_options(const ExactMapOptions& options) const;
  PlacedSources placed(std::span<const ExactSource> sources) const;
  static Source joined(std::span<const ExactSource> given, const PlacedSources& placed);
  std::vector<double> jumps(std::span<const double> coordinates, std::span<const Index> labels, bool of_curve) const;
  Axes axes(const SurfacePoint& at, const SurfaceSource& placed, const exact::MeshPoint& point) const;
  Axes vertex_axes(const SurfaceSource& placed) const;
  exact::TracedPath trace_to(const SurfaceSource& placed) const;
  double u_angle_beyond_row(const SurfaceSource& placed) const;
  double u_angle_in_face(const SurfacePoint& at, const SurfaceSource& placed, Index face) const;
  Axes at_corner(exact::Half corner, double u) const;

  const Surface* surface_;
  FlatTriangles flat_;
};

/// Computes one exact log map. @throws as `ExactGeodesics`
LogMap exact_log_map(const Surface& surface, const SurfacePoint& source, const std::optional<Vec3>& u_axis = {},
                     const ExactMapOptions& options = {});

}  // namespace ahm
