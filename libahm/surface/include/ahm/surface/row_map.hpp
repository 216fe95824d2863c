/// \file
/// The relation between rows of the input and vertices of the graph.
///
/// \code
/// for (ahm::Vertex v : surface.rows().vertices(ahm::Row{42})) use(v);   // none: the row was removed; several: cut there
/// \endcode
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "ahm/types.hpp"

namespace ahm {

/// A row and one of its vertices.
struct RowVertex {
  Row row;
  Vertex vertex;
};

/// The relation between rows and vertices. A row has no vertex where it was removed or where no face uses it, and several where
/// a mesh was cut. A vertex has no row inside a refined polygon, and several where equal points share it.
class RowMap {
 public:
  RowMap() = default;
  /// @param pairs  the pairs of one row are in order of preference: the first vertex is `vertex(row)`
  /// @throws InvalidArgument (a number out of range)
  RowMap(Index rows, Index vertices, std::span<const RowVertex> pairs);

  Index row_count() const noexcept { return static_cast<Index>(begin_.size()) - 1; }
  Index vertex_count() const noexcept { return static_cast<Index>(row_of_vertex_.size()); }

  /// The vertices of a row. @throws InvalidArgument (out of range)
  std::span<const Vertex> vertices(Row row) const;
  /// The first vertex of a row; none where the row was removed. @throws InvalidArgument (out of range)
  std::optional<Vertex> vertex(Row row) const;
  /// The vertex of a row with the smallest value; of equal ones the first. NaN is skipped.
  /// @param value  (Vertex) -> double. @throws InvalidArgument (out of range)
  template <class Value>
  std::optional<Vertex> least(Row row, const Value& value) const {
    std::optional<Vertex> best;
    double smallest = 0;
    for (Vertex vertex : vertices(row))
      if (const double x = value(vertex); !std::isnan(x) && (!best || x < smallest)) best = vertex, smallest = x;
    return best;
  }
  /// The first row of a vertex; none for vertices that are not in the input. @throws InvalidArgument (out of range)
  std::optional<Row> row(Vertex vertex) const;

 private:
  std::vector<Offset> begin_{0};      ///< first entry of each row in `vertices_`, rows + 1
  std::vector<Vertex> vertices_;      ///< vertices of row 0, then of row 1, ...
  std::vector<Index> row_of_vertex_;  ///< first row of each vertex; -1: none
};

/// The vertex of the first row that has one: a starting point that does not depend on the order of the vertices.
/// @throws InvalidArgument (no row has a vertex)
Vertex first_vertex(const RowMap& rows);
/// The vertices with a row, in ascending order: all except those inside refined polygons.
std::vector<Vertex> vertices_with_rows(const RowMap& rows);

}  // namespace ahm
