#include <string>

#include "little_endian.hpp"
#include "write/writers.hpp"

namespace ahm::io {
namespace {

std::string header_of(const Table& table, std::size_t faces, bool many_corners) {
  std::string header = "ply\nformat binary_little_endian 1.0\ncomment logarithmic map by libahm\n";
  for (Status status : {Status::ok, Status::disconnected, Status::beyond_radius, Status::unreached, Status::removed}) {
    header +=
        "comment status " + std::to_string(static_cast<int>(status)) + " " + std::string(to_string(status)) + "\n";
  }
  header += "element vertex " + std::to_string(table.points.size()) + "\n";
  for (const char* name : {"x", "y", "z"}) header += std::string("property double ") + name + "\n";
  if (!table.normals.empty()) header += "property double nx\nproperty double ny\nproperty double nz\n";
  for (const Column& column : map_columns(table)) header += "property double " + column.name + "\n";
  header += "property uchar status\n";
  for (const Column& column : table.further) header += "property double " + column.name + "\n";
  if (faces > 0) {
    header += "element face " + std::to_string(faces) + "\n";
    header += std::string("property list ") + (many_corners ? "int" : "uchar") + " int vertex_indices\n";
  }
  return header + "end_header\n";
}

}  // namespace

void write_ply(AtomicFile& file, const Table& table) {
  const std::size_t faces = table.face_begin.empty() ? 0 : table.face_begin.size() - 1;
  bool many_corners = false;
  for (std::size_t f = 0; f < faces; ++f)
    many_corners = many_corners || table.face_begin[f + 1] - table.face_begin[f] > 255;
  file.write(header_of(table, faces, many_corners));

  const std::vector<Column> columns = map_columns(table);
  std::string row;
  for (std::size_t i = 0; i < table.points.size(); ++i) {
    row.clear();
    for (double coordinate : table.points[i]) append(row, coordinate);
    if (!table.normals.empty()) {
      for (double coordinate : table.normals[i]) append(row, coordinate);
    }
    for (const Column& column : columns) append(row, value_of(table, column, i));
    append(row, static_cast<std::uint8_t>(table.status[i]));
    for (const Column& column : table.further) append(row, value_of(table, column, i));
    file.write(row);
  }
  for (std::size_t f = 0; f < faces; ++f) {
    row.clear();
    const auto corners = static_cast<std::int32_t>(table.face_begin[f + 1] - table.face_begin[f]);
    if (many_corners) {
      append(row, corners);
    } else {
      append(row, static_cast<std::uint8_t>(corners));
    }
    for (Offset k = table.face_begin[f]; k < table.face_begin[f + 1]; ++k) {
      append(row, table.face_vertices[k]);
    }
    file.write(row);
  }
}

}  // namespace ahm::io
