/// \file
/// Writes numbers of vertices as CSV rows of the input, and reads columns of the input.
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "ahm/io/atomic_file.hpp"
#include "ahm/tiles/tiled_graph.hpp"

namespace ahm::tiles {

/// Appends the shortest text that reads back as the same number; nothing for NaN and infinity.
inline void append_number(std::string& line, double value) {
  char text[32];
  if (std::isfinite(value)) line.append(text, std::to_chars(text, text + sizeof(text), value).ptr);
}

/// The CSV fields of a vertex. A row with several vertices takes the fields of the vertex with the smallest rank, the first of equal
/// ones. If all ranks are NaN, it takes the last.
struct VertexLine {
  std::string text;
  double rank = 0;
};

/// Writes one line for each row of the input, tile by tile: the number of the row and the fields of its vertex.
class RowLines {
 public:
  RowLines(io::AtomicFile& file, const TiledGraph& graph) : file_(file) {
    for (Index row : graph.shared_rows()) shared_.emplace(row, VertexLine{{}, NAN});
  }

  /// Adds the rows of a tile.
  /// @param line     line(i): fields of vertex i of the tile, called once per vertex
  /// @param removed  fields of rows without a vertex
  template <class Line>
  void add(const TiledGraph::TileRows& rows, const Line& line, const std::string& removed) {
    for (std::size_t i = 0; i + 1 < rows.begin.size(); ++i) {
      const VertexLine vertex_line = line(i);
      for (Index r = rows.begin[i]; r < rows.begin[i + 1]; ++r)
        add(rows.rows[static_cast<std::size_t>(r)], vertex_line);
    }
    for (Index row : rows.removed) add(row, {removed});
  }
  /// Writes the rows with several vertices, which are complete only now.
  void finish() {
    for (const auto& [row, line] : shared_) write(row, line);
    file_.write(text_);
    text_.clear();
  }

 private:
  void add(Index row, const VertexLine& line) {
    const auto shared = shared_.empty() ? shared_.end() : shared_.find(row);
    if (shared == shared_.end()) return write(row, line);
    if (const double best = shared->second.rank; std::isnan(best) || line.rank < best) shared->second = line;
  }
  void write(Index row, const VertexLine& line) {
    text_ += std::to_string(row) + line.text + "\n";
    if (text_.size() > 1 << 20) file_.write(text_), text_.clear();
  }

  io::AtomicFile& file_;
  std::string text_;
  std::map<Index, VertexLine> shared_;
};

/// A one-dimensional .npy file of float64, memory-mapped.
class RowValues {
 public:
  /// @throws IoError (the file cannot be read, is not such a file, or is truncated)
  explicit RowValues(const std::filesystem::path& path);
  ~RowValues();
  RowValues(RowValues&& other) noexcept;
  RowValues& operator=(RowValues&&) = delete;

  std::size_t size() const noexcept { return size_; }
  double operator[](std::size_t row) const;

 private:
  void* data_ = nullptr;
  std::size_t bytes_ = 0, begin_ = 0, size_ = 0;  ///< size of the file; offset of the values; number of values
};

}  // namespace ahm::tiles
