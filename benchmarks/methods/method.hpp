/// \file
/// A common interface of the affine heat method and the methods it is compared with.
///
/// \code
/// const auto vhm = ahm::methods::vector_heat_log(graph);  // factors
/// const ahm::methods::Result result = vhm->solve(42);     // the map from vertex 42
/// std::cout << vhm->name() << ": " << result.distance[7] << '\n';
/// \endcode
///
/// Vertices are those of the graph, or of the mesh for methods that need faces. A graph or mesh must outlive the method.
/// README.md lists what is from the papers and what is ours.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/trimesh/triangle_mesh.hpp"

namespace ahm::methods {

/// The result of a method for every vertex; NaN where there is none (no path or no heat from the source).
struct Result {
  std::vector<double> coordinates;  ///< n x d, world units, in the frame of the source; empty if only distances are
                                    ///< computed
  std::vector<double> distance;     ///< n, world units
};

/// A method prepared for one graph or mesh. Its constructor computes all that does not depend on the source. `solve` may be
/// used by one thread at a time.
class Baseline {
 public:
  virtual ~Baseline() = default;
  /// The name used in the paper's figures.
  virtual std::string_view name() const noexcept = 0;
  /// @throws InvalidArgument (a source out of range)
  virtual Result solve(Index source) const = 0;
};

using Method = std::unique_ptr<const Baseline>;

// Log maps on any graph.

/// The affine heat method itself, for comparison.
/// @throws as `LogMapSolver`
Method affine_heat(const TangentGraph& graph, Variant variant, double t_coef = 1.0);

/// The front that unfolds distances across triangles (`Wavefront`), which computes `LogMap::distance` on meshes. Distances
/// only.
Method unfolded_distance(const TangentGraph& graph);

/// The affine heat method as published: its (d + 1) n x (d + 1) n operator is assembled and factored by LU for every source
/// ([SS25] Alg. 1 and 2).
Method reference_operator(const TangentGraph& graph, Variant variant, double t_coef = 1.0);

struct VectorHeatOptions {
  double t_coef = 1.0;
  /// The published form sets the radial field at the source to zero, so every distance is about half an edge too short.
  /// true: the edges at the source use the field at their other end.
  bool radial_at_source = false;
};
/// VHM_log, the log map of the vector heat method [SSC19].
/// @throws as `HeatOperators`; NotPositiveDefinite (weights)
Method vector_heat_log(const TangentGraph& graph, const VectorHeatOptions& options = {});

/// How DEM turns the frame of a vertex to that of the source.
enum class FrameTurn {
  along_path,  ///< by the graph's transports along the shortest edge path; for any graph
  in_space,    ///< by the smallest rotation from one normal to the other, as published; needs d = 2 and
               ///< `TangentGraph::frame`
};

struct DiscreteExponentialOptions {
  FrameTurn turn = FrameTurn::along_path;
  /// Average the predictions of all neighbors nearer to the source, weighted by inverse edge length [Sch13]. false: follow
  /// the shortest edge path only.
  bool upwind_average = false;
};
/// DEM, discrete exponential map [SGW06].
/// @throws InvalidArgument (a turn in space on a graph that is not a surface with frames)
Method discrete_exponential(const TangentGraph& graph, const DiscreteExponentialOptions& options = {});

/// SEM, smoothed exponential map [HA19].
/// @param t_coef  diffusion time for direction and distance: the amount of smoothing. 50 as in the authors' program
/// @throws as `heat_distance`
Method smoothed_exponential(const TangentGraph& graph, double t_coef = 50.0);

// Distances.

/// HM, the heat method [CWW13] on a graph: the gradient by a fit to the star, the divergence over edges.
/// @throws as `HeatOperators`; NotPositiveDefinite (weights)
Method heat_distance(const TangentGraph& graph, double t_coef = 1.0);

/// HM on the faces of a mesh, as published: one gradient per face. The vertices are those of the mesh.
/// @throws InvalidArgument (t_coef), InvalidGeometry (a face without area)
Method heat_distance(const trimesh::TriangleMesh& mesh, double t_coef = 1.0);

#ifdef AHM_METHODS_CGAL
/// Exact distance on the polyhedron ([XW09], by CGAL). Vertices and positions are those of the arguments.
/// @throws InvalidGeometry (faces that are not an oriented manifold)
Method exact_distance(std::span<const Vec3> positions, std::span<const Triangle> faces);
#endif

}  // namespace ahm::methods
