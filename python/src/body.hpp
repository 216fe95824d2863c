/// \file
/// What Python calls a surface: a graph with rows and, of surfaces, everything that leads from the input to it.
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

/// A point as Python names it: a position in space, or a point in terms of the input.
using Place = std::variant<Vec3, SurfacePoint>;

/// Points from Python, decoded, and the name of the argument they came as.
struct Places {
  std::string name;
  bool single = false;  ///< so that a message says "source", not "sources[0]"
  std::vector<Place> places;

  std::string where(std::size_t k) const { return single ? name : name + "[" + std::to_string(k) + "]"; }
  std::size_t size() const { return places.size(); }
  /// Whether nothing but rows was named: many of them need no sources.
  bool all_rows() const;
};

/// Shared by everything that is made from it. Immutable.
class Body {
 public:
  explicit Body(std::unique_ptr<const Surface> surface) : surface_(std::move(surface)) {}
  explicit Body(std::unique_ptr<const grid::GridGraph> grid) : grid_(grid.get()), graph_(std::move(grid)) {}
  explicit Body(std::unique_ptr<const TangentGraph> graph) : graph_(std::move(graph)) {}

  const TangentGraph& graph() const { return surface_ ? surface_->graph() : *graph_; }
  /// Null of grids and graphs, whose rows are their vertices.
  const Surface* surface() const { return surface_.get(); }
  /// @throws InvalidArgument naming `what` where this is none
  const Surface& surface_for(const char* what) const;
  const grid::GridGraph* grid() const { return grid_; }
  Index rows() const { return surface_ ? surface_->rows().row_count() : graph_->size(); }
  /// The vertex of the first row that has one.
  /// All of a graph without a surface.
  std::vector<Vertex> vertices_with_rows() const {
    return surface_ ? ahm::vertices_with_rows(surface_->rows()) : std::vector<Vertex>();
  }
  Vertex first() const { return surface_ ? first_vertex(surface_->rows()) : Vertex(0); }

  /// The vertex of a row. @throws InvalidArgument
  Vertex vertex(Row row) const { return surface_ ? surface_->vertex(row) : Vertex(row.index); }
  std::optional<Row> row(Vertex vertex) const;

  /// A source at a point, its u axis along a vector of space.
  SurfaceSource source(const Place& place, const std::optional<Vec3>& u_axis = {}) const;
  std::vector<SurfaceSource> sources(const Places& places, const std::optional<Vec3>& u_axis = {}) const;
  /// The same without where they lie.
  std::vector<Source> plain_sources(const Places& places, const std::optional<Vec3>& u_axis = {}) const;
  /// The point of the input, and that one only where a position was named. @throws InvalidArgument (no surface)
  SurfacePoint point(const Place& place) const;
  /// The vertex at a row, at the row nearest to a position, or at the nearest corner of the face or edge of a point.
  /// @throws InvalidArgument
  Vertex vertex_near(const Place& place) const;
  std::vector<Vertex> vertices_near(const Places& places) const;

  /// Made by the first call. @throws as `ExactGeodesics`
  const ExactGeodesics& geodesics() const;
  /// Of these. Made by the first call.
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

/// @param given  (name, single, kinds, indices, counts, values): per point the kind (0 row, 1 position, 2 in a face, 3 on an
/// edge), its row, face or first row, how many of its row of `values` count, and these: a position, barycentric
/// coordinates, or the edge's second row and t
Places places(const py::tuple& given);

/// None, or three numbers.
std::optional<Vec3> optional_vector(const py::object& given);

}  // namespace ahm::python
