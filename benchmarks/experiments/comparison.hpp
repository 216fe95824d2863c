/// \file
/// Common parts of the experiments: a surface prepared for all methods, the methods, and errors against exact values.
///
/// \code
/// const Surface surface("sphere", split_icosphere(10000));
/// const Index source = surface.size() / 3;
/// for (const NamedMethod& method : log_map_methods()) {
///   const auto result = method.make(surface.graph())->solve(source);
///   const Errors e = errors(result.coordinates, surface.sphere_log(source), [](std::size_t) { return true; });
/// }
/// \endcode
#pragma once

#include <complex>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "ahm/maps/log_map.hpp"
#include "ahm/surface/exact/polyhedral_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "experiments/surfaces.hpp"
#include "methods/method.hpp"

namespace ahm::bench {

/// A mesh and its graph; vertices and faces are those of the graph.
class Surface {
 public:
  /// Nonmanifold edges are cut apart, whatever `options` contains.
  Surface(std::string name, const Mesh& mesh, trimesh::MeshOptions options = {});

  const std::string& name() const noexcept { return name_; }
  const TangentGraph& graph() const noexcept { return surface_.graph(); }
  const trimesh::TriangleMeshSurface& mesh() const noexcept { return surface_; }
  Index size() const noexcept { return surface_.graph().size(); }
  std::span<const Vec3> points() const noexcept { return points_; }
  std::span<const Triangle> faces() const noexcept { return faces_; }
  double mean_edge() const noexcept { return graph().mean_edge_length() * graph().length_unit(); }

  /// Exact log maps, n x 2: of a surface that lies in a plane, and of the unit sphere.
  std::vector<double> plane_log(Index source) const;
  std::vector<double> sphere_log(Index source) const;
  /// Lengths of the shortest edge paths: a measure of distance that favors no method. Infinite where there is no path.
  std::vector<double> path_lengths(Index source) const;
  Index nearest(const Vec3& point) const;
  /// The input's faces; its vertices are those of the graph.
  exact::PolyhedralSurface polyhedron() const;

 private:
  std::string name_;
  trimesh::TriangleMeshSurface surface_;
  std::vector<Vec3> points_;
  std::vector<Triangle> faces_;
};

/// Runs `use` on every mesh of the user with at most `largest` vertices. If it throws an `Error`, the mesh is reported on
/// the error stream and the loop continues.
void for_user_surfaces(const Settings& settings, Index largest, const std::function<void(const Surface&)>& use);

struct NamedMethod {
  std::string_view name;
  methods::Method (*make)(const TangentGraph&);
};
/// AHM_a, AHM_l, VHM_log, SEM, and DEM as published.
std::span<const NamedMethod> log_map_methods();

/// Errors of vectors over chosen vertices.
struct Errors {
  double rms = 0, mean = 0, largest = 0;
  Index count = 0;    ///< number of vertices measured
  Index missing = 0;  ///< number of chosen vertices without coordinates
};
using Choice = std::function<bool(std::size_t)>;
Errors errors(std::span<const double> coordinates, std::span<const double> exact, const Choice& chosen);

/// Root mean square error of distances, over the vertices whose exact distance is at most `within`.
double distance_rms(std::span<const double> found, std::span<const double> exact, double within);

/// Cuts [0, longest finite length] into `count` equal rings and returns the ring of each length, -1 where infinite.
std::vector<int> rings(std::span<const double> lengths, int count);

/// The number as a cell; an empty cell where it is not finite.
Cell known(double number);

/// The q-quantile of the values, which must not be empty.
double quantile(std::vector<double> values, double q);

/// The mean of the values, which must not be empty.
double mean(std::span<const double> values);

/// Lengths of n vectors in the plane.
std::vector<double> lengths(std::span<const double> coordinates);

/// Errors of the vectors of a map relative to the distances of an exact map with the same axes, at vertices beyond two mean edges.
std::vector<double> vector_errors(const Surface& surface, const LogMap& exact, const LogMap& map);

/// Lengths of the differences between vectors and the exact ones, relative to the lengths of the exact ones, which must not be 0.
/// The axes of the maps may differ by a rotation or a reflection; the one that fits best near the source is removed.
std::vector<double> relative_errors(std::span<const std::complex<double>> found,
                                    std::span<const std::complex<double>> exact);

/// A sentence with the medians over meshes of "vector 95%", by "method" ("polar", "heat") and "as" ("triangles", "points").
std::string vector_error_summary(const Table& table);

/// Least-squares slope of log y over log x: the order of convergence if x is h and y the error.
double fitted_order(std::span<const double> x, std::span<const double> y);

}  // namespace ahm::bench
