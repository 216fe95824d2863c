// Own writer: PCL's rounds the viewpoint to six digits and wants all rows in memory once more.
#include <algorithm>
#include <cmath>

#include "little_endian.hpp"
#include "read/pcd_header.hpp"
#include "write/writers.hpp"

namespace ahm::io {
namespace {

enum class Storage { as_it_is, floats, packed };

using Names = std::vector<std::string>;
const Names normal_names{"nx", "ny", "nz"};
const Names color_names{"red", "green", "blue"};
/// What PCL's types of points have as floats.
const Names float_names[] = {{"x", "y", "z"}, {"intensity"}, {"curvature"}};

/// Whether every number is a float already, as the coordinates of most clouds are stored.
bool fits_float(std::span<const double> values) {
  return std::ranges::all_of(
      values, [](double x) { return !std::isfinite(x) || static_cast<double>(static_cast<float>(x)) == x; });
}

Storage storage_of(const Column& column) {
  if (std::holds_alternative<std::span<const std::uint8_t>>(column.values) && column.names == color_names)
    return Storage::packed;
  const auto* numbers = std::get_if<std::span<const double>>(&column.values);
  if (numbers == nullptr) return Storage::as_it_is;
  const bool floats = column.names == normal_names ||
                      (std::ranges::find(float_names, column.names) != std::end(float_names) && fits_float(*numbers));
  return floats ? Storage::floats : Storage::as_it_is;
}

PcdField field_of(const Column& column, std::size_t k, Storage storage) {
  // PCL's name for what others call nx, ny, nz.
  const std::string name = column.names == normal_names ? "normal_" + std::string(1, "xyz"[k]) : column.names[k];
  if (storage == Storage::floats) return {name, 'F', 4};
  if (std::holds_alternative<std::span<const double>>(column.values)) return {name, 'F', 8};
  if (std::holds_alternative<std::span<const Index>>(column.values)) return {name, 'I', sizeof(Index)};
  return {name, 'U', 1};
}

PcdHeader header_of(const Table& table, const std::vector<Storage>& storage) {
  PcdHeader header;
  header.data = PcdData::binary;
  header.points = header.width = table.rows();
  header.height = 1;
  if (const auto& seen = table.acquisition) {
    header.width = seen->width;
    header.height = seen->height;
    std::ranges::copy(seen->position, header.viewpoint.begin());
    std::ranges::copy(seen->orientation, header.viewpoint.begin() + 3);
  }
  for (std::size_t c = 0; c < storage.size(); ++c) {
    const Column& column = table.columns[c];
    if (storage[c] == Storage::packed)
      header.fields.push_back({"rgb", 'F', 4});
    else
      for (std::size_t k = 0; k < column.names.size(); ++k) header.fields.push_back(field_of(column, k, storage[c]));
  }
  return header;
}

void append_row(std::string& bytes, const Column& column, std::size_t row, Storage storage) {
  std::uint32_t packed = 0;
  visit_row(column, row, [&](auto value) {
    switch (storage) {
      case Storage::as_it_is:
        return append(bytes, value);
      case Storage::floats:
        return append(bytes, static_cast<float>(value));
      case Storage::packed:
        packed = packed << 8 | static_cast<std::uint32_t>(value);
    }
  });
  if (storage == Storage::packed) append(bytes, packed);
}

}  // namespace

void write_pcd(AtomicFile& file, const Table& table) {
  std::vector<Storage> storage;
  for (const Column& column : table.columns) storage.push_back(storage_of(column));
  file.write(full_header(header_of(table, storage)));
  std::string bytes;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    bytes.clear();
    for (std::size_t c = 0; c < storage.size(); ++c) append_row(bytes, table.columns[c], row, storage[c]);
    file.write(bytes);
  }
}

}  // namespace ahm::io
