#include "ahm/surface/row_map.hpp"

#include <string>

#include "ahm/error.hpp"

namespace ahm {
namespace {

void check(const char* what, Index index, Index count) {
  if (index < 0 || index >= count)
    throw InvalidArgument(
        "row_out_of_range",
        std::string(what) + " " + std::to_string(index) + " is outside [0, " + std::to_string(count) + ")",
        "numbers start at 0");
}

}  // namespace

RowMap::RowMap(Index rows, Index vertices, std::span<const RowVertex> pairs)
    : begin_(static_cast<std::size_t>(rows) + 1, 0),
      vertices_(pairs.size()),
      row_of_vertex_(static_cast<std::size_t>(vertices), -1) {
  for (const auto& [row, vertex] : pairs) {
    check("row", row.index, rows);
    check("vertex", vertex.index, vertices);
    ++begin_[row.index + 1];
  }
  for (std::size_t r = 1; r < begin_.size(); ++r) begin_[r] += begin_[r - 1];
  std::vector<Offset> fill(begin_.begin(), begin_.end() - 1);
  for (const auto& [row, vertex] : pairs) {
    vertices_[fill[row.index]++] = vertex;
    Index& first = row_of_vertex_[vertex.index];
    if (first < 0 || row.index < first) first = row.index;
  }
}

std::span<const Vertex> RowMap::vertices(Row row) const {
  check("row", row.index, row_count());
  const auto first = static_cast<std::size_t>(begin_[row.index]);
  return std::span(vertices_).subspan(first, static_cast<std::size_t>(begin_[row.index + 1]) - first);
}

std::optional<Vertex> RowMap::vertex(Row row) const {
  const std::span<const Vertex> all = vertices(row);
  return all.empty() ? std::nullopt : std::optional(all.front());
}

std::optional<Row> RowMap::row(Vertex vertex) const {
  check("vertex", vertex.index, vertex_count());
  const Index row = row_of_vertex_[vertex.index];
  return row < 0 ? std::nullopt : std::optional(Row(row));
}

Vertex first_vertex(const RowMap& rows) {
  for (Row row(0); row.index < rows.row_count(); ++row.index)
    if (const auto vertex = rows.vertex(row)) return *vertex;
  throw InvalidArgument("no row has a vertex");
}

std::vector<Vertex> vertices_with_rows(const RowMap& rows) {
  std::vector<Vertex> result;
  for (Vertex vertex(0); vertex.index < rows.vertex_count(); ++vertex.index)
    if (rows.row(vertex)) result.push_back(vertex);
  return result;
}

}  // namespace ahm
