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
  /// Flip edges until all are Delaunay: weights >= 0, and much better accuracy with bad triangles. Results still refer to the
  /// input mesh.
  bool intrinsic_delaunay = true;
  /// Limit cotangent weights to [0, 1e4]. Negative weights become 0: those of boundary edges opposite an obtuse angle and,
  /// without flips, of all edges that are not Delaunay. A is then an M-matrix: heat stays positive, and no map can blow up.
  /// Huge weights, those of the short edges of needles, would cost the solver digits. On the plane the limits change no result.
  /// `false` uses plain cotangents. Vertices with negative heat are then masked, other vertices may be wrong, and the
  /// factorization may fail.
  bool clamp_weights = true;
  NonManifold non_manifold = NonManifold::error;
  /// For a part of a larger mesh, per face: 1 if the larger mesh turns it over (`face_parts`). The majority orientation of a
  /// component is then computed as if these faces were reversed. Empty: no face.
  std::vector<std::uint8_t> counts_as_reversed = {};
  unsigned threads = 0;  ///< 0: one per core. No result depends on it
  Progress progress;
};

/// Measured on meshes of 10,000 to 1,000,000 vertices.
inline constexpr BuildCost build_cost{.bytes = 1000, .seconds = 5.5e-6};

/// Statistics of the construction.
struct MeshDetails {
  TopologyReport topology;
  Index vertices = 0;  ///< vertices of the graph
  Offset edges = 0;    ///< edges of the triangulation from which the graph was built
  Offset flips = 0;
  Offset history_bytes = 0;   ///< memory of the flip history
  Index merged_vertices = 0;  ///< input vertices merged into another one by contracting edges without length
  Index dropped_faces = 0;    ///< input faces with an edge without length
  /// Length added to every edge, world units, because flips of faces without area made an edge without length; 0: not necessary.
  double mollification = 0;
  Index degenerate_faces = 0;    ///< input faces with almost no area (height below 1e-10 of the longest side)
  std::vector<Index> collinear;  ///< degenerate faces that were not dropped: their corners lie on one line
  Offset closed_edges = 0;       ///< intrinsic edges from a vertex to itself, left out
  Offset clamped_weights = 0;    ///< negative weights set to 0
  Offset capped_weights = 0;     ///< weights above 1e4 set to 1e4
  double shortest_edge = 0;      ///< shortest input edge with a length, world units
  double longest_edge = 0;       ///< longest input edge, world units
  double finest = 0;             ///< smallest longest edge at a vertex, world units; needles do not affect it
  bool flips_stopped = false;    ///< flips stopped before all edges were Delaunay
  double seconds_checks = 0;     ///< time for the topology (if built from arrays)
  double seconds_delaunay = 0;   ///< time for layouts and flips
  double seconds_graph = 0;      ///< time for frames, weights, logarithms and transports
};

/// A triangle mesh as a surface. Rows are the input vertices. Sources in faces have their u axis along the side from corner 0
/// to corner 1 of the input face; v is u rotated by 90 degrees in the sense of the consistent orientation. At a row, u points
/// by default along the boundary edge that leaves the vertex with the surface on its left, or along a fixed edge of an interior
/// vertex.
///
/// Coincident vertices joined by an edge become one vertex of the graph, which all their rows share (`TriangleMesh`).
///
/// Entries of the report: vertices, faces, edges, flips, merged_vertices, dropped_faces, mollification, degenerate_faces, the
/// figures of its topology, seconds.checks, seconds.delaunay, seconds.graph.
///
/// Warnings: flips_stopped; those of the topology; merged (vertices merged, faces dropped); collinear_faces (count, the first);
/// mollified (degenerate faces, length added to every edge); edge_lengths (`finest`, longest; their ratio is too large for one
/// diffusion time).
class TriangleMeshSurface final : public Surface {
 public:
  /// Builds the graph of a mesh in space. Time and memory are almost linear in the number of faces.
  /// @throws InvalidGeometry (see `TriangleMesh`; a triangulation that stays degenerate), ResourceExhausted, Cancelled
  static TriangleMeshSurface build(std::span<const Vec3> positions, std::span<const Triangle> faces,
                                   const MeshOptions& options = {});
  /// Builds the graph of a checked mesh, which may be defined only by its edge lengths. Ignores `options.non_manifold`.
  static TriangleMeshSurface build(TriangleMesh mesh, const MeshOptions& options = {});

  ~TriangleMeshSurface() override;
  TriangleMeshSurface(TriangleMeshSurface&&) noexcept;
  TriangleMeshSurface& operator=(TriangleMeshSurface&&) noexcept;

  const CsrGraph& graph() const& override;
  void graph() const&& = delete;
  const RowMap& rows() const override;
  std::span<const Vec3> positions() const override;
  FaceList faces() const override;
  std::span<const Index> corner_vertices() const override;
  Report report() const override;
  std::vector<Warning> warnings() const override;
  /// The input mesh without dropped faces, neither flipped nor mollified.
  FlatTriangles flat_triangles() const override;
  const MeshDetails& details() const noexcept;
  const TriangleMesh& mesh() const noexcept;

  /// Each face gets the values at its vertices, unless the map tears it, as at the cut locus. A face is torn if the map turns
  /// it over, or stretches a side more than twice as much as the faces between it and the source. Torn faces are unfolded
  /// almost isometrically from the nearest face, counted in faces, that is not torn. A texture is therefore cut open along the
  /// cut locus, in the middle of the few edges over which a map blends both sides, and stretched wherever a smooth map is.
  std::vector<Vec2> to_corners(const LogMap& map) const override;

  /// Position of a point of a face in the intrinsic triangulation.
  struct IntrinsicPoint {
    Triangle vertices;                  ///< corners of the intrinsic face
    std::array<double, 3> barycentric;  ///< weights of these vertices
    Index depth;                        ///< number of flips on the descent to it
  };
  /// Finds a point of a face in the intrinsic triangulation.
  /// @throws InvalidArgument (as `source`)
  IntrinsicPoint locate(const FacePoint& point) const;

 protected:
  SurfaceSource source_in_face(const FacePoint& point, const std::optional<Vec3>& u_axis) const override;
  SurfaceSource source_on_edge(const EdgePoint& point, const std::optional<Vec3>& u_axis) const override;
  /// Linear in the face of the intrinsic triangulation that contains the point. If the map turns that face over, or changes a
  /// side by more than a factor of 1.5, the face is laid out along a side that the map keeps; `Status::unreached` if there is
  /// none. At the cut locus interpolate `to_corners` instead.
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
