#include "read/vtk_data.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <span>
#include <type_traits>

#include "ahm/util/text.hpp"
#include "read/columns.hpp"
#include "read/text.hpp"

namespace ahm::io {
namespace {

template <class T>
double load_number(std::string_view bytes, std::size_t position, bool big_endian) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes.data() + position, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) std::ranges::reverse(raw);
  return static_cast<double>(std::bit_cast<T>(raw));
}

template <class T>
constexpr VtkType vtk_type = {sizeof(T), std::is_integral_v<T>, load_number<T>};

struct NamedType {
  std::string_view name;
  VtkType type;
};

constexpr NamedType types[] = {
    {"int8", vtk_type<std::int8_t>},
    {"uint8", vtk_type<std::uint8_t>},
    {"int16", vtk_type<std::int16_t>},
    {"uint16", vtk_type<std::uint16_t>},
    {"int32", vtk_type<std::int32_t>},
    {"uint32", vtk_type<std::uint32_t>},
    {"int64", vtk_type<std::int64_t>},
    {"uint64", vtk_type<std::uint64_t>},
    {"float32", vtk_type<float>},
    {"float64", vtk_type<double>},
    {"char", vtk_type<std::int8_t>},
    {"signed_char", vtk_type<std::int8_t>},
    {"unsigned_char", vtk_type<std::uint8_t>},
    {"short", vtk_type<std::int16_t>},
    {"unsigned_short", vtk_type<std::uint16_t>},
    {"int", vtk_type<std::int32_t>},
    {"unsigned_int", vtk_type<std::uint32_t>},
    {"long", vtk_type<std::int64_t>},
    {"unsigned_long", vtk_type<std::uint64_t>},
    {"vtkidtype", vtk_type<std::int32_t>},  // 32 bits in VTK's files, even if wider in memory
    {"vtktypeint64", vtk_type<std::int64_t>},
    {"vtktypeuint64", vtk_type<std::uint64_t>},
    {"float", vtk_type<float>},
    {"double", vtk_type<double>},
};

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return text;
}

/// The shortest decimals of a number.
std::string shown(double number) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

/// Whether all values are exactly those of the file.
bool exact(const VtkArray& array) {
  constexpr double largest = 9007199254740992;  // 2^53: doubles represent smaller integers exactly
  return !array.whole || std::ranges::all_of(array.values, [](double x) { return std::abs(x) < largest; });
}

class Joiner {
 public:
  Joiner(const Input& in, std::vector<VtkPiece> pieces) : in_(in), pieces_(std::move(pieces)) {}

  Geometry join() {
    std::erase_if(pieces_, [](const VtkPiece& piece) { return piece.points == 0; });
    if (pieces_.empty()) fail(in_, "it contains no vertex");
    std::uint64_t points = 0, lines = 0;
    bool faces = false, cell_data = false;
    for (const VtkPiece& piece : pieces_) {
      points += piece.points, lines += piece.lines;
      faces = faces || piece.polygons.begin.size() + piece.strips.begin.size() > 2;
      cell_data = cell_data || piece.has_cell_data;
    }
    check_vertex_count(in_, points);
    if (faces) g_.face_begin.push_back(0);
    for (const VtkPiece& piece : pieces_) add(piece);
    for (const VtkArray& array : pieces_.front().arrays) add_array(array.name, array.width);
    for (const VtkPiece& piece : pieces_)
      for (const VtkArray& array : piece.arrays)
        if (!of_first(array)) ignore(array.name);
    if (lines > 0) g_.warnings.push_back({"lines_ignored", {static_cast<double>(lines)}, {}});
    if (cell_data) g_.warnings.push_back({"element_ignored", {}, {}, "CellData"});
    return std::move(g_);
  }

 private:
  void ignore(const std::string& name) {
    const auto is_reported = [&](const Warning& w) { return w.id == "element_ignored" && w.name == name; };
    if (std::ranges::none_of(g_.warnings, is_reported)) g_.warnings.push_back({"element_ignored", {}, {}, name});
  }

  bool of_first(const VtkArray& array) const { return find(pieces_.front(), array.name) != nullptr; }

  static const VtkArray* find(const VtkPiece& piece, const std::string& name) {
    const auto found = std::ranges::find(piece.arrays, name, &VtkArray::name);
    return found == piece.arrays.end() ? nullptr : &*found;
  }

  void add(const VtkPiece& piece) {
    const std::size_t first = g_.points.size();
    for (std::size_t i = 0; i < piece.points; ++i)
      g_.points.push_back({piece.positions[3 * i], piece.positions[3 * i + 1], piece.positions[3 * i + 2]});
    each_cell(piece, piece.polygons, "polygon", [&](std::span<const double> corners) {
      for (const double corner : corners) g_.face_vertices.push_back(number(first, corner));
      g_.face_begin.push_back(static_cast<Offset>(g_.face_vertices.size()));
    });
    each_cell(piece, piece.strips, "strip", [&](std::span<const double> corners) {
      for (std::size_t k = 2; k < corners.size(); ++k) {
        const std::size_t turned = k % 2;
        for (const std::size_t at : {k - 2 + turned, k - 1 - turned, k})
          g_.face_vertices.push_back(number(first, corners[at]));
        g_.face_begin.push_back(static_cast<Offset>(g_.face_vertices.size()));
      }
    });
  }

  static Index number(std::size_t first, double corner) {
    return static_cast<Index>(first + static_cast<std::size_t>(corner));
  }

  template <class Use>
  void each_cell(const VtkPiece& piece, const VtkCells& cells, const std::string& kind, const Use& use) const {
    const auto last = static_cast<double>(cells.corners.size());
    for (std::size_t c = 0; c + 1 < cells.begin.size(); ++c) {
      const double begin = cells.begin[c], end = cells.begin[c + 1];
      if (!(begin >= 0 && end >= begin && end <= last))
        fail(in_, kind + " " + std::to_string(c) + " ends at corner " + shown(end) + " of " +
                      std::to_string(cells.corners.size()));
      const std::span corners =
          std::span(cells.corners).subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
      for (const double corner : corners)
        if (!(corner >= 0 && corner < static_cast<double>(piece.points)))
          fail(in_, kind + " " + std::to_string(c) + " has vertex number " + shown(corner) + ", but there are " +
                        detail::counted(piece.points, "vertex") + ", counted from 0");
      use(corners);
    }
  }

  /// The numbers of an array in all pieces; nullopt if a piece does not have the array, or has it with another width or inexact values.
  std::optional<std::vector<double>> gathered(const std::string& name, std::size_t width) {
    std::vector<double> values;
    for (const VtkPiece& piece : pieces_) {
      const VtkArray* part = find(piece, name);
      if (part == nullptr || part->width != width || !exact(*part)) return std::nullopt;
      values.insert(values.end(), part->values.begin(), part->values.end());
    }
    return values;
  }

  void add_array(const std::string& name, std::size_t width) {
    const std::optional<std::vector<double>> values = gathered(name, width);
    if (width == 0 || !values) return ignore(name);
    const std::string small = lower(name);
    const std::string& normals = pieces_.front().normals;
    if (width == 3 && g_.normals.empty() && (normals.empty() ? small == "normals" : name == normals)) {
      g_.normals = vectors(*values, 3);
      return;
    }
    const bool colors = small.find("color") != std::string::npos || small.find("rgb") != std::string::npos;
    if ((width == 3 || width == 4) && colors && g_.colors.empty())
      if (auto levels = to_colors(vectors(*values, width), true)) {
        g_.colors = std::move(*levels);
        return;
      }
    for (std::size_t c = 0; c < width; ++c) add_component(name, width, c, *values);
  }

  static std::vector<Vec3> vectors(const std::vector<double>& values, std::size_t width) {
    std::vector<Vec3> result(values.size() / width);
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = {values[width * i], values[width * i + 1], values[width * i + 2]};
    return result;
  }

  void add_component(const std::string& name, std::size_t width, std::size_t component,
                     const std::vector<double>& values) {
    std::string own = name;
    if (width == 3) own += static_cast<char>('x' + component);
    if (width == 2 || width > 3) own += '_' + std::to_string(component);
    std::vector<double> part(values.size() / width);
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = values[width * i + component];
    add_property(g_, own, std::move(part));
  }

  const Input& in_;
  std::vector<VtkPiece> pieces_;
  Geometry g_;
};

}  // namespace

std::optional<VtkType> find_vtk_type(std::string_view name) {
  for (const NamedType& known : types)
    if (equals_ignoring_case(name, known.name)) return known.type;
  return std::nullopt;
}

std::optional<double> to_vtk_number(std::string_view word, const VtkType& type) {
  if (!type.whole) return to_real(word);
  const std::optional<std::int64_t> whole = to_whole(word);
  return whole ? std::optional(static_cast<double>(*whole)) : std::nullopt;
}

std::string hint_at_comma(std::string_view word) {
  return word.find(',') != std::string_view::npos && is_like_number(word) ? "; decimals take a point" : "";
}

std::string_view next_vtk_word(std::string_view& rest) noexcept {
  const auto blank = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
  const auto begin = std::ranges::find_if_not(rest, blank);
  const auto end = std::find_if(begin, rest.end(), blank);
  const std::string_view word(begin, end);
  rest = std::string_view(end, rest.end());
  return word;
}

std::vector<double> load_vtk_numbers(std::string_view bytes, const VtkType& type, bool big_endian) {
  std::vector<double> values(bytes.size() / type.size);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = type.load(bytes, k * type.size, big_endian);
  return values;
}

Geometry join_vtk_pieces(const Input& in, std::vector<VtkPiece> pieces) { return Joiner(in, std::move(pieces)).join(); }

}  // namespace ahm::io
