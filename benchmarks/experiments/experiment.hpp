/// \file
/// An experiment: a command that makes a table. Its figure is drawn from the table only.
///
/// \code
/// Table my_figure(const Settings& settings) {                      // my_figure.cpp; declared and listed in registry.cpp,
///   Table table({"shape", "vertices", "method", "error"});         // drawn by my_figure() in plots.py
///   table.add({"sphere", 642, "AHM_a", 0.01});
///   table.add({"sphere", 642, "HM", {}});                          // {}: this method has no such number
///   table.seen = fmt::format("The error is {:.2g}.", table.where("method", "AHM_a").largest("error"));
///   return table;
/// }
/// \endcode
///
/// With `Settings::toy` experiments use sizes that take seconds; the same laws must hold (benchmarks/tests/experiments).
#pragma once

#include <concepts>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::bench {

struct Settings {
  bool toy = false;              ///< small sizes, for a test run
  std::filesystem::path meshes;  ///< folder of the user's meshes; empty: generated shapes only
  unsigned threads = 0;          ///< number of threads of measured work; 0: one per core
  std::vector<Index> vertices;   ///< sizes for the scaling experiments; empty: the default ones
};

/// A word, a number, or nothing.
class Cell {
 public:
  Cell() = default;
  Cell(const char* word) : text_(word) {}
  Cell(std::string word) : text_(std::move(word)) {}
  Cell(std::string_view word) : text_(word) {}
  /// @throws InvalidArgument (a number that is not finite; leave the cell empty instead)
  Cell(std::floating_point auto number) : text_(format(static_cast<double>(number))) {}
  Cell(std::integral auto number) : text_(std::to_string(number)) {}

  const std::string& text() const noexcept { return text_; }
  bool empty() const noexcept { return text_.empty(); }

 private:
  static std::string format(double number);
  std::string text_;
};

/// Rows under named columns.
class Table {
 public:
  explicit Table(std::vector<std::string> columns);
  /// @throws InvalidArgument (number of cells)
  void add(std::vector<Cell> row);

  const std::vector<std::string>& columns() const noexcept { return columns_; }
  const std::vector<std::vector<Cell>>& rows() const noexcept { return rows_; }
  /// @throws InvalidArgument (no such column)
  std::size_t column(std::string_view name) const;
  /// The rows with `word` in a column.
  Table where(std::string_view column, std::string_view word) const;
  /// The numbers of a column, without the empty cells.
  /// @throws InvalidArgument (a cell that is not a number)
  std::vector<double> numbers(std::string_view column) const;
  /// @throws InvalidArgument (a column without numbers)
  double largest(std::string_view column) const;
  double smallest(std::string_view column) const;
  double mean(std::string_view column) const;

  /// Comma-separated values with a header line.
  /// @throws IoError
  void write(const std::filesystem::path& path) const;
  static Table read(const std::filesystem::path& path);

  std::string seen;  ///< the result in two sentences at most

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
};

/// Appends an entry to a list: "a, b, c".
void append(std::string& list, std::string_view entry);

struct Experiment {
  std::string_view name;    ///< name of the command, the table and the plot
  std::string_view figure;  ///< figure of Soliman & Sharp 2025, or "scaling"
  std::string_view title;
  std::string_view paper;  ///< result of the paper, in two sentences at most
  Table (*run)(const Settings&);
};

/// All experiments, in the order of the report.
std::span<const Experiment> experiments();

}  // namespace ahm::bench
