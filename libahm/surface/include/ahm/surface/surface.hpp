/// \file
/// A discretized surface: its tangent graph, and everything that leads from the user's input to the graph and back.
///
/// \code
/// auto surface = ahm::pointcloud::PointCloudSurface::build(points);       // or a mesh, of triangles or polygons
/// const ahm::LogMapSolver solver(surface.graph());
/// ahm::LogMap map = solver.solve(surface.source(ahm::Row{42}).source);     // a row of the input, never a bare number
/// ahm::RowLogMap result = surface.on_rows(map);                            // result.u[i], ... for every row i
/// \endcode
#pragma once

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

/// A source and where it lies in space.
struct PlacedSource {
  Source source;
  Vec3 position{};             ///< world units
  std::optional<Frame> frame;  ///< u axis, v axis and normal in space; none without positions
  std::optional<Row> row;      ///< where the source is a row
};

/// What every discretized surface (d = 2) offers beyond its graph. Immutable; all members may be called from many threads
/// at once. Rows are those of the input as given: of a mesh its vertices, of a cloud its points.
class Surface {
 public:
  virtual ~Surface() = default;

  /// Stays where it is when the surface is moved.
  virtual const TangentGraph& graph() const = 0;
  virtual const RowMap& rows() const = 0;

  /// One per row, as given, world units; empty for a surface given by lengths alone.
  virtual std::span<const Vec3> positions() const = 0;
  /// Unit normal per row, as the graph uses it (orientation included); NaN where there is none.
  virtual std::vector<Vec3> normals() const;
  /// Faces of the input, as given, of rows; empty for clouds.
  virtual FaceList faces() const { return {}; }
  /// The vertex at every corner of `faces()`, faces turned over (but in their place) so that neighbours agree where that is
  /// possible: face f has the corners faces().begin[f] .. faces().begin[f + 1]. Empty for clouds.
  virtual std::span<const Index> corner_vertices() const { return {}; }

  /// The first vertex of a row.
  /// @throws InvalidArgument (row out of range; a row without a vertex, saying why)
  Vertex vertex(Row row) const;
  /// The row with a vertex that is nearest to a position in space. @throws InvalidArgument (no positions; not finite)
  virtual Row nearest_row(const Vec3& position) const;
  /// The nearest point of the faces, or of a cloud the nearest row's tangent plane.
  /// @throws InvalidArgument (no positions; not finite)
  virtual ClosestPoint closest_point(const Vec3& position) const = 0;

  /// A source at a point, u along an axis that the backend documents; or along a vector of space projected to the surface.
  /// @throws InvalidArgument (a point that this surface does not have; an axis along the normal)
  virtual PlacedSource source(const SurfacePoint& point, const std::optional<Vec3>& u_axis = {}) const = 0;

  /// A map on the rows: of several vertices of a row the one nearest to the source counts.
  /// @throws InvalidArgument (another graph's map)
  RowLogMap on_rows(const LogMap& map) const;
  /// (u, v) at every corner of `faces()`, as given; NaN where the map is not ok. Triangle meshes cut it open along the cut
  /// locus; other surfaces give the corner's vertex.
  virtual std::vector<Vec2> on_corners(const LogMap& map) const;
  /// The map at a point: linear in the face that holds it, or near the row moved on by the offset.
  /// @throws InvalidArgument as `source`
  virtual Sample at(const LogMap& map, const SurfacePoint& point) const = 0;

  virtual Report report() const = 0;
  virtual std::vector<Warning> warnings() const = 0;
};

}  // namespace ahm
