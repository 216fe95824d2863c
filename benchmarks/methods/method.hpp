/// \file
/// The methods the affine heat method is compared with, behind one interface.
///
/// \code
/// const auto vhm = ahm::methods::vector_heat_log(graph);  // factors
/// const ahm::methods::Result result = vhm->solve(42);     // maps
/// std::cout << vhm->name() << ": " << result.distance[7] << '\n';
/// \endcode
///
/// Vertices are those of the graph (of the mesh for the methods that need faces). A graph or mesh must outlive the
/// method. README.md says what is each paper's and what is ours.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/trimesh/triangle_mesh.hpp"

namespace ahm::methods {

/// What a method says about every vertex; NaN where it says nothing (no path or heat from the source).
struct Result {
  std::vector<double> coordinates;  ///< n x d, world units, in the frame of the source; empty for distances alone
  std::vector<double> distance;     ///< n, world units
};

/// A method made ready for one graph or mesh: its constructor holds all that can be computed before the source is known.
/// `solve` is for one thread at a time.
class Baseline {
 public:
  virtual ~Baseline() = default;
  /// The name used in the paper's figures.
  virtual std::string_view name() const noexcept = 0;
  /// @throws InvalidArgument when the source is out of range
  virtual Result solve(Index source) const = 0;
};

using Method = std::unique_ptr<const Baseline>;

// Log maps, on any graph.

/// The affine heat method itself, for comparison.
/// @throws as `LogMapSolver`
Method affine_heat(const TangentGraph& graph, Variant variant, double t_coef = 1.0);

/// The front that unfolds distances across triangles (`Wavefront`): `LogMap::distance` of meshes. Distances alone.
Method unfolded_distance(const TangentGraph& graph);

/// The affine heat method as written: its (d + 1) n x (d + 1) n operator assembled and factored by LU for every source
/// ([SS25] Alg. 1 and 2).
Method reference_operator(const TangentGraph& graph, Variant variant, double t_coef = 1.0);

struct VectorHeatOptions {
  double t_coef = 1.0;
  /// The published form takes the radial field at the source itself as zero, so that every distance is about half an
  /// edge short. true: the edges at the source take the field at their other end.
  bool radial_at_source = false;
};
/// VHM_log, the log map of the vector heat method [SSC19].
/// @throws as `HeatOperators`; NotPositiveDefinite (weights)
Method vector_heat_log(const TangentGraph& graph, const VectorHeatOptions& options = {});

/// How DEM brings the frame of a vertex to that of the source.
enum class FrameTurn {
  along_path,  ///< by the graph's transports along the shortest path of edges: any graph
  in_space,  ///< by the least rotation that takes one normal to the other, as published: d = 2, needs `TangentGraph::frame`
};

struct DiscreteExponentialOptions {
  FrameTurn turn = FrameTurn::along_path;
  /// Average what all neighbours nearer to the source predict, weighted by inverse edge length [Sch13], instead
  /// of following the shortest path of edges alone.
  bool upwind_average = false;
};
/// DEM, discrete exponential map [SGW06].
/// @throws InvalidArgument (a turn in space on a graph that is no surface with known frames)
Method discrete_exponential(const TangentGraph& graph, const DiscreteExponentialOptions& options = {});

/// SEM, smoothed exponential map [HA19].
/// @param t_coef  of heat for direction and distance; the smoothing. 50 as in the authors' program
/// @throws as `heat_distance`
Method smoothed_exponential(const TangentGraph& graph, double t_coef = 50.0);

// Distances.

/// HM, the heat method [CWW13] on a graph: gradient by a fit to the star, divergence over edges.
/// @throws as `HeatOperators`; NotPositiveDefinite (weights)
Method heat_distance(const TangentGraph& graph, double t_coef = 1.0);

/// HM on the faces of a mesh, as published: one gradient per face. The vertices are those of the mesh.
/// @throws InvalidArgument (t_coef), InvalidGeometry (a face without area)
Method heat_distance(const trimesh::TriangleMesh& mesh, double t_coef = 1.0);

#ifdef AHM_METHODS_CGAL
/// Exact distance on the polyhedron ([XW09], by CGAL). Vertices and positions as given.
/// @throws InvalidGeometry when the faces are no oriented manifold
Method exact_distance(std::span<const Vec3> positions, std::span<const Triangle> faces);
#endif

}  // namespace ahm::methods
