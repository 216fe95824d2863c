#include "read/ply_header.hpp"

#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "read/point_stream.hpp"
#include "read/text.hpp"

namespace ahm::io {
namespace {

using namespace std::string_view_literals;

PlyType parse_type(const Input& in, std::int64_t line, std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 18> names = {{
      {"char"sv, PlyType::int8},
      {"int8"sv, PlyType::int8},
      {"uchar"sv, PlyType::uint8},
      {"uint8"sv, PlyType::uint8},
      {"short"sv, PlyType::int16},
      {"int16"sv, PlyType::int16},
      {"ushort"sv, PlyType::uint16},
      {"uint16"sv, PlyType::uint16},
      {"int"sv, PlyType::int32},
      {"int32"sv, PlyType::int32},
      {"uint"sv, PlyType::uint32},
      {"uint32"sv, PlyType::uint32},
      {"int64"sv, PlyType::int64},
      {"uint64"sv, PlyType::uint64},
      {"float"sv, PlyType::float32},
      {"float32"sv, PlyType::float32},
      {"double"sv, PlyType::float64},
      {"float64"sv, PlyType::float64},
  }};
  for (const auto& [name, type] : names) {
    if (name == word) return type;
  }
  fail_at_line(in, line, in_quotes(word) + " is not a PLY type");
}

PlyFormat parse_format(const Input& in, std::int64_t line, std::string_view word) {
  if (word == "ascii") return PlyFormat::ascii;
  if (word == "binary_little_endian") return PlyFormat::little_endian;
  if (word == "binary_big_endian") return PlyFormat::big_endian;
  fail_at_line(in, line, "unknown PLY format " + in_quotes(word));
}

PlyElement parse_element(const Input& in, std::int64_t line, const std::vector<std::string_view>& words) {
  if (words.size() != 3) fail_at_line(in, line, "expected 'element <name> <count>'");
  const std::int64_t count = whole_or_fail(in, line, words[2]);
  if (count < 0) fail_at_line(in, line, "negative element count " + std::to_string(count));
  return {std::string(words[1]), static_cast<std::uint64_t>(count), {}, line};
}

PlyProperty parse_property(const Input& in, std::int64_t line, const std::vector<std::string_view>& words) {
  if (words.size() == 3) return {std::string(words[2]), parse_type(in, line, words[1]), std::nullopt};
  if (words.size() != 5 || words[1] != "list")
    fail_at_line(in, line, "expected 'property [list <type>] <type> <name>'");
  return {std::string(words[4]), parse_type(in, line, words[3]), parse_type(in, line, words[2])};
}

/// Reads the lines of the header. The end of the first line determines whether lines end with a lone "\r". Bytes after "end_header"
/// and its line end are not examined, because binary data may contain any byte.
class HeaderLines {
 public:
  explicit HeaderLines(const Input& in) : in_(in) {
    const std::size_t first = in.bytes.find_first_of("\r\n");
    const bool lone = first != std::string::npos && in.bytes[first] == '\r' &&
                      (first + 1 == in.bytes.size() || in.bytes[first + 1] != '\n');
    end_ = lone ? '\r' : '\n';
  }

  std::string_view next() {
    constexpr std::size_t longest = 1 << 16;
    const std::size_t end = in_.bytes.find(end_, position);
    ++number;
    if (end == std::string::npos || end - position > longest) {
      fail_at_line(in_, number, "the PLY header has no 'end_header'; the file is cut short or not a PLY file");
    }
    std::string_view line = std::string_view(in_.bytes).substr(position, end - position);
    position = end + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  std::size_t position = 0;
  std::int64_t number = 0;

 private:
  const Input& in_;
  char end_;
};

/// Rejects elements that are larger than the rest of the file, before memory is allocated for them.
void check_against_size(const Input& in, const PlyHeader& header) {
  // The last line of a text file may have no line end: one separator is missing.
  std::uint64_t left = in.size() - header.body + (header.format == PlyFormat::ascii ? 1 : 0);
  for (const PlyElement& element : header.elements) {
    const bool text = header.format == PlyFormat::ascii;
    const std::uint64_t least = text ? 2 * element.properties.size() : element.fixed_size();
    if (least == 0) continue;
    if (element.count > left / least) {
      fail_at_line(in, element.line,
                   "element '" + element.name + "' should have " + detail::counted(element.count, "item") +
                       " of at least " + detail::counted(least, "byte") + ", but only " +
                       detail::counted(left, "byte", "are") + " left; the file is cut short or its header is wrong");
    }
    left -= element.count * least;
  }
}

/// Rejects elements that are declared twice, and duplicates (ignoring case) of properties that the reader uses.
void check_names(const Input& in, const PlyHeader& header) {
  static constexpr std::array read_names = {
      "x"sv, "y"sv, "z"sv, "nx"sv, "ny"sv, "nz"sv, "red"sv, "green"sv, "blue"sv, "vertex_indices"sv, "vertex_index"sv};
  for (std::size_t e = 0; e < header.elements.size(); ++e) {
    const PlyElement& element = header.elements[e];
    for (std::size_t k = 0; k < e; ++k) {
      if (header.elements[k].name == element.name) {
        fail_at_line(in, element.line, "element '" + element.name + "' is declared twice");
      }
    }
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const std::string& name = element.properties[p].name;
      const auto read = std::ranges::find_if(read_names, [&](auto lower) { return equals_ignoring_case(name, lower); });
      if (read != read_names.end() && element.find(*read) != p) {
        fail_at_line(in, element.line, "element '" + element.name + "' has property '" + name + "' twice");
      }
    }
  }
}

}  // namespace

std::size_t size_of(PlyType type) noexcept {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::int64:
    case PlyType::uint64:
    case PlyType::float64:
      return 8;
  }
  return 0;
}

bool is_whole(PlyType type) noexcept { return type != PlyType::float32 && type != PlyType::float64; }

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
  const auto found =
      std::ranges::find_if(properties, [&](const PlyProperty& p) { return equals_ignoring_case(p.name, property); });
  if (found == properties.end()) return std::nullopt;
  return static_cast<std::size_t>(found - properties.begin());
}

bool PlyElement::has_list() const noexcept {
  return std::ranges::any_of(properties, [](const PlyProperty& p) { return p.count_type.has_value(); });
}

std::size_t PlyElement::fixed_size() const noexcept {
  std::size_t size = 0;
  for (const PlyProperty& p : properties) size += size_of(p.count_type.value_or(p.type));
  return size;
}

PlyHeader parse_ply_header(const Input& in) {
  constexpr std::size_t most_properties = 4096;  // limits the quadratic search for equal names
  HeaderLines lines(in);
  if (!in.bytes.starts_with("ply") || lines.next() != "ply") fail_at_line(in, 1, "a PLY file begins with a line 'ply'");

  PlyHeader header;
  bool has_format = false;
  std::size_t properties = 0;
  std::vector<std::string_view> words;
  for (;;) {
    const std::string_view line = lines.next();
    split_words(line, words);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (++properties > most_properties) fail_at_line(in, lines.number, "more than 4096 elements and properties");
    if (words[0] == "format" && words.size() >= 2 && !has_format) {
      header.format = parse_format(in, lines.number, words[1]);
      has_format = true;
    } else if (words[0] == "element") {
      header.elements.push_back(parse_element(in, lines.number, words));
    } else if (words[0] == "property") {
      if (header.elements.empty()) fail_at_line(in, lines.number, "a property before the first 'element' line");
      header.elements.back().properties.push_back(parse_property(in, lines.number, words));
    } else if (header.elements.empty() || (has_format && header.format == PlyFormat::ascii) || is_remark(line)) {
      header.skipped.add(lines.number, line);  // in text, a misspelled property causes an error later
    } else {
      fail_at_line(in, lines.number, "unexpected " + in_quotes(words[0]) + " in the PLY header");
    }
  }
  if (!has_format) fail_at_line(in, lines.number, "the PLY header has no 'format' line");
  header.body = lines.position;
  header.body_line = lines.number + 1;
  check_names(in, header);
  check_against_size(in, header);
  return header;
}

namespace {

void find_coordinates(const Input& in, const PlyElement& vertex, PointRecords& records) {
  const auto offset_of = [&](std::size_t property) {
    std::size_t offset = 0;
    for (std::size_t p = 0; p < property; ++p) offset += size_of(vertex.properties[p].type);
    return offset;
  };
  records.count = vertex.count;
  records.stride = vertex.fixed_size();
  constexpr std::array names{"x", "y", "z"}, normals{"nx", "ny", "nz"};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto property = vertex.find(names[c]);
    if (!property) fail(in, std::string("its vertices have no property '") + names[c] + "'");
    records.at[c] = offset_of(*property);
    records.type[c] = vertex.properties[*property].type;
  }
  records.has_normals = std::ranges::all_of(normals, [&](const char* name) { return vertex.find(name).has_value(); });
}

}  // namespace

std::optional<PointRecords> ply_records(const Input& in) {
  const PlyHeader header = parse_ply_header(in);
  PointRecords records{.begin = header.body, .is_swapped = is_swapped(header.format)};
  for (const PlyElement& element : header.elements)
    if ((element.name == "face" || element.name == "tristrips") && element.count > 0)
      throw IoError("no_cloud", "cannot read " + quoted_path(in.path) + ": it has faces",
                    "only clouds of points can be streamed");
  if (header.format == PlyFormat::ascii) return std::nullopt;
  for (const PlyElement& element : header.elements) {
    if (element.has_list()) return std::nullopt;
    if (element.name == "vertex") {
      find_coordinates(in, element, records);
      return std::ranges::all_of(records.type, is_exact) ? std::optional(records) : std::nullopt;
    }
    records.begin += element.count * element.fixed_size();
  }
  fail(in, "it has no element 'vertex'");
}

}  // namespace ahm::io
