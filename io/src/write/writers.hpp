/// \file
/// What the writers share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ahm/io/atomic_file.hpp"
#include "ahm/io/textured_mesh.hpp"
#include "ahm/io/write.hpp"

namespace ahm::io {

/// @throws InvalidArgument when the columns, faces and edges do not fit together
void check(const Table& table);

void write_pcd(AtomicFile& file, const Table& table);
void write_ply(AtomicFile& file, const Table& table);
void write_textured_ply(const std::filesystem::path& path, std::span<const MeshPart> parts);
void write_textured_obj(const std::filesystem::path& path, std::span<const MeshPart> parts);

/// Appends the shortest decimals that read back to the same double, in every locale; "nan" for every NaN.
void append_decimals(std::string& text, double value);

/// Calls `visit` with the numbers of a row of a column: double, Index or uint8_t, words as their codes.
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

}  // namespace ahm::io
