/// \file
/// The input of `write`: named columns, and optionally faces or edges between their rows.
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

/// Words stored as small numbers: row i contains `words[codes[i]]`.
struct CodedWords {
  std::span<const std::uint8_t> codes;
  std::vector<std::string> words;
};

/// One column, or several columns that are interleaved in memory, such as x, y, z.
struct Column {
  std::vector<std::string> names;  ///< letters, digits and _ only
  /// values of shape rows x names
  std::variant<std::span<const double>, std::span<const Index>, std::span<const std::uint8_t>, CodedWords> values;
  bool for_viewers = false;  ///< omit the column from .csv and .jsonl files

  std::size_t rows() const;
};

/// Rows of numbers and words. Views only: the data must outlive the table.
struct Table {
  std::string title;                             ///< one line; becomes a comment in formats that support comments
  std::vector<Column> columns = {};              ///< columns of equal length
  FaceList faces = {};                           ///< polygons; their vertices are rows
  std::vector<std::array<Index, 2>> edges = {};  ///< edges: pairs of rows (.ply)
  bool text = false;                             ///< write .ply as text
  std::optional<Acquisition> acquisition = {};   ///< sensor pose and image size (.pcd)
  unsigned threads = 0;                          ///< threads that format .csv and .jsonl; 0: one per core

  /// Length of the columns.
  std::size_t rows() const { return columns.empty() ? 0 : columns.front().rows(); }

  void add(std::string name, std::span<const double> values) { columns.push_back({{std::move(name)}, values}); }
  void add(std::string name, std::span<const Index> values) { columns.push_back({{std::move(name)}, values}); }
  /// Adds a column that is written as words in .csv and .jsonl and as one byte per row in other formats. The comments of a .ply
  /// file list the words.
  void add(std::string name, std::span<const Status> values);
  Column& add(std::array<std::string, 3> names, std::span<const Vec3> values);
  Column& add(std::array<std::string, 3> names, std::span<const std::array<std::uint8_t, 3>> values);
};

}  // namespace ahm::io
