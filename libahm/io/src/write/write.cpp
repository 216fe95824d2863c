// PCD is not written with PCL, whose writer rounds the viewpoint to six digits and copies all rows in memory.
#include "ahm/io/write.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>
#include <vector>

#include "ahm/io/formats.hpp"
#include "formats/format.hpp"
#include "little_endian.hpp"
#include "read/input.hpp"
#include "read/pcd_header.hpp"
#include "write/writers.hpp"

namespace ahm::io {

void append_decimals(std::string& text, double value) {
  if (std::isnan(value)) {
    text += "nan";  // not "-nan", which some readers reject
    return;
  }
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

void write_obj_lines(const std::filesystem::path& path, std::span<const Vec3> points, std::span<const Index> begin,
                     std::span<const std::string> groups) {
  std::string text = "# curve by libahm\n";
  for (const Vec3& p : points) {
    text += 'v';
    for (const double x : p) append_decimals(text += ' ', x);
    text += '\n';
  }
  for (std::size_t k = 0; k < begin.size(); ++k) {
    const Index end = k + 1 < begin.size() ? begin[k + 1] : static_cast<Index>(points.size());
    if (begin[k] == end) continue;
    if (!groups.empty() && (k == 0 || groups[k] != groups[k - 1])) text += "g " + groups[k] + '\n';
    text += 'l';
    for (Index i = begin[k]; i < end; ++i) text += ' ' + std::to_string(i + 1);
    text += '\n';
  }
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw IoError("cannot write " + quoted_path(path) + ": " + what);
}

/// The extension that selects the format: the requested one, or else that of the file name.
std::string extension_to_write(const std::filesystem::path& path, const std::string& asked) {
  const std::string extension = asked.empty() ? lower_extension(path) : asked;
  return extension.empty() && is_stream(path) ? ".csv" : extension;
}

/// The format to write to. @throws IoError
const Format& format_to_write(const std::filesystem::path& path, const std::string& asked) {
  const std::string extension = extension_to_write(path, asked);
  const Format* format = find_format(extension);
  if (format == nullptr || (format->write == nullptr && format->missing.empty()))
    fail(path, "unknown file type " + in_quotes(extension) + "; known types are " + list_of(extensions(Use::write)));
  if (format->write == nullptr)
    fail(path, "this build has no " + format->missing + ", which writes " + extension + " files; choose .ply or .csv");
  return *format;
}

}  // namespace

void write(const std::filesystem::path& path, const Table& table, const std::string& extension) {
  const Format& format = format_to_write(path, extension);
  check(table);
  AtomicFile file(path);
  if (format.for_viewers) {
    format.write(file, table);
  } else {
    Table numbers = table;
    std::erase_if(numbers.columns, [](const Column& column) { return column.for_viewers; });
    format.write(file, numbers);
  }
  file.commit();
}

bool writes_for_viewers(const std::filesystem::path& path, const std::string& extension) {
  const Format* format = find_format(extension_to_write(path, extension));
  return format == nullptr || format->for_viewers;
}

void check_writable(const std::filesystem::path& path, const std::string& extension) {
  format_to_write(path, extension);
  std::error_code error;
  const auto reason = [](int code) { return std::generic_category().message(code); };
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) fail(path, reason(EISDIR));
  if (std::filesystem::exists(status) && ::access(path.c_str(), W_OK) != 0) fail(path, reason(errno));
  if (is_stream(path)) return;  // written to directly
  std::filesystem::path directory = std::filesystem::weakly_canonical(path, error).parent_path();
  if (error || directory.empty()) directory = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(directory, error)) fail(path, "there is no directory " + quoted_path(directory));
  if (::access(directory.c_str(), W_OK | X_OK) != 0)
    fail(path, "directory " + quoted_path(directory) + ": " + reason(errno));
}

namespace {

enum class Storage { as_it_is, floats, packed };

using Names = std::vector<std::string>;
const Names normal_names{"nx", "ny", "nz"};
const Names color_names{"red", "green", "blue"};
/// Columns that are floats in PCL's point types.
const Names float_names[] = {{"x", "y", "z"}, {"intensity"}, {"curvature"}};

/// Whether every number is exactly a float, like the coordinates of most clouds.
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
  // PCL calls nx, ny, nz normal_x, normal_y, normal_z.
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

namespace {

const char* type_of(const Column& column) {
  if (std::holds_alternative<std::span<const double>>(column.values)) return "double";
  return std::holds_alternative<std::span<const Index>>(column.values) ? "int" : "uchar";
}

std::string header_of(const Table& table, bool many_corners) {
  std::string header = std::string("ply\nformat ") + (table.text ? "ascii" : "binary_little_endian") + " 1.0\n";
  if (!table.title.empty()) header += "comment " + table.title + "\n";
  for (const Column& column : table.columns)
    if (const auto* words = std::get_if<CodedWords>(&column.values))
      for (std::size_t code = 0; code < words->words.size(); ++code)
        header += "comment " + column.names.front() + " " + std::to_string(code) + " " + words->words[code] + "\n";
  header += "element vertex " + std::to_string(table.rows()) + "\n";
  for (const Column& column : table.columns)
    for (const std::string& name : column.names)
      header += std::string("property ") + type_of(column) + " " + name + "\n";
  if (table.faces.size() > 0) {
    header += "element face " + std::to_string(table.faces.size()) + "\n";
    header += std::string("property list ") + (many_corners ? "int" : "uchar") + " int vertex_indices\n";
  }
  if (!table.edges.empty())
    header += "element edge " + std::to_string(table.edges.size()) + "\nproperty int vertex1\nproperty int vertex2\n";
  return header + "end_header\n";
}

/// One item of a PLY element, as bytes or as a line of text.
class Item {
 public:
  explicit Item(bool text) : text_(text) {}

  template <class T>
  void add(T value) {
    if (!text_) return append(bytes_, value);
    if (!bytes_.empty()) bytes_ += ' ';
    if constexpr (std::is_same_v<T, double>)
      append_decimals(bytes_, value);
    else
      bytes_ += std::to_string(value);
  }
  void write(AtomicFile& file) {
    if (text_) bytes_ += '\n';
    file.write(bytes_);
    bytes_.clear();
  }

 private:
  bool text_;
  std::string bytes_;
};

}  // namespace

void write_ply(AtomicFile& file, const Table& table) {
  bool many_corners = false;
  for (std::size_t f = 0; f < table.faces.size(); ++f) many_corners = many_corners || table.faces[f].size() > 255;
  file.write(header_of(table, many_corners));

  Item item(table.text);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (const Column& column : table.columns) visit_row(column, row, [&](auto value) { item.add(value); });
    item.write(file);
  }
  for (std::size_t f = 0; f < table.faces.size(); ++f) {
    const std::span<const Index> face = table.faces[f];
    many_corners ? item.add(static_cast<std::int32_t>(face.size())) : item.add(static_cast<std::uint8_t>(face.size()));
    for (Index corner : face) item.add(corner);
    item.write(file);
  }
  for (const auto& edge : table.edges) {
    for (Index end : edge) item.add(end);
    item.write(file);
  }
}

}  // namespace ahm::io
