#include <charconv>
#include <cmath>
#include <string>

#include "write/writers.hpp"

namespace ahm::io {
namespace {

/// Shortest text that reads back to the same double, in every locale.
void append(std::string& row, double value) {
  char text[32];
  row += ',';
  if (std::isnan(value)) {
    row += "nan";  // never "-nan", which some readers refuse
  } else {
    row.append(text, std::to_chars(text, text + sizeof text, value).ptr);
  }
}

}  // namespace

void write_csv(AtomicFile& file, const Table& table) {
  const std::vector<Column> columns = map_columns(table);
  std::string row = "index,x,y,z";
  for (const Column& column : columns) row += "," + column.name;
  row += ",status";
  for (const Column& column : table.further) row += "," + column.name;
  file.write(row + "\n");
  for (std::size_t i = 0; i < table.points.size(); ++i) {
    row = std::to_string(i);
    for (double coordinate : table.points[i]) append(row, coordinate);
    for (const Column& column : columns) append(row, value_of(table, column, i));
    row += ',';
    row += to_string(table.status[i]);
    for (const Column& column : table.further) append(row, value_of(table, column, i));
    row += '\n';
    file.write(row);
  }
}

}  // namespace ahm::io
