/// \file
/// From a triangle mesh to a tangent graph: intrinsic Delaunay triangulation, vertex tangent spaces, cotangent weights.
///
/// \code
/// auto surface = ahm::trimesh::TriangleMeshGraph::build(positions, faces);
/// ahm::LogMapSolver solver(surface.graph());
/// ahm::LogMap map = solver.solve(surface.source_at({.face = 7, .barycentric = {0.2, 0.3, 0.5}}));
/// ahm::trimesh::VertexMap result = surface.on_vertices(map);                 // one row per input vertex
/// \endcode
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/progress.hpp"
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
  unsigned threads = 0;  ///< 0: one per core; the result does not depend on it
  Progress progress;
};

/// What was found and done on the way.
struct MeshReport {
  TopologyReport topology;
  Index vertices = 0;  ///< vertices of the graph
  Offset edges = 0;    ///< of the triangulation the graph was built from
  Offset flips = 0;
  Offset history_bytes = 0;  ///< memory of the record of flips
  double mollification =
      0;  ///< length added to every edge because of degenerate faces, world units; 0: none was needed
  Index degenerate_faces = 0;  ///< input faces of almost no area (height below 1e-10 of the longest side)
  Offset closed_edges = 0;     ///< intrinsic edges from a vertex to itself; left out
  Offset clamped_weights = 0;  ///< negative weights set to 0
  Offset capped_weights = 0;   ///< weights above 1e4 set to 1e4
  double shortest_edge = 0;    ///< of the input, world units
  double longest_edge = 0;
  double seconds_checks = 0;    ///< topology (when built from arrays)
  double seconds_delaunay = 0;  ///< layouts and flips
  double seconds_graph = 0;     ///< frames, weights, logs, transports
  std::vector<std::string> warnings;
};

/// A point of the input mesh.
struct SurfacePoint {
  Index face = 0;
  /// Weights of the face's corners in the order given: >= 0, sum 1 (each to 1e-9; made exact).
  std::array<double, 3> barycentric{1, 0, 0};
};

/// A log map on the input vertices.
struct VertexMap {
  std::vector<double> u, v;      ///< NaN where the status is not ok
  std::vector<double> distance;  ///< |(u, v)|
  std::vector<double> angle;     ///< atan2(v, u), in (-pi, pi]
  std::vector<Status> status;
};

/// Coordinates at one point of the surface; NaN where the status is not ok.
struct Sample {
  double u, v;
  Status status;
};

/// The tangent graph of a triangle mesh and its relation to the input mesh.
class TriangleMeshGraph {
 public:
  /// Builds the graph of a mesh in space. Time and memory near linear in the number of faces.
  /// @throws InvalidGeometry (see `TriangleMesh`; a triangulation that stays degenerate), ResourceExhausted, Cancelled
  static TriangleMeshGraph build(std::span<const Vec3> positions, std::span<const Triangle> faces,
                                 const MeshOptions& options = {});
  /// Builds the graph of a checked mesh; `options.non_manifold` is not used.
  static TriangleMeshGraph build(TriangleMesh mesh, const MeshOptions& options = {});

  ~TriangleMeshGraph();
  TriangleMeshGraph(TriangleMeshGraph&&) noexcept;
  TriangleMeshGraph& operator=(TriangleMeshGraph&&) noexcept;

  /// Stays where it is when this object is moved.
  const CsrGraph& graph() const& noexcept;
  void graph() && = delete;
  const MeshReport& report() const noexcept;
  const TriangleMesh& mesh() const noexcept;

  /// Vertex of the graph for an input vertex (its first copy where it was split).
  /// @throws InvalidArgument when the index is out of range or no face uses the vertex
  Vertex vertex(Index input_vertex) const;

  /// Components in the frame of a graph vertex of a vector of space, projected to the tangent plane.
  /// @throws InvalidArgument when the mesh has no positions or the projection vanishes
  std::array<double, 2> direction_in_frame(Vertex vertex, const Vec3& direction) const;

  /// The source at an input vertex; u and v are the tangent axes of `graph().frame(vertex(input_vertex))`. In the
  /// tangent space u points along the boundary edge that leaves the vertex with the surface on its left, or along one
  /// fixed edge of an interior vertex.
  Source source_at_vertex(Index input_vertex) const;
  /// The same with the u axis along a vector of space projected to the tangent plane.
  /// @throws InvalidArgument also when the projection vanishes
  Source source_at_vertex(Index input_vertex, const Vec3& u_direction) const;

  /// The source at a point of a face; u points from the face's corner 0 to its corner 1 as given, v is u turned by 90
  /// degrees in the sense of the (consistent) orientation.
  /// @throws InvalidArgument when the face is out of range or the barycentric coordinates are bad
  Source source_at(const SurfacePoint& point) const;
  /// The same with the u axis along a vector of space projected to the face.
  /// @throws InvalidArgument also when the projection vanishes or the mesh has no positions
  Source source_at(const SurfacePoint& point, const Vec3& u_direction) const;
  /// Position and axes of `source_at(point)` in space; empty when the mesh has no positions.
  std::optional<Frame> frame_at(const SurfacePoint& point) const;

  /// The source on an edge of the input mesh, at (1 - t) from + t to; u points from `from` to `to`.
  /// @throws InvalidArgument when there is no such edge or t is outside [0, 1]
  Source source_at_edge(Index from, Index to, double t) const;

  /// A result per graph vertex as a result per input vertex: `Status::removed` where no face uses it; where a vertex
  /// was split, the copy nearest to the source counts.
  VertexMap on_vertices(const LogMap& map) const;

  /// Texture coordinates per corner of each input face, as given: 3 per face, NaN where the map is not ok.
  ///
  /// A face whose sides the map keeps within a factor of 1.5, and does not turn over, takes the values at its vertices.
  /// Other faces lie at the cut locus, where the map jumps (blended over a few edges): they are unfolded from the
  /// nearest face, counted in faces, that is sound. So every face is nearly isometric in itself, and the texture is cut
  /// open in the middle of the band, along the cut locus.
  std::vector<std::array<double, 2>> on_corners(const LogMap& map) const;

  /// The map at a point of the input mesh, linear in the face of the intrinsic triangulation that holds it. Where the
  /// map tears that face (see `on_corners`), it is laid out along a side that is kept; `Status::unreached` where there
  /// is none: at the cut locus interpolate `on_corners` instead.
  /// @throws InvalidArgument as `source_at`
  Sample at(const LogMap& map, const SurfacePoint& point) const;

  /// Where a point of the input mesh lies in the intrinsic triangulation.
  struct Located {
    Triangle vertices;                  ///< of the intrinsic face
    std::array<double, 3> barycentric;  ///< weights of these vertices
    Index depth;                        ///< flips met on the way
  };
  Located locate(const SurfacePoint& point) const;

 private:
  struct Impl;
  explicit TriangleMeshGraph(std::unique_ptr<const Impl> impl);
  static TriangleMeshGraph build(TriangleMesh mesh, const MeshOptions& options, double seconds_checks);
  std::unique_ptr<const Impl> impl_;
};

}  // namespace ahm::trimesh
