#include "read/pcd_header.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "read/text.hpp"
#include "write/writers.hpp"

namespace ahm::io {
namespace {

using Words = std::vector<std::string_view>;

/// The header's lines by keyword, each allowed once.
struct RawHeader {
  Words fields, sizes, types, counts, viewpoint;
  std::optional<std::uint64_t> width, height, points;
  std::int64_t fields_line = 1;
};

std::uint64_t to_count(const Input& in, std::int64_t line, std::string_view word) {
  const std::int64_t value = whole_or_fail(in, line, word);
  if (value < 0) fail_at_line(in, line, "negative count " + std::to_string(value));
  return static_cast<std::uint64_t>(value);
}

PcdData to_data(const Input& in, std::int64_t line, std::string_view word) {
  if (word == "ascii") return PcdData::ascii;
  if (word == "binary") return PcdData::binary;
  if (word == "binary_compressed") return PcdData::compressed;
  fail_at_line(in, line, "unknown PCD data " + in_quotes(word) + "; expected ascii, binary or binary_compressed");
}

void set_once(const Input& in, std::int64_t line, const Words& words, Words& list) {
  if (!list.empty()) fail_at_line(in, line, in_quotes(words[0]) + " is given twice");
  list.assign(words.begin() + 1, words.end());
}

void set_once(const Input& in, std::int64_t line, const Words& words, std::optional<std::uint64_t>& number) {
  if (number || words.size() != 2) fail_at_line(in, line, in_quotes(words[0]) + " must be given once, with one number");
  number = to_count(in, line, words[1]);
}

void set_viewpoint(const Input& in, std::int64_t line, const Words& words, PcdHeader& header) {
  if (words.size() != header.viewpoint.size())
    fail_at_line(in, line, "VIEWPOINT must have seven numbers: x y z and a quaternion w x y z");
  for (std::size_t k = 0; k < words.size(); ++k) {
    header.viewpoint[k] = real_or_fail(in, line, words[k]);
  }
}

/// Reads up to and with the line DATA, which ends with "\n" because binary data may follow.
RawHeader read_lines(const Input& in, PcdHeader& header) {
  RawHeader raw;
  Words words;
  std::size_t position = 0;
  for (std::int64_t line = 1;; ++line) {
    const std::size_t end = in.bytes.find('\n', position);
    if (end == std::string::npos)
      fail_at_line(in, line, "the PCD header has no 'DATA' line; the file is cut short or no PCD file");
    split_words(std::string_view(in.bytes).substr(position, end - position), words);
    position = end + 1;
    if (words.empty() || words[0].starts_with('#') || words[0] == "VERSION") continue;
    if (words[0] == "FIELDS" || words[0] == "COLUMNS") {
      set_once(in, raw.fields_line = line, words, raw.fields);
    } else if (words[0] == "SIZE") {
      set_once(in, line, words, raw.sizes);
    } else if (words[0] == "TYPE") {
      set_once(in, line, words, raw.types);
    } else if (words[0] == "COUNT") {
      set_once(in, line, words, raw.counts);
    } else if (words[0] == "VIEWPOINT") {
      set_once(in, line, words, raw.viewpoint);
      set_viewpoint(in, line, raw.viewpoint, header);
    } else if (words[0] == "WIDTH") {
      set_once(in, line, words, raw.width);
    } else if (words[0] == "HEIGHT") {
      set_once(in, line, words, raw.height);
    } else if (words[0] == "POINTS") {
      set_once(in, line, words, raw.points);
    } else if (words[0] == "DATA" && words.size() == 2) {
      header.data = to_data(in, line, words[1]);
      header.body = position;
      header.body_line = line + 1;
      return raw;
    } else {
      fail_at_line(in, line, "unexpected " + in_quotes(words[0]) + " in the PCD header");
    }
  }
}

void set_fields(const Input& in, const RawHeader& raw, PcdHeader& header) {
  const std::size_t n = raw.fields.size();
  if (n == 0 || raw.sizes.size() != n || raw.types.size() != n || (!raw.counts.empty() && raw.counts.size() != n)) {
    fail_at_line(in, raw.fields_line, "FIELDS, SIZE, TYPE and COUNT must have the same number of entries");
  }
  constexpr std::uint64_t largest_point = 1 << 20;
  for (std::size_t k = 0; k < n; ++k) {
    PcdField field{std::string(raw.fields[k]), raw.types[k][0], to_count(in, raw.fields_line, raw.sizes[k]),
                   raw.counts.empty() ? 1 : to_count(in, raw.fields_line, raw.counts[k])};
    const bool whole =
        (field.type == 'I' || field.type == 'U') && std::ranges::count(std::array{1, 2, 4, 8}, int(field.size));
    const bool real = field.type == 'F' && (field.size == 4 || field.size == 8);
    if (raw.types[k].size() != 1 || field.size > 8 || !(whole || real)) {
      fail_at_line(in, raw.fields_line,
                   "field '" + field.name + "' has no known type: TYPE " + std::string(raw.types[k]) + " SIZE " +
                       std::to_string(field.size));
    }
    if (field.count == 0 || field.count > largest_point) {
      fail_at_line(in, raw.fields_line, "field '" + field.name + "' has COUNT " + std::to_string(field.count));
    }
    header.point_size += field.size * field.count;
    header.fields.push_back(std::move(field));
  }
  if (header.point_size > largest_point) fail_at_line(in, raw.fields_line, "a point of more than 1 MB");
}

void check_positions(const Input& in, const RawHeader& raw, const PcdHeader& header) {
  for (const char* name : {"x", "y", "z", "normal_x", "normal_y", "normal_z", "rgb", "rgba"}) {
    const auto found = std::ranges::count(header.fields, name, &PcdField::name);
    const bool position = name[1] == '\0';
    if (found > 1) fail_at_line(in, raw.fields_line, std::string("field '") + name + "' is given twice");
    if (position && found == 0) fail_at_line(in, raw.fields_line, std::string("there is no field '") + name + "'");
    const auto field = std::ranges::find(header.fields, name, &PcdField::name);
    if (position && field->count != 1)
      fail_at_line(in, raw.fields_line, std::string("field '") + name + "' has more than one value");
  }
}

/// WIDTH times HEIGHT and POINTS say the same; either can do without the other.
void set_points(const Input& in, const RawHeader& raw, PcdHeader& header) {
  if (!raw.width && !raw.points) fail_at_line(in, header.body_line - 1, "the PCD header has neither WIDTH nor POINTS");
  header.height = raw.width ? raw.height.value_or(1) : 1;
  header.width = raw.width ? *raw.width : *raw.points;
  if (__builtin_mul_overflow(header.width, header.height, &header.points) ||
      (raw.points && *raw.points != header.points)) {
    fail_at_line(in, header.body_line - 1,
                 "WIDTH " + std::to_string(header.width) + " times HEIGHT " + std::to_string(header.height) +
                     " is not POINTS " + std::to_string(raw.points.value_or(0)));
  }
  check_vertex_count(in, header.points);
}

[[noreturn]] void fail_size(const Input& in, const PcdHeader& header, std::uint64_t needed) {
  fail_at_byte(in, header.body,
               std::to_string(header.points) + " points of " + std::to_string(header.point_size) + " bytes need " +
                   std::to_string(needed) + " bytes, but only " + std::to_string(in.size() - header.body) +
                   " follow the header; the file is cut short");
}

}  // namespace

PcdHeader parse_pcd_header(const Input& in) {
  PcdHeader header;
  const RawHeader raw = read_lines(in, header);
  set_fields(in, raw, header);
  check_positions(in, raw, header);
  set_points(in, raw, header);
  return header;
}

void check_pcd_size(const Input& in, const PcdHeader& header) {
  const std::uint64_t plain = header.points * header.point_size;  // below 2^31 times 2^20
  if (plain > in.size() - header.body) fail_size(in, header, plain);
}

std::array<std::uint32_t, 2> pcd_sizes(const Input& in, const PcdHeader& header) {
  const std::uint64_t plain = header.points * header.point_size;
  if (std::ranges::find(header.fields, "_", &PcdField::name) != header.fields.end()) {
    // PCL's writer drops padding when it compresses, and its reader assumes that all do.
    fail_at_byte(in, header.body,
                 "compressed data with padding fields '_' has no agreed meaning; save it uncompressed");
  }
  std::array<std::uint32_t, 2> sizes{};  // compressed, plain
  const std::uint64_t left = in.size() - header.body;
  if (in.bytes.size() - header.body < sizeof sizes) fail_size(in, header, sizeof sizes);
  std::memcpy(sizes.data(), in.bytes.data() + header.body, sizeof sizes);
  if (sizes[0] > left - sizeof sizes) {
    fail_at_byte(in, header.body,
                 "the compressed size " + std::to_string(sizes[0]) + " exceeds the " +
                     std::to_string(left - sizeof sizes) + " bytes that follow; the file is cut short");
  }
  if (sizes[1] != plain) {
    fail_at_byte(in, header.body + 4,
                 "the uncompressed size " + std::to_string(sizes[1]) + " is not that of " +
                     std::to_string(header.points) + " points: " + std::to_string(plain));
  }
  // Three bytes of LZF stand for at most 264, so that a larger size cannot be true and need not be allocated.
  if (plain / 88 > sizes[0])
    fail_at_byte(in, header.body, "the compressed size " + std::to_string(sizes[0]) + " is too small");
  return sizes;
}

/// Every word must be a number and every line must have all of them: PCL takes "1,5" as 1 and 1e400 as infinity.
void read_pcd_text(const Input& in, const PcdHeader& header, Lines& lines,
                   const std::function<void(const std::vector<std::string_view>&)>& use) {
  if (header.points > in.size() - header.body) fail_size(in, header, 2 * header.points);
  std::uint64_t per_point = 0;
  for (const PcdField& field : header.fields) per_point += field.count;
  std::uint64_t point = 0;
  Words words;
  while (lines.next_filled()) {
    if (point++ == header.points)
      fail_at_line(in, lines.number(), "more lines than the " + std::to_string(header.points) + " points");
    split_words(lines.line(), words);
    for (std::string_view word : words) real_or_fail(in, lines.number(), word);
    if (words.size() != per_point) {
      fail_at_line(in, lines.number(),
                   "found " + std::to_string(words.size()) + " numbers, expected " + std::to_string(per_point));
    }
    use(words);
  }
  if (point < header.points) {
    fail_at_line(in, lines.number(),
                 "the file ends after " + std::to_string(point) + " of " + std::to_string(header.points) + " points");
  }
}

CheckedPcd check_pcd(const Input& in) {
  CheckedPcd checked{parse_pcd_header(in), {}};
  const PcdHeader& header = checked.header;
  if (header.data == PcdData::ascii) {
    Lines lines(std::string_view(in.bytes).substr(header.body), header.body_line);
    read_pcd_text(in, header, lines, [&](const Words& words) {
      for (std::string_view word : words) (checked.text += word) += ' ';
      checked.text.back() = '\n';
    });
  } else if (header.data == PcdData::binary) {
    check_pcd_size(in, header);
  } else {
    pcd_sizes(in, header);
  }
  return checked;
}

std::string full_header(const PcdHeader& header) {
  std::string fields = "FIELDS", sizes = "SIZE", types = "TYPE", counts = "COUNT";
  for (const PcdField& field : header.fields) {
    fields += " " + field.name;
    sizes += " " + std::to_string(field.size);
    types += std::string(" ") + field.type;
    counts += " " + std::to_string(field.count);
  }
  std::string viewpoint = "VIEWPOINT";
  for (const double number : header.viewpoint) append_decimals(viewpoint += ' ', number);
  constexpr std::array<const char*, 3> data = {"ascii", "binary", "binary_compressed"};
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + fields + "\n" + sizes + "\n" + types + "\n" +
         counts + "\nWIDTH " + std::to_string(header.width) + "\nHEIGHT " + std::to_string(header.height) + "\n" +
         viewpoint + "\nPOINTS " + std::to_string(header.points) + "\nDATA " +
         data[static_cast<std::size_t>(header.data)] + "\n";
}

}  // namespace ahm::io
