#include <algorithm>
#include <string>

#include "little_endian.hpp"
#include "write/writers.hpp"

namespace ahm::io {
namespace {

const char* type_of(const Column& column) {
  if (std::holds_alternative<std::span<const double>>(column.values)) return "double";
  return std::holds_alternative<std::span<const Index>>(column.values) ? "int" : "uchar";
}

std::string header_of(const Table& table, bool many_corners) {
  std::string header = std::string("ply\nformat ") + (table.text ? "ascii" : "binary_little_endian") + " 1.0\n";
  if (!table.title.empty()) header += "comment " + table.title + "\n";
  for (const Column& column : table.columns)
    if (const auto* words = std::get_if<CodedWords>(&column.values))
      for (std::size_t code = 0; code < words->words.size(); ++code)
        header += "comment " + column.names.front() + " " + std::to_string(code) + " " + words->words[code] + "\n";
  header += "element vertex " + std::to_string(table.rows()) + "\n";
  for (const Column& column : table.columns)
    for (const std::string& name : column.names)
      header += std::string("property ") + type_of(column) + " " + name + "\n";
  if (table.faces.size() > 0) {
    header += "element face " + std::to_string(table.faces.size()) + "\n";
    header += std::string("property list ") + (many_corners ? "int" : "uchar") + " int vertex_indices\n";
  }
  if (!table.edges.empty())
    header += "element edge " + std::to_string(table.edges.size()) + "\nproperty int vertex1\nproperty int vertex2\n";
  return header + "end_header\n";
}

/// One element of the body, as bytes or as a line of text.
class Item {
 public:
  explicit Item(bool text) : text_(text) {}

  template <class T>
  void add(T value) {
    if (!text_) return append(bytes_, value);
    if (!bytes_.empty()) bytes_ += ' ';
    if constexpr (std::is_same_v<T, double>)
      append_decimals(bytes_, value);
    else
      bytes_ += std::to_string(value);
  }
  void write(AtomicFile& file) {
    if (text_) bytes_ += '\n';
    file.write(bytes_);
    bytes_.clear();
  }

 private:
  bool text_;
  std::string bytes_;
};

}  // namespace

void write_ply(AtomicFile& file, const Table& table) {
  bool many_corners = false;
  for (std::size_t f = 0; f < table.faces.size(); ++f) many_corners = many_corners || table.faces[f].size() > 255;
  file.write(header_of(table, many_corners));

  Item item(table.text);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (const Column& column : table.columns) visit_row(column, row, [&](auto value) { item.add(value); });
    item.write(file);
  }
  for (std::size_t f = 0; f < table.faces.size(); ++f) {
    const std::span<const Index> face = table.faces[f];
    many_corners ? item.add(static_cast<std::int32_t>(face.size())) : item.add(static_cast<std::uint8_t>(face.size()));
    for (Index corner : face) item.add(corner);
    item.write(file);
  }
  for (const auto& edge : table.edges) {
    for (Index end : edge) item.add(end);
    item.write(file);
  }
}

}  // namespace ahm::io
