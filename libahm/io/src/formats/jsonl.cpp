// JSON lines are not written with nlohmann/json, which would build an object with all names for every row.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/format.hpp"

namespace ahm::io {
namespace {

/// Appends a number; null for NaN and infinity, which JSON cannot represent.
template <class T>
void append_number(std::string& text, T value) {
  if constexpr (!std::is_same_v<T, double>)
    text += std::to_string(value);
  else if (std::isfinite(value))
    append_decimals(text, value);
  else
    text += "null";
}

void append_row(std::string& text, const Column& column, std::size_t row) {
  std::size_t name = 0;
  const auto append_name = [&] { text += ",\"" + column.names[name++] + "\":"; };
  if (const auto* words = std::get_if<CodedWords>(&column.values)) {
    append_name();
    text += nlohmann::json(words->words[words->codes[row]]).dump();
    return;
  }
  visit_row(column, row, [&](auto value) {
    append_name();
    append_number(text, value);
  });
}

void write(AtomicFile& file, const Table& table) {
  write_lines(file, table, [&](std::string& text, std::size_t row) {
    text += "{\"index\":" + std::to_string(row);
    for (const Column& column : table.columns) append_row(text, column, row);
    text += "}\n";
  });
}

}  // namespace

Format jsonl_format() { return {.extensions = {".jsonl"}, .write = write, .for_viewers = false}; }

}  // namespace ahm::io
