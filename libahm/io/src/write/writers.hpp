/// \file
/// Shared by the writers.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/io/atomic_file.hpp"
#include "ahm/io/textured_mesh.hpp"
#include "ahm/io/write.hpp"
#include "ahm/util/parallel.hpp"

namespace ahm::io {

/// @throws InvalidArgument when the columns, faces and edges are inconsistent
void check(const Table& table);

void write_pcd(AtomicFile& file, const Table& table);
void write_ply(AtomicFile& file, const Table& table);
void write_textured_ply(const std::filesystem::path& path, std::span<const MeshPart> parts);
void write_textured_obj(const std::filesystem::path& path, std::span<const MeshPart> parts);

/// Appends the shortest decimals that read back to the same double, independent of the locale; "nan" for every NaN.
void append_decimals(std::string& text, double value);

/// Calls `visit` with each number of a column's row: double, Index or uint8_t; words as their codes.
template <class Visit>
void visit_row(const Column& column, std::size_t row, const Visit& visit) {
  const std::size_t width = column.names.size();
  std::visit(
      [&](const auto& values) {
        if constexpr (requires { values.codes; }) {
          visit(values.codes[row]);
        } else {
          for (const auto value : values.subspan(row * width, width)) visit(value);
        }
      },
      column.values);
}

/// Writes the lines that `append(text, row)` appends. Threads format blocks of lines, because formatting takes longer than writing.
template <class Append>
void write_lines(AtomicFile& file, const Table& table, const Append& append) {
  constexpr Offset lines_per_task = 4096, tasks_at_once = 16;
  const auto rows = static_cast<Offset>(table.rows());
  std::vector<std::string> texts(tasks_at_once);
  for (Offset first = 0; first < rows; first += tasks_at_once * lines_per_task) {
    const Offset count = std::min(rows - first, tasks_at_once * lines_per_task);
    detail::parallel_chunks(count, lines_per_task, table.threads, [&](Offset begin, Offset end) {
      std::string& text = texts[begin / lines_per_task];
      text.clear();
      for (Offset row = first + begin; row < first + end; ++row) append(text, static_cast<std::size_t>(row));
    });
    for (Offset begin = 0; begin < count; begin += lines_per_task) file.write(texts[begin / lines_per_task]);
  }
}

}  // namespace ahm::io
