/// \file
/// A discretized surface: its tangent graph, and everything that leads from the user's input to the graph and back.
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

/// A source and where it lies in space.
struct SurfaceSource {
  Source source;
  Vec3 position{};             ///< world units; zero without positions
  std::optional<Frame> frame;  ///< u axis, v axis and normal in space; none without positions or area
  std::optional<Row> row;      ///< where the source is a row
};

/// What reading an input and building its surface takes, per row, on one core of a 3 GHz machine.
struct BuildCost {
  double bytes, seconds;
};

/// What every discretized surface (d = 2) offers beyond its graph. Immutable; all members may be called from many threads
/// at once. Rows are those of the input as given: of a mesh its vertices, of a cloud its points.
///
/// A new one has to tell its graph, rows, positions and, if it has any, faces; a mesh also how a source lies in a face.
/// What these return stays where it is when the surface is moved.
class Surface {
 public:
  virtual ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  virtual const TangentGraph& graph() const& = 0;
  void graph() && = delete;
  virtual const RowMap& rows() const = 0;
  /// One per row, as given, world units; empty for a surface given by lengths alone.
  virtual std::span<const Vec3> positions() const = 0;
  /// Unit normal per row, as the graph uses it (orientation included); NaN where there is none.
  /// @param threads  0: one per core
  std::vector<Vec3> normals(unsigned threads = 0) const;
  /// Faces of the input, as given, of rows; empty for clouds.
  virtual FaceList faces() const { return {}; }
  /// The vertex at every corner of `faces()`, faces turned over (but in their place, the first corner staying first) so
  /// that neighbours agree where that is possible: face f has the corners faces().begin[f] .. faces().begin[f + 1]. Empty
  /// for clouds.
  virtual std::span<const Index> corner_vertices() const { return {}; }

  /// The first vertex of a row.
  /// @throws InvalidArgument (row out of range, fault "row_out_of_range"; a row without a vertex, by the fault that
  /// `missing_vertex_reason` names)
  Vertex vertex(Row row) const;
  /// The row with a vertex that is nearest to a position in space; of several that of the first vertex. Where it is called
  /// often, a tree over the rows is made. @throws InvalidArgument (no positions; not finite)
  Row nearest_row(const Vec3& position) const;
  /// The nearest point of the faces (polygons as fans from their first corner); without faces, of the tangent plane of the
  /// nearest row, as far as its neighbours reach. The first call makes a tree over the faces. @throws InvalidArgument (no positions; not finite)
  ClosestPoint closest_point(const Vec3& position) const;
  /// Where a point lies, world units. @throws InvalidArgument (a point that this surface does not have; no positions)
  Vec3 position(const SurfacePoint& point) const;

  /// A source at a point. Its u axis lies along a vector of space projected to the surface, or else: at rows along the x
  /// axis of the vertex's frame, on edges from `from` to `to`, in faces along the first side.
  /// @throws InvalidArgument (a point that this surface does not have, faults as `vertex`; an axis that is not finite, zero
  /// or so near to the normal, `normal_error`, that the normal's error decides where it points: fault "axis_along_normal")
  SurfaceSource source(const SurfacePoint& point, const std::optional<Vec3>& u_axis = {}) const;

  /// The faces as flat triangles, for exact geodesics (`ExactGeodesics`).
  /// @throws InvalidArgument (fault "no_flat_triangles": a surface without flat faces), InvalidGeometry (a face of no area)
  virtual FlatTriangles flat_triangles() const;
  /// Where a point lies in these. @throws InvalidArgument (as `source`; as `flat_triangles`)
  exact::MeshPoint flat_point(const FacePoint& point) const;
  exact::MeshPoint flat_point(const EdgePoint& point) const;
  /// Flat triangles on the surface or near it, for polar maps (`PolarMapSolver`): `flat_triangles`, or of a cloud a manifold chosen
  /// from its local triangulations. @throws as `flat_triangles`
  virtual FlatTriangles flat_approximation() const;
  /// The method for log maps: polar on Delaunay triangulations (meshes of triangles, refined polygons) and on clouds that are a surface
  /// with little noise, else heat. docs/concepts/accuracy.md has the measurements.
  virtual Method suggested_method() const;

  /// A map on the rows: of several vertices of a row the one nearest to the source counts.
  /// @param threads  0: one per core
  /// @throws InvalidArgument (another graph's map)
  RowLogMap to_rows(const LogMap& map, unsigned threads = 0) const;
  /// (u, v) at every corner of `faces()`, as given; NaN where the map is not ok. Here, of the corner's vertex; meshes cut
  /// the map open along its cut locus. @throws InvalidArgument (another graph's map)
  virtual std::vector<Vec2> to_corners(const LogMap& map) const;
  /// The map at a point: at a row as `to_rows`, linear in a face and on an edge; in a tangent plane moved on from the row
  /// by the offset, which takes a map with frames. @throws InvalidArgument as `source`; another graph's map
  Sample at(const LogMap& map, const SurfacePoint& point) const;

  /// What was found and done on the way. Ids are listed in the header of the surface's class.
  virtual Report report() const = 0;
  virtual std::vector<Warning> warnings() const = 0;

 protected:
  Surface();
  /// How far normals may be off, degrees.
  virtual double normal_error_degrees() const;
  /// Why a row has no vertex: the end of a sentence that begins with "row 7", and what to do.
  struct Reason {
    std::string_view fault, text, remedy;
  };
  virtual Reason missing_vertex_reason(Row) const { return {"row_unused", "is used by no face", "choose another one"}; }
  /// @param point  of a face that exists, with as many weights as corners: >= 0 with sum 1 (to 1e-9)
  /// The base has no faces. @throws InvalidArgument as `source`
  virtual SurfaceSource source_in_face(const FacePoint& point, const std::optional<Vec3>& u_axis) const;
  /// @param point  with t in [0, 1]. Here, of a point in a face with this edge. @throws InvalidArgument (no such edge), as `source`
  virtual SurfaceSource source_on_edge(const EdgePoint& point, const std::optional<Vec3>& u_axis) const;
  /// @param point  as for `source_in_face`. Here, linear between the vertices at the corners
  virtual Sample sample_in_face(const LogMap& map, const FacePoint& point) const;
  /// @param point  as for `source_in_face`
  virtual exact::MeshPoint flat_point_in_face(const FacePoint& point) const;
  /// A point of a face that has this edge. @throws InvalidArgument (no such edge)
  virtual FacePoint face_point(const EdgePoint& point) const;

  /// The vertex at a corner of a face, the corner counted as given.
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

  struct Lazy;  ///< the trees of `closest_point` and `nearest_row`
  std::unique_ptr<Lazy> lazy_;
};

/// Unit vectors of space that point away from the source along the surface, one per row: the map's own direction, carried
/// to the vertex by its frame. Zero at the source, NaN where the status is not ok.
/// @param map   with frames, of the surface's graph
/// @param rows  `surface.to_rows(map)`
/// @throws InvalidArgument (another graph's map, no frames)
std::vector<Vec3> distance_gradients(const Surface& surface, const LogMap& map, const RowLogMap& rows);

}  // namespace ahm
