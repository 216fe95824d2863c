// This reader does not use a library, because none in Debian 12 follows the rules of `read`. CGAL's PLY_reader allocates memory for
// a list count without checking the file size, shifts all data after an unknown type, stops at "nan" in text, and reads "1,5" as 1.
// PCL's ply_parser reads invalid numbers as NaN. OpenMesh requires a manifold. Assimp and VTK have single precision.
// One loop over items and properties reads all three encodings.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "ahm/util/text.hpp"
#include "formats/format.hpp"
#include "read/binary_source.hpp"
#include "read/columns.hpp"
#include "read/ply_header.hpp"
#include "read/point_stream.hpp"
#include "read/text.hpp"

namespace ahm::io {
namespace {

/// Source of the values: in text, one line per item; else bytes.
class Body {
 public:
  /// @param lines   the text after the header; empty in binary files
  /// @param binary  the bytes after the header; not used in text files
  Body(const Input& in, const PlyHeader& header, Lines&& lines, BinarySource&& binary)
      : in_(in),
        text_(header.format == PlyFormat::ascii),
        swap_(is_swapped(header.format)),
        lines_(std::move(lines)),
        binary_(std::move(binary)) {
    lines_.skipped() = header.skipped;
  }

  void begin_item(const PlyElement& element, std::uint64_t item) {
    element_ = &element;
    item_ = item;
    if (!text_) return;
    if (!lines_.next_data()) fail_at_line(in_, lines_.number(), "the file ends before " + name_of_item());
    rest_ = lines_.line();
  }

  double value(PlyType type) {
    if (text_) return real_or_fail(in_, lines_.number(), word());
    return load_value(type, take(type), swap_);
  }

  /// A value that doubles represent exactly. @throws IoError
  double exact(PlyType type) {
    const double result = value(type);
    if (!is_exact(type) && std::abs(result) >= least_inexact)
      fail_here(name_of_item() + " has a coordinate of 2^53 or more, which has no double precision");
    return result;
  }

  /// A whole number of any type. @throws IoError for fractions, and numbers out of range
  std::int64_t whole(PlyType type) {
    if (text_ && is_whole(type)) return whole_or_fail(in_, lines_.number(), word());
    if (!text_ && !is_exact(type)) return whole_of_64_bits(type);
    const double result = value(type);
    if (result == std::floor(result) && std::abs(result) < least_inexact) return static_cast<std::int64_t>(result);
    fail_here(name_of_item() + " has " + detail::number(result) + " where a whole number is required");
  }

  /// The count of a list. Fails if the rest of the line or file is too short for so many values.
  std::size_t list_count(const PlyProperty& list) {
    const std::int64_t count = whole(*list.count_type);
    const std::uint64_t left = text_ ? (rest_.size() + 1) / 2 : binary_.left() / size_of(list.type);
    if (count < 0 || static_cast<std::uint64_t>(count) > left) {
      fail_here("list '" + list.name + "' of " + name_of_item() + " has count " + std::to_string(count) +
                ", but at most " + std::to_string(left) + " can follow");
    }
    return static_cast<std::size_t>(count);
  }

  void skip(const PlyProperty& property) {
    std::size_t count = property.count_type ? list_count(property) : 1;
    if (text_) {
      for (; count > 0; --count) word();
    } else {
      need(count * size_of(property.type));
      binary_.skip(count * size_of(property.type));
    }
  }

  void end_item() {
    if (text_ && !next_word(rest_).empty()) fail_here("more values than " + name_of_item() + " has properties");
  }

  bool at_end() { return text_ ? !lines_.next_data() : binary_.left() == 0; }
  /// Lines of the header and the body without a meaning.
  const SkippedLines& skipped() noexcept { return lines_.skipped(); }

  [[noreturn]] void fail_here(const std::string& what) const {
    if (text_) fail_at_line(in_, lines_.number(), what);
    fail_at_byte(in_, binary_.position(), what);
  }

  std::string name_of_item() const {
    return element_->name + " " + std::to_string(item_) + " of " + std::to_string(element_->count);
  }

 private:
  std::string_view word() {
    const std::string_view word = next_word(rest_);
    if (word.empty()) fail_here("fewer values than " + name_of_item() + " has properties");
    return word;
  }

  const char* take(PlyType type) {
    need(size_of(type));
    return binary_.take(size_of(type));
  }

  std::int64_t whole_of_64_bits(PlyType type) {
    std::array<char, 8> raw;
    std::copy_n(take(type), raw.size(), raw.begin());
    if (swap_) std::ranges::reverse(raw);
    const auto result = std::bit_cast<std::int64_t>(raw);
    if (type == PlyType::uint64 && result < 0) fail_here(name_of_item() + " has a whole number of 2^63 or more");
    return result;
  }

  void need(std::uint64_t size) const {
    if (size > binary_.left()) fail_here("the file ends within " + name_of_item());
  }

  const Input& in_;
  bool text_;
  bool swap_;
  Lines lines_;
  BinarySource binary_;
  std::string_view rest_;
  const PlyElement* element_ = nullptr;
  std::uint64_t item_ = 0;
};

/// Roles of scalar properties of the vertices: 0-2 position, 3-5 normal, 6-8 color.
constexpr std::size_t unused = 9;
constexpr std::array<std::string_view, unused> roles = {"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"};

/// The role of every property. Normals and colors are used only if all three components exist and none is a list.
std::vector<std::size_t> assign_roles(const Input& in, const PlyElement& vertex) {
  std::vector<std::size_t> role_of(vertex.properties.size(), unused);
  for (std::size_t group = 0; group < unused; group += 3) {
    std::array<std::optional<std::size_t>, 3> found;
    bool complete = true;
    for (std::size_t k = 0; k < 3; ++k) {
      found[k] = vertex.find(roles[group + k]);
      const bool is_list = found[k] && vertex.properties[*found[k]].count_type;
      if (group == 0 && (!found[k] || is_list)) {
        const std::string name(roles[k]);
        fail_at_line(in, vertex.line,
                     is_list ? "property '" + name + "' of the vertices is a list; it must be a number"
                             : "the vertices have no property '" + name + "'");
      }
      if (is_list) found[k].reset();
      complete = complete && found[k];
    }
    for (std::size_t k = 0; complete && k < 3; ++k) role_of[*found[k]] = group + k;
  }
  return role_of;
}

/// Colors as bytes, or as numbers that `move_to` converts to bytes.
class Colors {
 public:
  Colors(const std::vector<std::size_t>& role_of, const PlyElement& vertex, std::size_t n) {
    bool bytes = true, present = false;
    for (std::size_t p = 0; p < role_of.size(); ++p) {
      if (role_of[p] < 6 || role_of[p] == unused) continue;
      present = true;
      bytes = bytes && vertex.properties[p].type == PlyType::uint8;
    }
    if (present && bytes) levels_.resize(n);
    if (present && !bytes) numbers_.resize(n);
  }

  void read(PlyType type, Body& body, std::size_t i, std::size_t channel) {
    if (levels_.empty()) {
      numbers_[i][channel] = body.value(type);
      return;
    }
    const std::int64_t level = body.whole(type);
    if (level < 0 || level > 255) body.fail_here("color " + std::to_string(level) + " is not in 0..255");
    levels_[i][channel] = static_cast<std::uint8_t>(level);
  }

  void move_to(Geometry& g) {
    if (!numbers_.empty()) {
      if (auto colors = to_colors(numbers_, true))
        levels_ = std::move(*colors);
      else
        g.warnings.push_back({"colors_unknown", {}, {}});
    }
    g.colors = std::move(levels_);
  }

 private:
  std::vector<Color> levels_;
  std::vector<Vec3> numbers_;
};

/// Prepares the values of the scalar properties without a role, and warns about lists, which are skipped.
/// @return the values by property; empty where it has a role or is a list
std::vector<std::vector<double>> other_values(const PlyElement& vertex, const std::vector<std::size_t>& role_of,
                                              std::size_t n, Geometry& g) {
  std::vector<std::vector<double>> values(role_of.size());
  for (std::size_t p = 0; p < role_of.size(); ++p) {
    const PlyProperty& property = vertex.properties[p];
    if (property.count_type) g.warnings.push_back({"list_ignored", {}, {}, property.name});
    if (role_of[p] == unused && !property.count_type) values[p].resize(n);
  }
  return values;
}

void keep_others(const PlyElement& vertex, std::vector<std::vector<double>>& values, Geometry& g) {
  for (std::size_t p = 0; p < values.size(); ++p) {
    const PlyProperty& property = vertex.properties[p];
    if (values[p].empty()) continue;
    const auto inexact = [](double x) { return std::abs(x) >= least_inexact; };
    if (!is_exact(property.type) && std::ranges::any_of(values[p], inexact))
      g.warnings.push_back({"element_ignored", {}, {}, property.name});
    else
      add_property(g, property.name, std::move(values[p]));
  }
}

/// @param take  receives every point, and `g` keeps only the last one; null: `g` keeps all points
void read_vertices(const Input& in, const PlyElement& vertex, Body& body, Geometry& g, const TakePoint* take) {
  check_vertex_count(in, vertex.count);
  const std::vector<std::size_t> role_of = assign_roles(in, vertex);
  const auto n = static_cast<std::size_t>(vertex.count), kept = take != nullptr ? std::size_t{1} : n;
  g.points.resize(kept);
  if (std::ranges::count(role_of, std::size_t{3}) > 0) g.normals.resize(kept);
  Colors colors(role_of, vertex, kept);
  std::vector<std::vector<double>> others = other_values(vertex, role_of, kept, g);
  for (std::size_t item = 0; item < n; ++item) {
    const std::size_t i = take != nullptr ? 0 : item;
    body.begin_item(vertex, item);
    for (std::size_t p = 0; p < role_of.size(); ++p) {
      const std::size_t role = role_of[p];
      const PlyProperty& property = vertex.properties[p];
      if (property.count_type) {
        body.skip(property);
      } else if (role == unused) {
        others[p][i] = body.value(property.type);
      } else if (role < 3) {
        g.points[i][role] = body.exact(property.type);
      } else if (role < 6) {
        g.normals[i][role - 3] = body.value(property.type);
      } else {
        colors.read(property.type, body, i, role - 6);
      }
    }
    body.end_item();
    if (take != nullptr) (*take)(g.points[i]);
  }
  colors.move_to(g);
  keep_others(vertex, others, g);
}

void read_corners(const PlyProperty& list, Body& body, Geometry& g) {
  for (std::size_t count = body.list_count(list); count > 0; --count) {
    const std::int64_t corner = body.whole(list.type);
    if (corner < 0 || corner > std::numeric_limits<Index>::max()) {
      body.fail_here(body.name_of_item() + " has vertex number " + std::to_string(corner));
    }
    g.face_vertices.push_back(static_cast<Index>(corner));
  }
  g.face_begin.push_back(static_cast<Offset>(g.face_vertices.size()));
}

/// Reads a strip: each three successive vertices are a triangle, with alternating orientation; -1 begins a new strip. Triangles with
/// two equal vertices only connect parts of the strip, and are skipped.
void read_strip(const PlyProperty& list, Body& body, Geometry& g) {
  std::array<std::int64_t, 3> last{};
  std::size_t length = 0;
  for (std::size_t count = body.list_count(list); count > 0; --count) {
    const std::int64_t corner = body.whole(list.type);
    if (corner < -1 || corner > std::numeric_limits<Index>::max()) {
      body.fail_here(body.name_of_item() + " has vertex number " + std::to_string(corner));
    }
    last = {last[1], last[2], corner};
    length = corner == -1 ? 0 : length + 1;
    if (length < 3 || last[0] == last[1] || last[1] == last[2] || last[2] == last[0]) continue;
    const bool turned = length % 2 == 0;
    for (std::size_t k : {std::size_t{0}, std::size_t{turned ? 2u : 1u}, std::size_t{turned ? 1u : 2u}}) {
      g.face_vertices.push_back(static_cast<Index>(last[k]));
    }
    g.face_begin.push_back(static_cast<Offset>(g.face_vertices.size()));
  }
}

/// Index of the property that contains the vertex numbers of a face or strip.
std::size_t find_corners(const Input& in, const PlyElement& element) {
  const std::optional<std::size_t> plural = element.find("vertex_indices");
  const std::optional<std::size_t> singular = element.find("vertex_index");
  if (plural && singular) fail_at_line(in, element.line, "the faces have both 'vertex_indices' and 'vertex_index'");
  if (!plural && !singular) fail_at_line(in, element.line, "the faces have no list 'vertex_indices'");
  const PlyProperty& list = element.properties[plural ? *plural : *singular];
  if (!list.count_type) fail_at_line(in, element.line, "property '" + list.name + "' must be a list");
  return plural ? *plural : *singular;
}

void read_items(const Input& in, const PlyElement& element, Body& body, Geometry& g) {
  if (element.count == 0) return;
  const bool strips = element.name == "tristrips";
  std::optional<std::size_t> corners;
  if (element.name == "face" || strips) {
    corners = find_corners(in, element);
    if (g.face_begin.empty()) g.face_begin.push_back(0);
  } else {
    g.warnings.push_back({"element_ignored", {}, {}, element.name});
  }
  if (element.properties.empty()) return;
  for (std::uint64_t item = 0; item < element.count; ++item) {
    body.begin_item(element, item);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (corners != p) {
        body.skip(property);
      } else if (strips) {
        read_strip(property, body, g);
      } else {
        read_corners(property, body, g);
      }
    }
    body.end_item();
  }
}

/// @param take  as in `read_vertices`
Geometry read_elements(const Input& in, const PlyHeader& header, Body& body, const TakePoint* take = nullptr) {
  if (std::ranges::find(header.elements, "vertex", &PlyElement::name) == header.elements.end()) {
    fail(in, "the PLY header has no element 'vertex'");
  }
  constexpr std::array<const char*, 3> names = {"PLY text", "PLY binary little endian", "PLY binary big endian"};
  Geometry g;
  g.format = names[static_cast<std::size_t>(header.format)];
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      read_vertices(in, element, body, g, take);
    } else {
      read_items(in, element, body, g);
    }
  }
  if (!body.at_end()) g.warnings.push_back({"data_after_elements", {}, {}});
  body.skipped().report(g.warnings);
  return g;
}

Geometry read(const Input& in) {
  const PlyHeader header = parse_ply_header(in);
  const std::size_t text = header.format == PlyFormat::ascii ? header.body : in.bytes.size();
  Body body(in, header, Lines(std::string_view(in.bytes).substr(text), header.body_line), {in, header.body});
  return read_elements(in, header, body);
}

/// Passes the points to `take`. @return whether they have normals
bool take_points(const ByteStream& file, const TakePoint& take) {
  const Input& in = file.head();
  const PlyHeader header = parse_ply_header(in);
  const bool text = header.format == PlyFormat::ascii;
  Body body(in, header, text ? Lines(file, header.body, header.body_line) : Lines(std::string_view{}),
            {file, header.body});
  return !read_elements(in, header, body, &take).normals.empty();
}

}  // namespace

Format ply_format() {
  return {.extensions = {".ply"},
          .signatures = {"ply"},
          .read = read,
          .records = ply_records,
          .take_points = take_points,
          .write = write_ply,
          .write_textured = write_textured_ply};
}

}  // namespace ahm::io
