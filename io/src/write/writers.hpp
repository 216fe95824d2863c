/// \file
/// One writer per format; `write` chooses among them.
#pragma once

#include <vector>

#include "ahm/io/atomic_file.hpp"
#include "ahm/io/write.hpp"

namespace ahm::io {

void write_csv(AtomicFile& file, const Table& table);
void write_ply(AtomicFile& file, const Table& table);
void write_pcd(AtomicFile& file, const Table& table);
/// Whether the library was built with PCL.
bool has_pcd() noexcept;

/// Whether the path leads to what cannot be replaced by a renamed file: a pipe, a device, or the process's own output.
bool is_stream(const std::filesystem::path& path);

/// Those of u, v, distance and angle that the table has.
std::vector<Column> map_columns(const Table& table);
/// An entry of a column, NaN where the status of the vertex is not ok.
double value_of(const Table& table, const Column& column, std::size_t vertex);

}  // namespace ahm::io
