// The legacy VTK format is not read with VTK. Its reader (9.1) returns uninitialized memory after an invalid number ("1,5"), reads
// 1e400 as the largest double, and does not check corners. It reports no error in these cases.
#include <algorithm>
#include <array>
#include <utility>

#include "ahm/util/text.hpp"
#include "formats/format.hpp"
#include "read/text.hpp"
#include "read/vtk_data.hpp"

namespace ahm::io {
namespace {

/// An attribute of points or cells, and its number of values per point or cell.
struct VtkAttribute {
  std::string_view keyword;
  std::size_t width;  ///< 0: the file contains the width
};

constexpr std::array<VtkAttribute, 8> attributes = {{{"vectors", 3},
                                                     {"normals", 3},
                                                     {"tensors", 9},
                                                     {"tensors6", 6},
                                                     {"global_ids", 1},
                                                     {"pedigree_ids", 1},
                                                     {"scalars", 0},
                                                     {"texture_coordinates", 0}}};

bool is_vtk_keyword(std::string_view word) {
  using namespace std::string_view_literals;
  constexpr std::array others = {"dataset"sv,   "field"sv,        "metadata"sv,   "points"sv,
                                 "vertices"sv,  "lines"sv,        "polygons"sv,   "triangle_strips"sv,
                                 "cell_data"sv, "lookup_table"sv, "point_data"sv, "color_scalars"sv};
  const auto is = [&](std::string_view lower) { return equals_ignoring_case(word, lower); };
  return std::ranges::any_of(others, is) || std::ranges::any_of(attributes, is, &VtkAttribute::keyword);
}

class VtkReader {
 public:
  explicit VtkReader(const Input& in)
      : in_(in), rest_(in.bytes), end_(in.bytes.find('\n') == std::string::npos ? '\r' : '\n') {}

  Geometry read() {
    read_header();
    for (std::string_view keyword = word(); !keyword.empty(); keyword = word()) read_section(keyword);
    std::vector<VtkPiece> pieces;
    pieces.push_back(std::move(piece_));
    Geometry g = join_vtk_pieces(in_, std::move(pieces));
    g.format = binary_ ? "VTK binary" : "VTK text";
    skipped_.report(g.warnings);
    return g;
  }

 private:
  [[noreturn]] void fail_here(const std::string& what) const {
    fail_at_byte(in_, in_.bytes.size() - rest_.size(), what);
  }

  std::string_view line() {
    const std::size_t end = rest_.find(end_);
    std::string_view result = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (result.ends_with('\r')) result.remove_suffix(1);
    return result;
  }

  std::string_view word() { return next_vtk_word(rest_); }

  std::string_view word_or_fail(const char* what) {
    const std::string_view result = word();
    if (result.empty()) fail_here(std::string("the file ends before ") + what);
    return result;
  }

  std::uint64_t count(const char* what) {
    const std::string_view text = word_or_fail(what);
    const std::optional<std::int64_t> value = to_whole(text);
    if (!value || *value < 0) fail_here(in_quotes(text) + " is not " + what);
    return static_cast<std::uint64_t>(*value);
  }

  void read_header() {
    constexpr std::string_view beginning = "# vtk DataFile Version ";
    const std::string_view first = line();
    if (!equals_ignoring_case(first.substr(0, beginning.size()), "# vtk datafile version "))
      fail_at_byte(in_, 0, "a VTK file begins with '# vtk DataFile Version'");
    std::string_view version = first.substr(beginning.size());
    const std::optional<double> number = to_real(next_word(version));
    if (!number || !(*number >= 1 && *number < 6))
      fail_at_byte(in_, beginning.size(),
                   "the version is " + in_quotes(first.substr(beginning.size())) + "; versions 1 to 5 are supported");
    constexpr double with_offsets = 5;
    offsets_ = *number >= with_offsets;
    line();  // the title
    const std::string_view kind = word_or_fail("ASCII or BINARY");
    binary_ = equals_ignoring_case(kind, "binary");
    if (!binary_ && !equals_ignoring_case(kind, "ascii"))
      fail_here("expected ASCII or BINARY, found " + in_quotes(kind));
  }

  void read_section(std::string_view keyword) {
    const auto is = [&](std::string_view lower) { return equals_ignoring_case(keyword, lower); };
    if (is("dataset")) return read_dataset();
    if (is("field")) return read_field();
    if (is("metadata")) return skip_metadata();
    if (!polydata_) fail_here("expected DATASET, found " + in_quotes(keyword));
    if (is("points")) {
      if (std::exchange(has_points_, true)) fail_here("POINTS appears twice");
      piece_.points = count("the number of points");
      check_vertex_count(in_, piece_.points);
      piece_.positions = numbers(word_or_fail("the type of the points"), piece_.points, 3, "points").values;
    } else if (is("vertices")) {
      read_cells();
    } else if (is("lines")) {
      piece_.lines += read_cells().begin.size() - 1;
    } else if (is("polygons")) {
      piece_.polygons = read_cells();
    } else if (is("triangle_strips")) {
      piece_.strips = read_cells();
    } else if (is("point_data") || is("cell_data")) {
      by_point_ = is("point_data");
      tuples_ = count("the number of values");
      piece_.has_cell_data = piece_.has_cell_data || !by_point_;
      if (by_point_ && !has_points_) fail_here("POINT_DATA appears before POINTS");
      if (by_point_ && tuples_ != piece_.points)
        fail_here("there are values for " + detail::counted(tuples_, "point") + ", but there are " +
                  detail::counted(piece_.points, "point"));
    } else {
      read_attribute(keyword);
    }
  }

  void read_dataset() {
    const std::string_view kind = word_or_fail("the kind of data");
    polydata_ = equals_ignoring_case(kind, "polydata");
    if (!polydata_)
      fail_here("it contains " + in_quotes(kind) + "; only POLYDATA can be read; save its surface as .vtp or .ply");
  }

  /// Skips lines up to the next empty line.
  void skip_metadata() {
    line();
    while (!rest_.empty() && !line().empty()) {
    }
  }

  void read_attribute(std::string_view keyword) {
    if (!is_vtk_keyword(keyword)) return skip_unknown(keyword);
    const std::string name(word_or_fail("the name of an array"));
    if (equals_ignoring_case(keyword, "lookup_table")) return (void)colors(count("the size of a table"), 4, name);
    if (equals_ignoring_case(keyword, "color_scalars")) {
      const std::uint64_t width = count("the number of values of a color");
      return keep(colors(tuples_, width, name));
    }
    const auto& [lower, width] = *std::ranges::find_if(
        attributes, [&](const VtkAttribute& a) { return equals_ignoring_case(keyword, a.keyword); });
    if (lower == "normals" && by_point_) piece_.normals = name;
    if (lower == "scalars") return read_scalars(name);
    const std::uint64_t wide = width == 0 ? count("the number of texture coordinates") : width;
    keep(numbers(word_or_fail("the type of an array"), tuples_, wide, name));
  }

  /// Skips an unknown statement and the lines after it, up to the next keyword. The data of binary files has no lines.
  void skip_unknown(std::string_view keyword) {
    if (binary_ || is_like_number(keyword) || has_control_characters(keyword))
      fail_here(in_quotes(keyword) + " is not a VTK keyword; the file is damaged");
    const auto begin = static_cast<std::size_t>(keyword.data() - in_.bytes.data());
    auto number = 1 + std::count(in_.bytes.begin(), in_.bytes.begin() + static_cast<std::ptrdiff_t>(begin), end_);
    rest_ = std::string_view(in_.bytes).substr(begin);
    for (std::string_view ahead = rest_; !rest_.empty() && !is_vtk_keyword(next_word(ahead)); ahead = rest_)
      skipped_.add(number++, line());
  }

  /// The current line contains the type and optionally the number of components; the next line may name a color table.
  void read_scalars(const std::string& name) {
    const std::string_view type = word_or_fail("the type of an array");
    std::string_view rest_of_line = rest_.substr(0, rest_.find(end_));
    const std::uint64_t width = next_word(rest_of_line).empty() ? 1 : count("the number of components");
    std::string_view ahead = rest_;
    if (equals_ignoring_case(next_vtk_word(ahead), "lookup_table")) {
      word();
      word_or_fail("the name of a table of colors");
    }
    keep(numbers(type, tuples_, width, name));
  }

  /// Reads arrays of any length; keeps those with a value for every point.
  void read_field() {
    word_or_fail("the name of a field");
    for (std::uint64_t arrays = count("the number of arrays"); arrays > 0; --arrays) {
      std::string name(word_or_fail("the name of an array"));
      if (equals_ignoring_case(name, "metadata")) {
        skip_metadata();
        name = word_or_fail("the name of an array");
      }
      if (equals_ignoring_case(name, "null_array")) continue;
      const std::uint64_t width = count("the number of components"), tuples = count("the number of values");
      const std::string_view type = word_or_fail("the type of an array");
      if (equals_ignoring_case(type, "string")) {
        skip_strings(width, tuples, name);
        continue;
      }
      VtkArray array = numbers(type, tuples, width, name);
      if (by_point_ && tuples == piece_.points) keep(std::move(array));
    }
  }

  /// Skips an array of strings, one per line.
  void skip_strings(std::uint64_t width, std::uint64_t tuples, const std::string& name) {
    if (binary_) fail_here("array " + in_quotes(name) + " contains strings, which are not supported in binary files");
    line();
    for (std::uint64_t k = 0; k < tuples; ++k)
      for (std::uint64_t c = 0; c < width; ++c) {
        if (rest_.empty()) fail_here("the file ends within array " + in_quotes(name));
        line();
      }
    if (by_point_) keep({name, 0, false, {}});
  }

  void keep(VtkArray array) {
    if (by_point_) piece_.arrays.push_back(std::move(array));
  }

  /// Reads colors: fractions of 1 in text files, bytes in binary files.
  VtkArray colors(std::uint64_t tuples, std::uint64_t width, const std::string& name) {
    VtkArray array = numbers(binary_ ? "unsigned_char" : "float", tuples, width, name);
    array.name = "color_" + name;
    return array;
  }

  VtkArray numbers(std::string_view type_name, std::uint64_t tuples, std::uint64_t width, const std::string& name) {
    const std::optional<VtkType> type = find_vtk_type(type_name);
    if (!type) fail_here("the type " + in_quotes(type_name) + " of " + in_quotes(name) + " is not supported");
    if (binary_) line();
    const std::uint64_t most = binary_ ? rest_.size() / type->size : (rest_.size() + 1) / 2;
    if (width > 0 && tuples > most / width)
      fail_here(std::to_string(tuples) + " times " + detail::counted(width, "number") + " of " + in_quotes(name) +
                " do not fit into the " + detail::counted(rest_.size(), "byte") +
                " that follow; the file is cut short");
    const std::uint64_t all = tuples * width;
    VtkArray array{name, static_cast<std::size_t>(width), type->whole, {}};
    if (binary_) {
      array.values = load_vtk_numbers(rest_.substr(0, all * type->size), *type, true);
      rest_.remove_prefix(all * type->size);
      return array;
    }
    array.values.resize(all);
    for (double& value : array.values) {
      const std::string_view text = word();
      const std::optional<double> number = to_vtk_number(text, *type);
      if (!number)
        fail_here("expected a number of " + in_quotes(name) + ", found " + in_quotes(text) + hint_at_comma(text));
      value = *number;
    }
    return array;
  }

  /// Before version 5, each cell is stored as its number of corners and the corners; since version 5, as offsets and corners.
  VtkCells read_cells() {
    const std::uint64_t first = count("the number of cells"), second = count("the number of numbers");
    VtkCells cells;
    if (offsets_) {
      if (first == 0) return cells;
      cells.begin = cell_array("offsets", first);
      cells.corners = cell_array("connectivity", second);
      return cells;
    }
    const std::vector<double> all = numbers("int", second, 1, "cells").values;
    std::size_t at = 0;
    for (std::uint64_t c = 0; c < first; ++c) {
      if (at >= all.size() || !(all[at] >= 0 && all[at] < static_cast<double>(all.size() - at)))
        fail_here("cell " + std::to_string(c) + " of " + std::to_string(first) + " does not fit into its " +
                  detail::counted(second, "number"));
      const auto corners = static_cast<std::size_t>(all[at++]);
      for (std::size_t k = 0; k < corners; ++k) cells.corners.push_back(all[at++]);
      cells.begin.push_back(static_cast<double>(cells.corners.size()));
    }
    if (at != all.size()) fail_here("the cells end before their " + detail::counted(second, "number", "do"));
    return cells;
  }

  std::vector<double> cell_array(std::string_view lower, std::uint64_t length) {
    const std::string_view keyword = word_or_fail("the cells");
    if (!equals_ignoring_case(keyword, lower))
      fail_here("expected " + std::string(lower) + ", found " + in_quotes(keyword));
    const std::string_view type = word_or_fail("the type of the cells");
    return numbers(type, length, 1, std::string(lower)).values;
  }

  const Input& in_;
  std::string_view rest_;
  char end_;  ///< of a line
  bool binary_ = false, offsets_ = false, polydata_ = false;
  bool has_points_ = false;
  bool by_point_ = false;  ///< the following arrays have a value per point
  std::uint64_t tuples_ = 0;
  SkippedLines skipped_;
  VtkPiece piece_;
};

Geometry read(const Input& in) { return VtkReader(in).read(); }

}  // namespace

Format vtk_format() { return {.extensions = {".vtk"}, .signatures = {"# vtk DataFile"}, .read = read}; }

}  // namespace ahm::io
