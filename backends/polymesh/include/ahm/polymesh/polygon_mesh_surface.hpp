/// \file
/// A polygon mesh as a surface, in either of two discretizations: without triangulating it, by the Laplacian and mass of
/// [BHKB20], every pair of corners of a polygon an edge; or refined by their virtual vertices, as a triangle mesh.
///
/// \code
/// auto surface = ahm::polymesh::PolygonMeshSurface::build(positions, face_begin, face_vertices);
/// ahm::LogMapSolver solver(surface.graph());
/// ahm::LogMap map = solver.solve(surface.source(ahm::FacePoint{7, {0.25, 0.25, 0.25, 0.25}}).source);
/// ahm::RowLogMap result = surface.to_rows(map);                           // one row per input vertex
/// \endcode
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/polymesh/polygon_mesh.hpp"
#include "ahm/progress.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm::polymesh {

enum class Discretization {
  automatic,  ///< refined, unless faces are twisted (`Refinement::folded`)
  /// Polygons as they are. Tangent planes stand perpendicular to the sum of the vector areas of the faces at a vertex. Logs
  /// are chords projected to them and brought to the chord's length; transport goes through the plane of the polygon
  /// (perpendicular to its vector area) by the smallest rotations. Exact on planar meshes, whatever their polygons. Time and
  /// memory linear in the number of pairs of corners, the sum of m^2 over faces of m corners.
  polygons,
  refined,  ///< `PolygonMesh::refined` as a triangle mesh: more accurate; its first vertices are those of the mesh
};

struct PolygonOptions {
  Discretization discretization = Discretization::automatic;
  /// Refined: flip edges of the triangles until all are Delaunay.
  bool intrinsic_delaunay = true;
  /// Polygons: keep weights in [0, 1e4]. Stretched and concave polygons have negative ones; as 0 they leave A an M-matrix: heat
  /// stays positive, and no map can blow up. On the plane this changes no result.
  /// false: the Laplacian as published; vertices whose heat turns negative are masked, others may be wrong, and the
  /// factorization may fail.
  bool clamp_weights = true;
  NonManifold non_manifold = NonManifold::error;
  /// Of a part of a larger mesh, per face: 1 where the larger one turns it over (`face_parts`); neighbours are oriented like
  /// the majority of their component, faces turned so. Empty: as they are.
  std::vector<std::uint8_t> turned = {};
  unsigned threads = 0;  ///< 0: one per core; the result does not depend on it
  Progress progress;
};

/// Measured on meshes of 10,000 to 1,000,000 vertices; per vertex of the graph, virtual ones included.
inline constexpr BuildCost build_cost{.bytes = 900, .seconds = 6.5e-6};

/// What was found and done on the way.
struct PolygonDetails {
  TopologyReport topology;
  bool refined = false;          ///< the discretization chosen
  Index vertices = 0;            ///< of the mesh; the graph has `virtual_vertices` more
  Index largest_face = 0;        ///< corners
  std::vector<Index> collinear;  ///< faces without area, their corners on one line
  std::vector<Index> twisted;    ///< faces that refine badly; looked for unless polygons were asked for
  double seconds_checks = 0;     ///< topology (when built from arrays); refined: of the triangles
  double seconds_delaunay = 0;   ///< refined: layouts and flips
  double seconds_graph = 0;      ///< frames, weights, logs, transports
  /// Polygons only.
  Offset edges = 0;             ///< pairs of corners, over all faces
  Index triangles = 0;          ///< faces of three corners
  Index nonplanar_faces = 0;    ///< vector area below 0.99 of the area of the triangles about the virtual vertex
  Index degenerate_faces = 0;   ///< almost no area (below 1e-10 of the squared perimeter)
  Offset negative_weights = 0;  ///< edges; set to 0 with `clamp_weights`
  bool clamped = true;          ///< `clamp_weights`
  Offset capped_weights = 0;    ///< weights above 1e4 set to 1e4
  double shortest_edge = 0;     ///< side of a face, world units
  double longest_edge = 0;
  /// Refined only.
  Index virtual_vertices = 0;
  Offset flips = 0;
  Index merged_vertices = 0;  ///< as of `trimesh::MeshDetails`
  double mollification = 0;   ///< length added to every edge, world units
};

/// A polygon mesh as a surface. Rows are the vertices given; sources in faces have their u axis along the first side as
/// given, v is u turned by 90 degrees in the sense of the (consistent) orientation.
///
/// Its report: discretization ("polygons" or "refined"), vertices, faces, largest_face, the figures of its topology; refined:
/// virtual_vertices, flips, merged_vertices, mollification, seconds.checks, seconds.delaunay, seconds.graph; polygons: nonplanar_faces,
/// degenerate_faces, negative_weights, seconds.graph.
/// Its warnings: those of the topology; collinear_faces (count, the first); polygons: negative_weights (count, where they
/// stay), edge_lengths (shortest, longest), twisted_faces (count, the first: why they were not refined); refined: those of
/// `trimesh::TriangleMeshSurface` that are not about topology.
class PolygonMeshSurface final : public Surface {
 public:
  /// @throws InvalidGeometry (see `PolygonMesh`; all vertices at one place; fault "twisted_faces" where they were to be
  /// refined), ResourceExhausted, Cancelled
  static PolygonMeshSurface build(std::span<const Vec3> positions, std::span<const Offset> face_begin,
                                  std::span<const Index> face_vertices, const PolygonOptions& options = {});
  /// Of a checked mesh; `options.non_manifold` is not used.
  static PolygonMeshSurface build(PolygonMesh mesh, const PolygonOptions& options = {});

  ~PolygonMeshSurface() override;
  PolygonMeshSurface(PolygonMeshSurface&&) noexcept;
  PolygonMeshSurface& operator=(PolygonMeshSurface&&) noexcept;

  const CsrGraph& graph() const& override;
  void graph() && = delete;
  const RowMap& rows() const override;
  std::span<const Vec3> positions() const override;
  FaceList faces() const override;
  std::span<const Index> corner_vertices() const override;
  Report report() const override;
  std::vector<Warning> warnings() const override;
  /// Those of the refinement. @throws InvalidArgument (faults "polygons_not_refined", "no_flat_triangles": twisted faces),
  /// InvalidGeometry (fault "collinear_faces")
  FlatTriangles flat_triangles() const override;
  const PolygonDetails& details() const noexcept;
  const PolygonMesh& mesh() const noexcept;

  /// As of triangles (`trimesh::TriangleMeshSurface::to_corners`): polygons that the map tears are laid out beside others, each
  /// as it lies in the plane perpendicular to its vector area. Cuts run along sides of polygons.
  std::vector<Vec2> to_corners(const LogMap& map) const override;

 protected:
  SurfaceSource source_in_face(const FacePoint& point, const std::optional<Vec3>& u_axis) const override;
  Sample sample_in_face(const LogMap& map, const FacePoint& point) const override;
  exact::MeshPoint flat_point_in_face(const FacePoint& point) const override;

 private:
  struct Impl;
  explicit PolygonMeshSurface(std::unique_ptr<const Impl> impl);
  static PolygonMeshSurface build(PolygonMesh mesh, const PolygonOptions& options, double seconds_checks);
  std::unique_ptr<const Impl> impl_;
};

}  // namespace ahm::polymesh
