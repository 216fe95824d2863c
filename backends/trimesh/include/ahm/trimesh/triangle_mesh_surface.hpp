/// \file
/// A triangle mesh as a surface: intrinsic Delaunay triangulation, vertex tangent spaces, cotangent weights.
///
/// \code
/// auto surface = ahm::trimesh::TriangleMeshSurface::build(positions, faces);
/// ahm::LogMapSolver solver(surface.graph());
/// ahm::LogMap map = solver.solve(surface.source(ahm::FacePoint{7, {0.2, 0.3, 0.5}}).source);
/// ahm::RowLogMap result = surface.to_rows(map);                              // one row per input vertex
/// \endcode
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/progress.hpp"
#include "ahm/surface/surface.hpp"
#include "ahm/trimesh/triangle_mesh.hpp"

namespace ahm::trimesh {

struct MeshOptions {
  /// Flip edges until all are Delaunay: weights >= 0, and far better accuracy on bad triangles. The result still refers
  /// to the input mesh.
  bool intrinsic_delaunay = true;
  /// Keep cotangent weights in [0, 1e4]. Negative ones (of boundary edges opposite an obtuse angle and, without flips,
  /// of all edges that are not Delaunay) become 0: A is an M-matrix then, heat stays positive and no map can blow up.
  /// Huge ones (of the short edges of needles) would cost the solver digits. On the plane neither changes a result.
  /// false: plain cotangents; vertices whose heat turns negative are masked, others may be wrong, and the factorization
  /// may fail.
  bool clamp_weights = true;
  NonManifold non_manifold = NonManifold::error;
  /// Of a part of a larger mesh, per face: 1 where the larger one turns it over (`face_parts`); neighbours are oriented like
  /// the majority of their component, faces turned so. Empty: as they are.
  std::vector<std::uint8_t> turned = {};
  unsigned threads = 0;  ///< 0: one per core; the result does not depend on it
  Progress progress;
};

/// Measured on meshes of 10,000 to 1,000,000 vertices.
inline constexpr BuildCost build_cost{.bytes = 1000, .seconds = 5.5e-6};

/// What was found and done on the way.
struct MeshDetails {
  TopologyReport topology;
  Index vertices = 0;  ///< vertices of the graph
  Offset edges = 0;    ///< of the triangulation the graph was built from
  Offset flips = 0;
  Offset history_bytes = 0;   ///< memory of the record of flips
  Index merged_vertices = 0;  ///< input vertices that share the vertex of another one, an edge without length away
  Index dropped_faces = 0;    ///< input faces with such an edge
  /// Length added to every edge, world units, because flips of faces without area made an edge without length; 0: none did.
  double mollification = 0;
  Index degenerate_faces = 0;    ///< input faces of almost no area (height below 1e-10 of the longest side)
  std::vector<Index> collinear;  ///< those of them that were not dropped: their corners lie on one line
  Offset closed_edges = 0;       ///< intrinsic edges from a vertex to itself; left out
  Offset clamped_weights = 0;    ///< negative weights set to 0
  Offset capped_weights = 0;     ///< weights above 1e4 set to 1e4
  double shortest_edge = 0;      ///< of the input without those of no length, world units
  double longest_edge = 0;
  double finest = 0;            ///< least of the longest edges at the vertices: needles do not count
  bool flips_stopped = false;   ///< before all edges were Delaunay
  double seconds_checks = 0;    ///< topology (when built from arrays)
  double seconds_delaunay = 0;  ///< layouts and flips
  double seconds_graph = 0;     ///< frames, weights, logs, transports
};

/// A triangle mesh as a surface. Rows are the vertices given; sources in faces have their u axis along the side from
/// corner 0 to corner 1 as given, v is u turned by 90 degrees in the sense of the (consistent) orientation. At a row
/// without an axis, u points along the boundary edge that leaves the vertex with the surface on its left, or along one
/// fixed edge of an interior vertex.
///
/// Coincident vertices joined by an edge are one vertex of the graph, which all their rows share (`TriangleMesh`).
///
/// Its report: vertices, faces, edges, flips, merged_vertices, dropped_faces, mollification, degenerate_faces, the figures of
/// its topology, seconds.checks, seconds.delaunay, seconds.graph. Its warnings: flips_stopped; those of the topology; merged
/// (number of vertices, of faces dropped with them); collinear_faces (count, the first); mollified (number of degenerate faces, length added to every edge);
/// edge_lengths (`finest`, longest: too far apart for one diffusion time).
class TriangleMeshSurface final : public Surface {
 public:
  /// A mesh in space. Time and memory near linear in the number of faces.
  /// @throws InvalidGeometry (see `TriangleMesh`; a triangulation that stays degenerate), ResourceExhausted, Cancelled
  static TriangleMeshSurface build(std::span<const Vec3> positions, std::span<const Triangle> faces,
                                   const MeshOptions& options = {});
  /// A checked mesh, which may be given by its edge lengths alone; `options.non_manifold` is not used.
  static TriangleMeshSurface build(TriangleMesh mesh, const MeshOptions& options = {});

  ~TriangleMeshSurface() override;
  TriangleMeshSurface(TriangleMeshSurface&&) noexcept;
  TriangleMeshSurface& operator=(TriangleMeshSurface&&) noexcept;

  const CsrGraph& graph() const& override;
  void graph() && = delete;
  const RowMap& rows() const override;
  std::span<const Vec3> positions() const override;
  FaceList faces() const override;
  std::span<const Index> corner_vertices() const override;
  Report report() const override;
  std::vector<Warning> warnings() const override;
  /// The mesh as given, without the faces that were dropped: neither flipped nor mollified.
  FlatTriangles flat_triangles() const override;
  const MeshDetails& details() const noexcept;
  const TriangleMesh& mesh() const noexcept;

  /// A face takes the values at its vertices, unless the map tears it, as across the cut locus (blended over a few edges):
  /// turns it over, or stretches one of its sides more than twice as much as on the way there from the source.
  /// Torn faces are unfolded from the nearest face, counted in faces, that is not: nearly isometric in themselves. So a texture
  /// is cut open in the middle of the band, along the cut locus, and stretched wherever a smooth map is.
  std::vector<Vec2> to_corners(const LogMap& map) const override;

  /// Where a point of a face lies in the intrinsic triangulation.
  struct Located {
    Triangle vertices;                  ///< of the intrinsic face
    std::array<double, 3> barycentric;  ///< weights of these vertices
    Index depth;                        ///< flips met on the way
  };
  /// @throws InvalidArgument as `source`
  Located locate(const FacePoint& point) const;

 protected:
  SurfaceSource source_in_face(const FacePoint& point, const std::optional<Vec3>& u_axis) const override;
  SurfaceSource source_on_edge(const EdgePoint& point, const std::optional<Vec3>& u_axis) const override;
  /// Linear in the face of the intrinsic triangulation that holds the point. Where the map turns that face over, or a side not
  /// within a factor of 1.5, it is laid out along a side that is kept; `Status::unreached` where there is none: at the cut locus
  /// interpolate `to_corners` instead.
  Sample sample_in_face(const LogMap& map, const FacePoint& point) const override;
  exact::MeshPoint flat_point_in_face(const FacePoint& point) const override;
  Reason missing_vertex_reason(Row row) const override;
  FacePoint face_point(const EdgePoint& point) const override;

 private:
  struct Impl;
  explicit TriangleMeshSurface(std::unique_ptr<const Impl> impl);
  static TriangleMeshSurface build(TriangleMesh mesh, const MeshOptions& options, double seconds_checks);
  std::unique_ptr<const Impl> impl_;
};

}  // namespace ahm::trimesh
