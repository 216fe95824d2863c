/// \file
/// Numbers of a tile's vertices as rows of the input.
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>

#include "ahm/distributed/tiled_graph.hpp"
#include "ahm/io/atomic_file.hpp"

namespace ahm::distributed {

/// Shortest text that reads back as the same number; nothing for NaN.
inline void append_number(std::string& line, double value) {
  char text[32];
  if (std::isfinite(value)) line.append(text, std::to_chars(text, text + sizeof(text), value).ptr);
}

/// A line for each row of the input at a vertex of the tile, and for each that has none: its number, and what follows it.
/// @param values   of a vertex of the tile, called once for each
/// @param removed  of rows without a vertex
template <class Values>
void write_tile_rows(io::AtomicFile& file, const TiledGraph::TileRows& rows, const Values& values,
                     const std::string& removed) {
  std::string text;
  for (std::size_t i = 0; i + 1 < rows.begin.size(); ++i) {
    const std::string line = values(i);
    for (Index r = rows.begin[i]; r < rows.begin[i + 1]; ++r)
      text += std::to_string(rows.rows[static_cast<std::size_t>(r)]) + line + "\n";
    if (text.size() > 1 << 20) file.write(text), text.clear();
  }
  for (Index row : rows.removed) text += std::to_string(row) + removed + "\n";
  file.write(text);
}

}  // namespace ahm::distributed
