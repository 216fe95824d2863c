/// \file
/// A discretized surface: its tangent graph, and the conversions between the user's input and the graph.
///
/// \code
/// auto surface = ahm::pointcloud::PointCloudSurface::build(points);       // or a mesh, of triangles or polygons
/// const ahm::LogMapSolver solver(surface.graph());
/// ahm::LogMap map = solver.solve(surface.source(ahm::Row{42}).source);     // a row of the input, never a bare number
/// ahm::RowLogMap result = surface.to_rows(map);                            // result.u[i], ... for every row i
/// \endcode
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/report.hpp"
#include "ahm/surface/row_log_map.hpp"
#include "ahm/surface/row_map.hpp"
#include "ahm/surface/surface_point.hpp"

namespace ahm {

namespace exact {
struct MeshPoint;
}
struct FlatTriangles;

/// A source and its position in space.
struct SurfaceSource {
  Source source;
  Vec3 position{};             ///< world units; zero without positions
  std::optional<Frame> frame;  ///< u axis, v axis and normal in space; none without positions or area
  std::optional<Row> row;      ///< row of the source, if it is a row
};

/// Memory and time to read an input and build its surface, per row, on one core of a 3 GHz machine.
struct BuildCost {
  double bytes, seconds;
};

/// Interface of every discretized surface (d = 2). Immutable; all members may be called from many threads at once. Rows are
/// those of the input: the vertices of a mesh or the points of a cloud.
///
/// A derived class must provide its graph, rows and positions, and faces if it has any. A mesh also provides sources inside
/// faces. References and spans that these functions return stay valid when the surface is moved.
class Surface {
 public:
  virtual ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  virtual const TangentGraph& graph() const& = 0;
  void graph() const&& = delete;
  virtual const RowMap& rows() const = 0;
  /// Input position of each row, world units; empty for a surface defined by edge lengths only.
  virtual std::span<const Vec3> positions() const = 0;
  /// Unit normal of each row, with the orientation that the graph uses; NaN where there is none.
  /// @param threads  0: one per core
  std::vector<Vec3> normals(unsigned threads = 0) const;
  /// Faces of the input, unchanged, as lists of rows; empty for clouds.
  virtual FaceList faces() const { return {}; }
  /// Vertex at every corner of the faces, oriented consistently where possible. Face f has the corners faces().begin[f] ..
  /// faces().begin[f + 1]. A reversed face keeps its place and its first corner. Empty for clouds.
  virtual std::span<const Index> corner_vertices() const { return {}; }

  /// The first vertex of a row.
  /// @throws InvalidArgument (fault "row_out_of_range"; for a row without a vertex, the fault of `missing_vertex_reason`)
  Vertex vertex(Row row) const;
  /// The row nearest to a position in space, among the rows with a vertex. Of several rows at the same distance, that of the
  /// first vertex. Repeated calls build a search tree. @throws InvalidArgument (no positions; not finite)
  Row nearest_row(const Vec3& position) const;
  /// The nearest point of the faces (polygons are split into fans from their first corner). Without faces: the nearest point of
  /// the tangent plane of the nearest row, within the distance of the row's farthest neighbor. The first call builds a search
  /// tree over the faces.
  /// @throws InvalidArgument (no positions; not finite; no faces and no frames)
  ClosestPoint closest_point(const Vec3& position) const;
  /// Position of a point, world units. @throws InvalidArgument (a point that is not on this surface; no positions)
  Vec3 position(const SurfacePoint& point) const;

  /// A source at a point. Its u axis is a vector of space, projected to the surface. The default is the x axis of the vertex's
  /// frame at rows, the direction from `from` to `to` on edges, and the first side in faces.
  /// @throws InvalidArgument (a point that is not on this surface, with the faults of `vertex`; an axis that is zero or not
  /// finite; fault "axis_along_normal": an axis within `normal_error` of the normal, whose projection is arbitrary)
  SurfaceSource source(const SurfacePoint& point, const std::optional<Vec3>& u_axis = {}) const;
  /// The unit vector along the surface at an angle from the u axis of `source(point)`, counterclockwise, in radians.
  /// @throws InvalidArgument (as `source`; no frame at the point)
  Vec3 direction(const SurfacePoint& point, double angle) const;

  /// The faces as flat triangles, for exact geodesics (`ExactGeodesics`).
  /// @throws InvalidArgument (fault "no_flat_triangles": no flat faces), InvalidGeometry (a face without area)
  virtual FlatTriangles flat_triangles() const;
  /// The point of `flat_triangles` at a point of the surface. @throws InvalidArgument (as `source`; as `flat_triangles`)
  exact::MeshPoint flat_point(const FacePoint& point) const;
  exact::MeshPoint flat_point(const EdgePoint& point) const;
  /// Flat triangles on or near the surface, for polar maps (`PolarMapSolver`): `flat_triangles`, or for a cloud a manifold
  /// selected from its local triangulations.
  /// @throws as `flat_triangles`
  virtual FlatTriangles flat_approximation() const;
  /// The method suggested for log maps. Polar on Delaunay triangulations (triangle meshes, refined polygons) and on clouds that
  /// form a surface with little noise; heat otherwise. Measurements are in docs/concepts/accuracy.md.
  virtual Method suggested_method() const;

  /// A map by rows. A row with several vertices gets the values of the vertex nearest to the source.
  /// @param threads  0: one per core
  /// @throws InvalidArgument (another graph's map)
  RowLogMap to_rows(const LogMap& map, unsigned threads = 0) const;
  /// (u, v) at every corner of `faces()`, in the input's corner order; NaN where the map is not ok. The base class returns the
  /// value of the corner's vertex. Meshes cut the map open along its cut locus.
  /// @throws InvalidArgument (another graph's map)
  virtual std::vector<Vec2> to_corners(const LogMap& map) const;
  /// The map at a point. At a row it is that of `to_rows`; in a face or on an edge it is interpolated linearly. In a tangent
  /// plane it is the row's value plus the offset, which requires a map with frames.
  /// @throws InvalidArgument (as `source`; another graph's map)
  Sample at(const LogMap& map, const SurfacePoint& point) const;

  /// Figures and warnings from building the surface. The header of each surface class lists the ids.
  virtual Report report() const = 0;
  virtual std::vector<Warning> warnings() const = 0;

 protected:
  Surface();
  /// Bound on the error of the normals, degrees.
  virtual double normal_error_degrees() const;
  /// Why a row has no vertex. `text` completes a sentence that begins with "row 7"; `remedy` is what to do.
  struct Reason {
    std::string_view fault, text, remedy;
  };
  virtual Reason missing_vertex_reason(Row) const { return {"row_unused", "is used by no face", "choose another one"}; }
  /// A source inside a face. The base class has no faces and throws.
  /// @param point  in an existing face; one weight per corner, >= 0, with sum 1 (to 1e-9)
  /// @throws InvalidArgument (as `source`)
  virtual SurfaceSource source_in_face(const FacePoint& point, const std::optional<Vec3>& u_axis) const;
  /// A source on an edge. The base class uses the source inside a face with this edge.
  /// @param point  with t in [0, 1]
  /// @throws InvalidArgument (no such edge; as `source`)
  virtual SurfaceSource source_on_edge(const EdgePoint& point, const std::optional<Vec3>& u_axis) const;
  /// The map inside a face. The base class interpolates linearly between the vertices at the corners.
  /// @param point  as for `source_in_face`
  virtual Sample sample_in_face(const LogMap& map, const FacePoint& point) const;
  /// The point of `flat_triangles` inside a face.
  /// @param point  as for `source_in_face`
  virtual exact::MeshPoint flat_point_in_face(const FacePoint& point) const;
  /// The point of a face that has this edge. @throws InvalidArgument (no such edge)
  virtual FacePoint face_point(const EdgePoint& point) const;

  /// The vertex at a corner of a face. Corners are counted in the input's order.
  Vertex corner_vertex(Index face, std::size_t corner) const;
  /// @throws InvalidArgument (another graph's map)
  void check_map(const LogMap& map) const;
  /// @throws InvalidArgument (face, weights)
  void check(const FacePoint& point) const;

 private:
  SurfaceSource placed(const SurfacePoint& point, const std::optional<Vec3>& u_axis) const;
  SurfaceSource source_at_row(Row row, const std::optional<Vec3>& u_axis) const;
  SurfaceSource source_near_row(const TangentPoint& point, const std::optional<Vec3>& u_axis) const;
  void check(const EdgePoint& point) const;

  struct Lazy;  ///< search trees of `closest_point` and `nearest_row`
  std::unique_ptr<Lazy> lazy_;
};

/// Unit vectors in space that point away from the source along the surface, one per row. The frame of the vertex takes the
/// map's own direction to space. Zero at the source, NaN where the status is not ok.
/// @param map   map on the surface's graph, with frames
/// @param rows  `surface.to_rows(map)`
/// @throws InvalidArgument (another graph's map, no frames)
std::vector<Vec3> distance_gradients(const Surface& surface, const LogMap& map, const RowLogMap& rows);

}  // namespace ahm
