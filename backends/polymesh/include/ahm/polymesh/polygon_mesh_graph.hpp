/// \file
/// From a polygon mesh to a tangent graph, without triangulating it: the Laplacian and mass of [BHKB20], every
/// pair of corners of a polygon an edge.
///
/// \code
/// auto surface = ahm::polymesh::PolygonMeshGraph::build(positions, face_begin, face_vertices);
/// ahm::LogMapSolver solver(surface.graph());
/// ahm::LogMap map = solver.solve(surface.source_at_face(7));              // from the middle of face 7
/// ahm::polymesh::VertexMap result = surface.on_vertices(map);             // one row per input vertex
/// \endcode
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/polymesh/polygon_mesh.hpp"
#include "ahm/progress.hpp"

namespace ahm::polymesh {

struct PolygonOptions {
  /// Keep weights in [0, 1e4]. Stretched and concave polygons have negative ones; as 0 they leave A an M-matrix: heat
  /// stays positive, and no map can blow up. On the plane this changes no result.
  /// false: the Laplacian as published; vertices whose heat turns negative are masked, others may be wrong, and the
  /// factorization may fail.
  bool clamp_weights = true;
  NonManifold non_manifold = NonManifold::error;
  unsigned threads = 0;  ///< 0: one per core; the result does not depend on it
  Progress progress;
};

/// What was found and done on the way.
struct PolygonReport {
  TopologyReport topology;
  Index vertices = 0;           ///< vertices of the graph
  Offset edges = 0;             ///< pairs of corners, over all faces
  Index triangles = 0;          ///< faces of three corners
  Index largest_face = 0;       ///< corners
  Index nonplanar_faces = 0;    ///< vector area below 0.99 of the area of the triangles about the virtual vertex
  Index degenerate_faces = 0;   ///< almost no area (below 1e-10 of the squared perimeter)
  Offset negative_weights = 0;  ///< edges; set to 0 with `clamp_weights`
  Offset capped_weights = 0;    ///< weights above 1e4 set to 1e4
  double shortest_edge = 0;     ///< side of a face, world units
  double longest_edge = 0;
  double seconds_checks = 0;  ///< topology (when built from arrays)
  double seconds_graph = 0;   ///< frames, weights, logs, transports
  std::vector<std::string> warnings;
};

/// A log map on the input vertices.
struct VertexMap {
  std::vector<double> u, v;      ///< NaN where the status is not ok
  std::vector<double> distance;  ///< |(u, v)|
  std::vector<double> angle;     ///< atan2(v, u), in (-pi, pi]
  std::vector<Status> status;
};

/// The tangent graph of a polygon mesh and its relation to the input mesh.
///
/// Tangent planes stand perpendicular to the sum of the vector areas of the faces at a vertex. Logs are chords projected
/// to them and brought to the chord's length; transport goes through the plane of the polygon (perpendicular to its
/// vector area) by the smallest rotations. Everything is exact on planar meshes, whatever their polygons.
class PolygonMeshGraph {
 public:
  /// Time and memory linear in the number of pairs of corners, the sum of m^2 over faces of m corners.
  /// @throws InvalidGeometry (see `PolygonMesh`; all vertices at one place), ResourceExhausted, Cancelled
  static PolygonMeshGraph build(std::span<const Vec3> positions, std::span<const Offset> face_begin,
                                std::span<const Index> face_vertices, const PolygonOptions& options = {});
  /// The graph of a checked mesh; `options.non_manifold` is not used.
  static PolygonMeshGraph build(PolygonMesh mesh, const PolygonOptions& options = {});

  ~PolygonMeshGraph();
  PolygonMeshGraph(PolygonMeshGraph&&) noexcept;
  PolygonMeshGraph& operator=(PolygonMeshGraph&&) noexcept;

  /// Stays where it is when this object is moved.
  const CsrGraph& graph() const& noexcept;
  void graph() && = delete;
  const PolygonReport& report() const noexcept;
  const PolygonMesh& mesh() const noexcept;

  /// Vertex of the graph for an input vertex (its first copy where it was split).
  /// @throws InvalidArgument when the index is out of range or no face uses the vertex
  Vertex vertex(Index input_vertex) const;

  /// The source at an input vertex; u and v are the axes of `graph().frame(vertex(input_vertex))`.
  Source source_at_vertex(Index input_vertex) const;
  /// The same with the u axis along a vector of space projected to the tangent plane.
  /// @throws InvalidArgument also when the projection vanishes
  Source source_at_vertex(Index input_vertex, const Vec3& u_direction) const;

  /// The source at the point sum b_c x_c of a face; u points along its first side as given, v is u turned by 90 degrees
  /// in the sense of the (consistent) orientation, in the plane of the face.
  /// @param weights  b_c per corner, in the order given: >= 0, sum 1 (to 1e-9; made exact)
  /// @throws InvalidArgument when the face is out of range or the weights are bad
  Source source_at_face(Index face, std::span<const double> weights) const;
  /// The same with the u axis along a vector of space projected to the face.
  /// @throws InvalidArgument also when the projection vanishes
  Source source_at_face(Index face, std::span<const double> weights, const Vec3& u_direction) const;
  /// From the mean of the corners.
  Source source_at_face(Index face) const;
  /// Position and axes of `source_at_face(face, weights)` in space.
  Frame frame_at_face(Index face, std::span<const double> weights) const;

  /// A result per graph vertex as a result per input vertex: `Status::removed` where no face uses it; where a vertex
  /// was split, the copy nearest to the source counts.
  VertexMap on_vertices(const LogMap& map) const;

 private:
  struct Impl;
  explicit PolygonMeshGraph(std::unique_ptr<const Impl> impl);
  static PolygonMeshGraph build(PolygonMesh mesh, const PolygonOptions& options, double seconds_checks);
  std::unique_ptr<const Impl> impl_;
};

}  // namespace ahm::polymesh
