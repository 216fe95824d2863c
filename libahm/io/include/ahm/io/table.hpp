/// \file
/// Named columns, and perhaps faces or edges between their rows: what all writers of rows write.
///
/// \code
/// ahm::io::Table table{.title = "logarithmic map"};
/// table.add({"x", "y", "z"}, geometry.points);
/// table.add("u", u), table.add("v", v);                  // n numbers each
/// table.add("status", map.status());
/// table.faces = geometry.faces();
/// ahm::io::write("map.ply", table);
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/types.hpp"

namespace ahm::io {

/// Small numbers that stand for words: `codes[i]` for `words[codes[i]]`.
struct CodedWords {
  std::span<const std::uint8_t> codes;
  std::vector<std::string> words;
};

/// One column, or several of one kind that lie side by side in memory as x, y, z do.
struct Column {
  std::vector<std::string> names;  ///< letters, digits and _
  /// rows x names
  std::variant<std::span<const double>, std::span<const Index>, std::span<const std::uint8_t>, CodedWords> values;
  bool for_viewers = false;  ///< only: left out of .csv and .jsonl

  std::size_t rows() const;
};

/// Rows of numbers and words. Views only: the data must outlive the table.
struct Table {
  std::string title;                             ///< one line, for the comments of files that have them
  std::vector<Column> columns = {};              ///< of equal length
  FaceList faces = {};                           ///< polygons of rows
  std::vector<std::array<Index, 2>> edges = {};  ///< pairs of rows (.ply)
  bool text = false;                             ///< .ply as text
  std::optional<Acquisition> acquisition = {};   ///< of the rows (.pcd)
  unsigned threads = 0;                          ///< that spell the lines of .csv and .jsonl; 0: one per core

  /// The length of the columns.
  std::size_t rows() const { return columns.empty() ? 0 : columns.front().rows(); }

  void add(std::string name, std::span<const double> values) { columns.push_back({{std::move(name)}, values}); }
  void add(std::string name, std::span<const Index> values) { columns.push_back({{std::move(name)}, values}); }
  /// As words in .csv, as one byte each elsewhere, explained in the comments of a .ply.
  void add(std::string name, std::span<const Status> values);
  Column& add(std::array<std::string, 3> names, std::span<const Vec3> values);
  Column& add(std::array<std::string, 3> names, std::span<const std::array<std::uint8_t, 3>> values);
};

}  // namespace ahm::io
