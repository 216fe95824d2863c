#include <string>

#include "formats/format.hpp"
#include "read/columns.hpp"

namespace ahm::io {
namespace {

void append_row(std::string& text, const Column& column, std::size_t row) {
  if (const auto* words = std::get_if<CodedWords>(&column.values)) {
    text += ',';
    text += words->words[words->codes[row]];
    return;
  }
  visit_row(column, row, [&](auto value) {
    text += ',';
    if constexpr (std::is_same_v<decltype(value), double>)
      append_decimals(text, value);
    else
      text += std::to_string(value);
  });
}

void write(AtomicFile& file, const Table& table) {
  std::string text = "index";
  for (const Column& column : table.columns)
    for (const std::string& name : column.names) text += "," + name;
  file.write(text + "\n");
  write_lines(file, table, [&](std::string& line, std::size_t row) {
    line += std::to_string(row);
    for (const Column& column : table.columns) append_row(line, column, row);
    line += '\n';
  });
}

constexpr ColumnDialect dialect{.format = "CSV text", .tabs_separate = true};

Geometry read(const Input& in) { return read_columns(in, dialect); }

bool take_points(const ByteStream& file, const TakePoint& take) { return take_columns(file, dialect, take); }

}  // namespace

Format csv_format() {
  return {.extensions = {".csv"}, .read = read, .take_points = take_points, .write = write, .for_viewers = false};
}

}  // namespace ahm::io
