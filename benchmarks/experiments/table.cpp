#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numeric>

#include "ahm/error.hpp"
#include "experiments/experiment.hpp"

namespace ahm::bench {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
  return result + "\"";
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && inside && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[i++];
    } else if (line[i] == '"') {
      inside = !inside;
    } else if (line[i] == ',' && !inside) {
      cells.emplace_back();
    } else {
      cells.back() += line[i];
    }
  }
  return cells;
}

std::vector<double> nonempty_numbers(const Table& table, std::string_view name) {
  std::vector<double> numbers = table.numbers(name);
  if (numbers.empty()) throw InvalidArgument(fmt::format("Table: column '{}' contains no numbers", name));
  return numbers;
}

}  // namespace

std::string Cell::format(double number) {
  if (!std::isfinite(number))
    throw InvalidArgument(fmt::format("Cell: the number is {}; leave the cell empty instead", number));
  return fmt::format("{:.6g}", number);
}

void append(std::string& list, std::string_view entry) {
  if (!list.empty()) list += ", ";
  list += entry;
}

Table::Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}

void Table::add(std::vector<Cell> row) {
  if (row.size() != columns_.size())
    throw InvalidArgument(
        fmt::format("Table::add: row {} has {} cells, but the table {} columns; pass one cell per column", rows_.size(),
                    row.size(), columns_.size()));
  rows_.push_back(std::move(row));
}

std::size_t Table::column(std::string_view name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  if (found == columns_.end())
    throw InvalidArgument(fmt::format("Table: no column '{}'; the columns are {}", name, fmt::join(columns_, ", ")));
  return static_cast<std::size_t>(found - columns_.begin());
}

Table Table::where(std::string_view name, std::string_view word) const {
  const std::size_t c = column(name);
  Table result(columns_);
  for (const auto& row : rows_)
    if (row[c].text() == word) result.rows_.push_back(row);
  return result;
}

std::vector<double> Table::numbers(std::string_view name) const {
  const std::size_t c = column(name);
  std::vector<double> result;
  for (const auto& row : rows_) {
    const std::string& text = row[c].text();
    if (text.empty()) continue;
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size())
      throw InvalidArgument(
          fmt::format("Table::numbers: column '{}' contains '{}', which is not a number", name, text));
    result.push_back(number);
  }
  return result;
}

double Table::largest(std::string_view name) const { return std::ranges::max(nonempty_numbers(*this, name)); }

double Table::smallest(std::string_view name) const { return std::ranges::min(nonempty_numbers(*this, name)); }

double Table::mean(std::string_view name) const {
  const std::vector<double> all = nonempty_numbers(*this, name);
  return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}

void Table::write(const std::filesystem::path& path) const {
  std::ofstream file(path);
  auto line = [&](const auto& cells, auto text) {
    for (std::size_t c = 0; c < cells.size(); ++c) file << (c ? "," : "") << quoted(text(cells[c]));
    file << '\n';
  };
  line(columns_, [](const std::string& name) { return name; });
  for (const auto& row : rows_) line(row, [](const Cell& cell) { return cell.text(); });
  if (!file.flush())
    throw IoError(path.string() + ": cannot be written; check that the folder is writable and the disk is not full");
}

Table Table::read(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) throw IoError(path.string() + ": cannot be read; run the experiment first");
  Table table(split(line));
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = split(line);
    table.add({cells.begin(), cells.end()});
  }
  return table;
}

}  // namespace ahm::bench
