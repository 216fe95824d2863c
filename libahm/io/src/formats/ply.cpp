// This reader does not use a library, because none in Debian 12 follows the rules of `read`. CGAL's PLY_reader allocates memory for
// a list count without checking the file size, shifts all data after an unknown type, stops at "nan" in text, and reads "1,5" as 1.
// PCL's ply_parser reads invalid numbers as NaN. OpenMesh requires a manifold. Assimp and VTK have single precision.
// One loop over items and properties reads all three encodings.
#include <algorithm>
#include <array>
#include <limits>

#include "formats/format.hpp"
#include "read/columns.hpp"
#include "read/ply_header.hpp"
#include "read/point_stream.hpp"
#include "read/text.hpp"

namespace ahm::io {
namespace {

/// Source of the values: in text, one line per item; else bytes.
class Body {
 public:
  Body(const Input& in, const PlyHeader& header, Lines&& lines)
      : in_(in),
        text_(header.format == PlyFormat::ascii),
        swap_(is_swapped(header.format)),
        lines_(std::move(lines)),
        position_(header.body) {}

  void begin_item(const PlyElement& element, std::uint64_t item) {
    element_ = &element;
    item_ = item;
    if (!text_) return;
    if (!lines_.next_filled()) fail_at_line(in_, lines_.number(), "the file ends before " + name_of_item());
    rest_ = lines_.line();
  }

  double value(PlyType type) {
    if (text_) return real_or_fail(in_, lines_.number(), word());
    const std::size_t size = size_of(type);
    need(size);
    const double result = load_value(type, in_.bytes.data() + position_, swap_);
    position_ += size;
    return result;
  }

  /// An exact whole number: doubles represent the integers of all PLY types.
  std::int64_t whole(PlyType type) {
    if (text_) return whole_or_fail(in_, lines_.number(), word());
    return static_cast<std::int64_t>(value(type));
  }

  /// The count of a list. Fails if the rest of the line or file is too short for so many values.
  std::size_t list_count(const PlyProperty& list) {
    const std::int64_t count = whole(*list.count_type);
    const std::size_t left = text_ ? (rest_.size() + 1) / 2 : (in_.bytes.size() - position_) / size_of(list.type);
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
      position_ += count * size_of(property.type);
    }
  }

  void end_item() {
    if (text_ && !next_word(rest_).empty()) fail_here("more values than " + name_of_item() + " has properties");
  }

  bool at_end() { return text_ ? !lines_.next_filled() : position_ == in_.bytes.size(); }

  [[noreturn]] void fail_here(const std::string& what) const {
    if (text_) fail_at_line(in_, lines_.number(), what);
    fail_at_byte(in_, position_, what);
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

  void need(std::size_t size) const {
    if (size > in_.bytes.size() - position_) fail_here("the file ends within " + name_of_item());
  }

  const Input& in_;
  bool text_;
  bool swap_;
  Lines lines_;
  std::size_t position_;
  std::string_view rest_;
  const PlyElement* element_ = nullptr;
  std::uint64_t item_ = 0;
};

/// Roles of scalar properties of the vertices: 0-2 position, 3-5 normal, 6-8 color.
constexpr std::size_t unused = 9;
constexpr std::array<std::string_view, unused> roles = {"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"};

/// The role of every property. Normals and colors are used only if all three components exist.
std::vector<std::size_t> assign_roles(const Input& in, const PlyElement& vertex) {
  std::vector<std::size_t> role_of(vertex.properties.size(), unused);
  for (std::size_t group = 0; group < unused; group += 3) {
    std::array<std::optional<std::size_t>, 3> found;
    bool complete = true;
    for (std::size_t k = 0; k < 3; ++k) {
      found[k] = vertex.find(roles[group + k]);
      if (!found[k] && group == 0) {
        fail_at_line(in, vertex.line, "the vertices have no property '" + std::string(roles[k]) + "'");
      }
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

/// @param take  receives every point, and `g` keeps only the last one; null: `g` keeps all points
void read_vertices(const Input& in, const PlyElement& vertex, Body& body, Geometry& g, const TakePoint* take) {
  for (const PlyProperty& p : vertex.properties) {
    if (p.count_type) {
      fail_at_line(in, vertex.line,
                   "property '" + p.name + "' of the vertices is a list; vertices must have plain values");
    }
  }
  check_vertex_count(in, vertex.count);
  const std::vector<std::size_t> role_of = assign_roles(in, vertex);
  const auto n = static_cast<std::size_t>(vertex.count), kept = take != nullptr ? std::size_t{1} : n;
  g.points.resize(kept);
  if (std::ranges::count(role_of, std::size_t{3}) > 0) g.normals.resize(kept);
  Colors colors(role_of, vertex, kept);
  for (std::size_t p = 0; p < role_of.size(); ++p)
    if (role_of[p] == unused) add_property(g, vertex.properties[p].name, std::vector<double>(kept));
  for (std::size_t item = 0; item < n; ++item) {
    const std::size_t i = take != nullptr ? 0 : item;
    body.begin_item(vertex, item);
    auto property = g.properties.begin();
    for (std::size_t p = 0; p < role_of.size(); ++p) {
      const std::size_t role = role_of[p];
      if (role == unused) {
        (property++)->values[i] = body.value(vertex.properties[p].type);
      } else if (role < 3) {
        g.points[i][role] = body.value(vertex.properties[p].type);
      } else if (role < 6) {
        g.normals[i][role - 3] = body.value(vertex.properties[p].type);
      } else {
        colors.read(vertex.properties[p].type, body, i, role - 6);
      }
    }
    body.end_item();
    if (take != nullptr) (*take)(g.points[i]);
  }
  colors.move_to(g);
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
  if (!list.count_type || !is_whole(list.type)) {
    fail_at_line(in, element.line, "property '" + list.name + "' must be a list of whole numbers");
  }
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
  if (header.ignored_lines > 0)
    g.warnings.push_back({"header_lines_ignored", {static_cast<double>(header.ignored_lines)}, {}});
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      read_vertices(in, element, body, g, take);
    } else {
      read_items(in, element, body, g);
    }
  }
  if (!body.at_end()) g.warnings.push_back({"goes_on_after_elements", {}, {}});
  return g;
}

Geometry read(const Input& in) {
  const PlyHeader header = parse_ply_header(in);
  const std::size_t text = header.format == PlyFormat::ascii ? header.body : in.bytes.size();
  Body body(in, header, Lines(std::string_view(in.bytes).substr(text), header.body_line));
  return read_elements(in, header, body);
}

/// Passes the points of a text file to `take`. @return whether they have normals
bool take_points(const ByteStream& file, const TakePoint& take) {
  const PlyHeader header = parse_ply_header(file.head());
  Body body(file.head(), header, Lines(file, header.body, header.body_line));
  return !read_elements(file.head(), header, body, &take).normals.empty();
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
