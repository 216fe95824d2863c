/// \file
/// Rows of the input and vertices of the graph: which belongs to which.
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

/// A row and a vertex that belong together.
struct RowVertex {
  Row row;
  Vertex vertex;
};

/// A relation of rows and vertices. A row has no vertex where it was removed or no face uses it, and several where a mesh
/// was cut; a vertex has no row inside a refined polygon, and several where equal points share it.
class RowMap {
 public:
  RowMap() = default;
  /// @param pairs  those of one row in the order of their vertices' preference: the first is `vertex(row)`
  /// @throws InvalidArgument (a number out of range)
  RowMap(Index rows, Index vertices, std::span<const RowVertex> pairs);

  Index row_count() const noexcept { return static_cast<Index>(begin_.size()) - 1; }
  Index vertex_count() const noexcept { return static_cast<Index>(row_of_vertex_.size()); }

  /// The vertices of a row. @throws InvalidArgument (out of range)
  std::span<const Vertex> vertices(Row row) const;
  /// The first vertex of a row; none where it was removed. @throws InvalidArgument (out of range)
  std::optional<Vertex> vertex(Row row) const;
  /// Of the vertices of a row the one with the least value, the first of equal ones; NaN is no value.
  /// @param value  (Vertex) -> double. @throws InvalidArgument (out of range)
  template <class Value>
  std::optional<Vertex> least(Row row, const Value& value) const {
    std::optional<Vertex> best;
    double smallest = 0;
    for (Vertex vertex : vertices(row))
      if (const double x = value(vertex); !std::isnan(x) && (!best || x < smallest)) best = vertex, smallest = x;
    return best;
  }
  /// The first row of a vertex; none for vertices that the input does not have. @throws InvalidArgument (out of range)
  std::optional<Row> row(Vertex vertex) const;

 private:
  std::vector<Offset> begin_{0};      ///< rows + 1
  std::vector<Vertex> vertices_;      ///< row after row
  std::vector<Index> row_of_vertex_;  ///< -1: none
};

/// The vertex of the first row that has one: where to begin, whatever order a surface has put its vertices in.
/// @throws InvalidArgument (none has)
Vertex first_vertex(const RowMap& rows);
/// The vertices that the input has, in ascending order: all but those inside of refined polygons.
std::vector<Vertex> vertices_with_rows(const RowMap& rows);

}  // namespace ahm
