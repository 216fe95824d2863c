/// \file
/// The C++ object behind a Python surface: a tangent graph with rows. Meshes and clouds also have a `Surface`.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ahm/grid/grid_graph.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/surface.hpp"
#include "arrays.hpp"
#include "input_faces.hpp"

namespace ahm::python {

/// A point from Python: a position in space, or a point of the input.
using Place = std::variant<Vec3, SurfacePoint>;

/// Points from Python, and the name of their argument.
struct Places {
  std::string name;
  bool single = false;  ///< whether messages name the argument without an index: "source", not "sources[0]"
  std::vector<Place> places;

  std::string where(std::size_t k) const { return single ? name : name + "[" + std::to_string(k) + "]"; }
  std::size_t size() const { return places.size(); }
  /// Whether all points are rows. Functions then use vertices, which are cheaper than sources.
  bool all_rows() const;
};

/// A surface, grid or graph. Immutable; shared by the solvers and maps that use it.
class Body {
 public:
  explicit Body(std::unique_ptr<const Surface> surface) : surface_(std::move(surface)) {}
  explicit Body(std::unique_ptr<const grid::GridGraph> grid) : grid_(grid.get()), graph_(std::move(grid)) {}
  explicit Body(std::unique_ptr<const TangentGraph> graph) : graph_(std::move(graph)) {}

  const TangentGraph& graph() const { return surface_ ? surface_->graph() : *graph_; }
  /// Null for grids and graphs, whose rows are their vertices.
  const Surface* surface() const { return surface_.get(); }
  /// The surface. @throws InvalidArgument (a grid or graph; the message begins with `what`)
  const Surface& surface_for(const char* what) const;
  const grid::GridGraph* grid() const { return grid_; }
  Index rows() const { return surface_ ? surface_->rows().row_count() : graph_->size(); }
  /// The vertices that have rows; empty for grids and graphs, where all vertices have one.
  std::vector<Vertex> vertices_with_rows() const {
    return surface_ ? ahm::vertices_with_rows(surface_->rows()) : std::vector<Vertex>();
  }
  /// The vertex of the first row that has one.
  Vertex first() const { return surface_ ? first_vertex(surface_->rows()) : Vertex(0); }

  /// The vertex of a row. @throws InvalidArgument
  Vertex vertex(Row row) const { return surface_ ? surface_->vertex(row) : Vertex(row.index); }
  std::optional<Row> row(Vertex vertex) const;

  /// A source at a point, with its u axis along a vector in space. @throws InvalidArgument
  SurfaceSource source(const Place& place, const std::optional<Vec3>& u_axis = {}) const;
  std::vector<SurfaceSource> sources(const Places& places, const std::optional<Vec3>& u_axis = {}) const;
  /// The sources without their positions and frames.
  std::vector<Source> plain_sources(const Places& places, const std::optional<Vec3>& u_axis = {}) const;
  /// The point of the input; for a position, the nearest point of the surface. @throws InvalidArgument (a position on a grid or graph)
  SurfacePoint point(const Place& place) const;
  /// The vertex of a row, of the row nearest to a position, or of the nearest corner of the face or edge of a point.
  /// @throws InvalidArgument
  Vertex vertex_near(const Place& place) const;
  std::vector<Vertex> vertices_near(const Places& places) const;

  /// The exact geodesics of the surface. The first call creates them. @throws as `ExactGeodesics`
  const ExactGeodesics& geodesics() const;
  /// Conversion of points of `geodesics()` to faces of the input. The first call creates it.
  const InputFaces& input_faces() const;

 private:
  std::unique_ptr<const Surface> surface_;
  const grid::GridGraph* grid_ = nullptr;
  std::unique_ptr<const TangentGraph> graph_;
  mutable std::once_flag once_, once_faces_;
  mutable std::unique_ptr<const ExactGeodesics> geodesics_;
  mutable std::unique_ptr<const InputFaces> input_faces_;
};

using BodyPtr = std::shared_ptr<Body>;

/// Decodes points that `_places.py` has packed.
/// @param given  (name, single, kinds, indices, counts, values), with one entry per point in the last four:
/// kinds: 0 row, 1 position, 2 point in a face, 3 point on an edge; indices: the row, the face, or the first row of the edge;
/// values, of which counts[k] are used: a position, barycentric coordinates, or the second row of the edge and t
Places places(const py::tuple& given);

/// Converts None or an array of three numbers.
std::optional<Vec3> optional_vector(const py::object& given);

}  // namespace ahm::python
