/// \file
/// A polygon mesh as a surface, in one of two discretizations. Either the polygons as they are, with the Laplacian and mass of
/// [BHKB20] and an edge for every pair of corners of a polygon. Or refined by virtual vertices, as a triangle mesh.
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
  /// Polygons as they are. The tangent plane at a vertex is perpendicular to the sum of the vector areas of its faces.
  /// Logarithms are chords projected to this plane and scaled to the length of the chord. Transport uses the smallest rotations
  /// through the plane of the polygon (perpendicular to its vector area). Exact on planar meshes with any polygons. Time and
  /// memory are linear in the number of pairs of corners, the sum of m^2 over faces of m corners.
  polygons,
  refined,  ///< `PolygonMesh::refined` as a triangle mesh: more accurate; its first vertices are those of the mesh
};

struct PolygonOptions {
  Discretization discretization = Discretization::automatic;
  /// Refined: flip edges of the triangles until all are Delaunay.
  bool intrinsic_delaunay = true;
  /// Limit weights to [0, 1e4]. Stretched and concave polygons have negative weights. With 0 instead, A is an M-matrix: heat
  /// stays positive, and no map can blow up. On the plane this changes no result. `false` uses the Laplacian as published.
  /// Vertices with negative heat are then masked, other vertices may be wrong, and the factorization may fail.
  bool clamp_weights = true;
  NonManifold non_manifold = NonManifold::error;
  /// For a part of a larger mesh, per face: 1 if the larger mesh turns it over (`face_parts`). The majority orientation of a
  /// component is then computed as if these faces were reversed. Empty: no face.
  std::vector<std::uint8_t> counts_as_reversed = {};
  unsigned threads = 0;  ///< 0: one per core. No result depends on it
  Progress progress;
};

/// Measured on meshes of 10,000 to 1,000,000 vertices; per vertex of the graph, including virtual vertices.
inline constexpr BuildCost build_cost{.bytes = 900, .seconds = 6.5e-6};

/// Statistics of the construction.
struct PolygonDetails {
  TopologyReport topology;
  bool refined = false;          ///< whether `Discretization::refined` was used
  Index vertices = 0;            ///< vertices of the mesh; the graph has `virtual_vertices` more
  Index largest_face = 0;        ///< largest number of corners of a face
  std::vector<Index> collinear;  ///< faces without area; their corners lie on one line
  std::vector<Index> twisted;    ///< faces that refine badly; not searched for with `Discretization::polygons`
  double seconds_checks = 0;     ///< time for the topology (if built from arrays); refined: for that of the triangles
  double seconds_delaunay = 0;   ///< refined: time for layouts and flips
  double seconds_graph = 0;      ///< time for frames, weights, logarithms and transports
  // Polygons only:
  Offset edges = 0;             ///< pairs of corners over all faces
  Index triangles = 0;          ///< faces of three corners
  Index nonplanar_faces = 0;    ///< faces with a vector area below 0.99 of the area of their triangles
  Index degenerate_faces = 0;   ///< faces with almost no area (below 1e-10 of the squared perimeter)
  Offset negative_weights = 0;  ///< edges with negative weights; set to 0 with `clamp_weights`
  bool clamped = true;          ///< value of `clamp_weights`
  Offset capped_weights = 0;    ///< weights above 1e4 set to 1e4
  double shortest_edge = 0;     ///< shortest side of a face, world units
  double longest_edge = 0;      ///< longest side of a face, world units
  // Refined only:
  Index virtual_vertices = 0;
  Offset flips = 0;
  Index merged_vertices = 0;  ///< as `trimesh::MeshDetails::merged_vertices`
  double mollification = 0;   ///< length added to every edge, world units
};

/// A polygon mesh as a surface. Rows are the input vertices. Sources in faces have their u axis along the first side of the
/// input face; v is u rotated by 90 degrees in the sense of the consistent orientation.
///
/// Entries of the report: discretization ("polygons" or "refined"), vertices, faces, largest_face, the figures of its topology.
/// Refined: virtual_vertices, flips, merged_vertices, mollification, seconds.checks, seconds.delaunay, seconds.graph. Polygons:
/// nonplanar_faces, degenerate_faces, negative_weights, seconds.graph.
///
/// Warnings: those of the topology; collinear_faces (count, the first). Polygons: negative_weights (count, if they are not
/// clamped), edge_lengths (shortest, longest), twisted_faces (count, the first; the reason why faces were not refined).
/// Refined: those of `trimesh::TriangleMeshSurface` that do not concern the topology.
class PolygonMeshSurface final : public Surface {
 public:
  /// Builds the graph of a mesh in space.
  /// @throws InvalidGeometry (see `PolygonMesh`; all vertices at one place; fault "twisted_faces" with
  /// `Discretization::refined`), ResourceExhausted, Cancelled
  static PolygonMeshSurface build(std::span<const Vec3> positions, std::span<const Offset> face_begin,
                                  std::span<const Index> face_vertices, const PolygonOptions& options = {});
  /// Builds the graph of a checked mesh. Ignores `options.non_manifold`.
  static PolygonMeshSurface build(PolygonMesh mesh, const PolygonOptions& options = {});

  ~PolygonMeshSurface() override;
  PolygonMeshSurface(PolygonMeshSurface&&) noexcept;
  PolygonMeshSurface& operator=(PolygonMeshSurface&&) noexcept;

  const CsrGraph& graph() const& override;
  void graph() const&& = delete;
  const RowMap& rows() const override;
  std::span<const Vec3> positions() const override;
  FaceList faces() const override;
  std::span<const Index> corner_vertices() const override;
  Report report() const override;
  std::vector<Warning> warnings() const override;
  /// The triangles of the refinement.
  /// @throws InvalidArgument (faults "polygons_not_refined", "no_flat_triangles": twisted faces), InvalidGeometry (fault
  /// "collinear_faces")
  FlatTriangles flat_triangles() const override;
  const PolygonDetails& details() const noexcept;
  const PolygonMesh& mesh() const noexcept;

  /// As `trimesh::TriangleMeshSurface::to_corners`. Polygons that the map tears are laid out next to others, each with its
  /// shape in the plane perpendicular to its vector area. Cuts run along sides of polygons.
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
