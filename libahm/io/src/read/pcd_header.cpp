// Headers of PCD files, and points of PCD files that are text or compressed.
#include "read/pcd_header.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>

#include "ahm/util/from_chars.hpp"
#include "ahm/util/text.hpp"
#include "read/point_stream.hpp"
#include "write/writers.hpp"

namespace ahm::io {

/// Unpacks LZF data in blocks.
class LzfStream {
 public:
  /// @param begin   position of the data in the file, bytes
  /// @param packed  compressed size, bytes
  /// @param plain   unpacked size, bytes
  LzfStream(const ByteStream& file, std::uint64_t begin, std::uint64_t packed, std::uint64_t plain);

  /// Fills `room` with the next unpacked bytes. @throws IoError if the data is damaged
  void read(std::span<char> room);
  /// Skips unpacked bytes.
  void skip(std::uint64_t bytes);
  /// Checks that the data ends here. @throws IoError
  void finish();

 private:
  bool unpack();
  unsigned char next();
  [[noreturn]] void damaged() const;

  ByteStream file_;
  std::string packed_, plain_;              ///< current blocks
  std::size_t at_packed_ = 0, at_ = 0;      ///< positions in the blocks
  std::uint64_t packed_left_, plain_left_;  ///< bytes after the blocks
};

/// 0 for the field x, 1 for y, 2 for z; nullopt for other fields.
std::optional<std::size_t> axis_of(const PcdField& field);
bool has_normals(const PcdHeader& header);
/// The layout of uncompressed points. @throws IoError (unsupported types)
PointRecords records_of(const Input& in, const PcdHeader& header);

namespace {

constexpr std::size_t block = std::size_t{1} << 18, window = 8192;  // window: maximum distance of a back reference

}  // namespace

LzfStream::LzfStream(const ByteStream& file, std::uint64_t begin, std::uint64_t packed, std::uint64_t plain)
    : file_(file, begin), packed_left_(packed), plain_left_(plain) {
  plain_.reserve(window + block);
}

void LzfStream::damaged() const { fail(file_.head(), "its compressed data (LZF) is damaged"); }

unsigned char LzfStream::next() {
  if (at_packed_ == packed_.size()) {
    packed_.resize(std::min<std::uint64_t>(block, packed_left_));
    if (packed_.empty() || file_.read(packed_) < packed_.size()) damaged();
    packed_left_ -= packed_.size();
    at_packed_ = 0;
  }
  return static_cast<unsigned char>(packed_[at_packed_++]);
}

/// Unpacks the next block after the last `window` bytes. @return false at the end
bool LzfStream::unpack() {
  if (plain_left_ == 0) return false;
  if (plain_.size() > window) plain_.erase(0, plain_.size() - window);
  at_ = plain_.size();
  constexpr std::size_t longest = 264;  // length of a back reference
  while (plain_left_ > 0 && plain_.size() - at_ + longest < block) {
    const unsigned control = next();
    if (control < 32) {  // literal bytes
      if (control + 1 > plain_left_) damaged();
      plain_left_ -= control + 1;
      for (unsigned k = 0; k <= control; ++k) plain_ += static_cast<char>(next());
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) length += next();
    length += 2;
    const std::size_t back = ((control & 31U) << 8) + next() + 1;
    if (back > plain_.size() || length > plain_left_) damaged();
    plain_left_ -= length;
    for (; length > 0; --length) plain_ += plain_[plain_.size() - back];
  }
  return true;
}

void LzfStream::read(std::span<char> room) {
  while (!room.empty()) {
    if (at_ == plain_.size() && !unpack()) damaged();
    const std::size_t count = std::min(room.size(), plain_.size() - at_);
    std::copy_n(plain_.data() + at_, count, room.data());
    at_ += count;
    room = room.subspan(count);
  }
}

void LzfStream::skip(std::uint64_t bytes) {
  while (bytes > 0) {
    if (at_ == plain_.size() && !unpack()) damaged();
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, plain_.size() - at_));
    at_ += count;
    bytes -= count;
  }
}

void LzfStream::finish() {
  if (at_ != plain_.size() || plain_left_ > 0 || packed_left_ > 0 || at_packed_ != packed_.size()) damaged();
}

namespace {

using Words = std::vector<std::string_view>;

/// The lines of the header by keyword. Each keyword may appear once.
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
  if (!list.empty()) fail_at_line(in, line, in_quotes(words[0]) + " appears twice");
  list.assign(words.begin() + 1, words.end());
}

void set_once(const Input& in, std::int64_t line, const Words& words, std::optional<std::uint64_t>& number) {
  if (number || words.size() != 2) fail_at_line(in, line, in_quotes(words[0]) + " must appear once, with one number");
  number = to_count(in, line, words[1]);
}

void set_viewpoint(const Input& in, std::int64_t line, const Words& words, PcdHeader& header) {
  if (words.size() != header.viewpoint.size())
    fail_at_line(in, line, "VIEWPOINT must have seven numbers: x y z and a quaternion w x y z");
  for (std::size_t k = 0; k < words.size(); ++k) {
    header.viewpoint[k] = real_or_fail(in, line, words[k]);
  }
}

/// Reads the header up to the line DATA. The end of the first line determines whether lines end with a lone "\r"; binary data follows.
RawHeader read_lines(const Input& in, PcdHeader& header) {
  RawHeader raw;
  Words words;
  std::size_t position = 0;
  const std::size_t first = in.bytes.find_first_of("\r\n");
  const char end_of_line =
      first != std::string::npos && in.bytes.compare(first, 2, "\r\n") != 0 ? in.bytes[first] : '\n';
  for (std::int64_t line = 1;; ++line) {
    const std::size_t end = in.bytes.find(end_of_line, position);
    if (end == std::string::npos)
      fail_at_line(in, line, "the PCD header has no 'DATA' line; the file is cut short or not a PCD file");
    const std::string_view text = std::string_view(in.bytes).substr(position, end - position);
    split_words(text, words);
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
      if (words[0] == "DATA" || has_control_characters(text))
        fail_at_line(in, line, "unexpected " + in_quotes(words[0]) + " in the PCD header");
      header.skipped.add(line, text);
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
    if (field.count > largest_point)
      fail_at_line(in, raw.fields_line, "field '" + field.name + "' has COUNT " + std::to_string(field.count));
    if (field.count == 0) continue;
    header.point_size += field.size * field.count;
    header.fields.push_back(std::move(field));
  }
  if (header.point_size > largest_point) fail_at_line(in, raw.fields_line, "a point is larger than 1 MB");
}

void check_positions(const Input& in, const RawHeader& raw, const PcdHeader& header) {
  for (const char* name : {"x", "y", "z", "normal_x", "normal_y", "normal_z", "rgb", "rgba"}) {
    const auto found = std::ranges::count(header.fields, name, &PcdField::name);
    const bool position = name[1] == '\0';
    if (found > 1) fail_at_line(in, raw.fields_line, std::string("field '") + name + "' appears twice");
    if (position && found == 0) fail_at_line(in, raw.fields_line, std::string("there is no field '") + name + "'");
    const auto field = std::ranges::find(header.fields, name, &PcdField::name);
    if (position && field->count != 1)
      fail_at_line(in, raw.fields_line, std::string("field '") + name + "' has more than one value");
  }
}

/// Sets the number of points. WIDTH times HEIGHT must equal POINTS; either may be missing.
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
               detail::counted(header.points, "point") + " of " + detail::counted(header.point_size, "byte") +
                   " need " + detail::counted(needed, "byte") + ", but only " +
                   std::to_string(in.size() - header.body) + " follow the header; the file is cut short");
}

}  // namespace

namespace {

/// Drops padding fields that compressed data does not contain. PCL's writer leaves them out, others do not: the uncompressed size
/// that precedes the data decides.
void drop_padding(const Input& in, PcdHeader& header) {
  const auto is_padding = [](const PcdField& field) { return field.name == "_"; };
  std::uint64_t padding = 0;
  for (const PcdField& field : header.fields)
    if (is_padding(field)) padding += field.size * field.count;
  std::array<std::uint32_t, 2> sizes{};  // compressed, uncompressed
  if (padding == 0 || in.bytes.size() - header.body < sizeof sizes) return;
  std::memcpy(sizes.data(), in.bytes.data() + header.body, sizeof sizes);
  if (sizes[1] != header.points * (header.point_size - padding)) return;
  std::erase_if(header.fields, is_padding);
  header.point_size -= padding;
}

}  // namespace

PcdHeader parse_pcd_header(const Input& in) {
  PcdHeader header;
  const RawHeader raw = read_lines(in, header);
  set_fields(in, raw, header);
  check_positions(in, raw, header);
  set_points(in, raw, header);
  if (header.data == PcdData::compressed) drop_padding(in, header);
  return header;
}

void check_pcd_size(const Input& in, const PcdHeader& header) {
  const std::uint64_t plain = header.points * header.point_size;  // no overflow: less than 2^31 * 2^20
  const std::uint64_t left = in.size() - header.body;
  if (plain > left) fail_size(in, header, plain);
  if (!header.skipped.empty() && plain != left)
    fail_at_byte(in, header.body,
                 "the points need " + detail::counted(plain, "byte") + ", but " + std::to_string(left) +
                     " follow the header, which may be damaged" + header.skipped.hint());
}

std::array<std::uint32_t, 2> pcd_sizes(const Input& in, const PcdHeader& header) {
  const std::uint64_t plain = header.points * header.point_size;
  std::array<std::uint32_t, 2> sizes{};  // compressed, uncompressed
  const std::uint64_t left = in.size() - header.body;
  if (in.bytes.size() - header.body < sizeof sizes) fail_size(in, header, sizeof sizes);
  std::memcpy(sizes.data(), in.bytes.data() + header.body, sizeof sizes);
  if (sizes[0] > left - sizeof sizes) {
    fail_at_byte(in, header.body,
                 "the compressed size " + std::to_string(sizes[0]) + " exceeds the " +
                     detail::counted(left - sizeof sizes, "byte") + " that follow; the file is cut short");
  }
  if (sizes[1] != plain) {
    fail_at_byte(in, header.body + 4,
                 "the uncompressed size " + std::to_string(sizes[1]) + " is not that of " +
                     detail::counted(header.points, "point") + ": " + std::to_string(plain));
  }
  // Three bytes of LZF unpack to at most 264 bytes. Reject larger sizes before allocating memory for them.
  if (plain / 88 > sizes[0])
    fail_at_byte(in, header.body, "the compressed size " + std::to_string(sizes[0]) + " is too small");
  return sizes;
}

/// Checks every word, because PCL reads "1,5" as 1 and 1e400 as infinity.
void read_pcd_text(const Input& in, const PcdHeader& header, Lines& lines,
                   const std::function<void(const std::vector<std::string_view>&)>& use) {
  if (header.points > in.size() - header.body) fail_size(in, header, 2 * header.points);
  std::uint64_t per_point = 0;
  for (const PcdField& field : header.fields) per_point += field.count;
  std::uint64_t point = 0;
  Words words;
  while (lines.next_data('#')) {
    if (point++ == header.points)
      fail_at_line(in, lines.number(), "the file has more lines than points (" + std::to_string(header.points) + ")");
    split_words(lines.line(), words);
    for (std::string_view word : words) real_or_fail(in, lines.number(), word);
    if (words.size() != per_point) {
      fail_at_line(in, lines.number(),
                   "expected " + detail::counted(per_point, "number") + ", found " + std::to_string(words.size()));
    }
    use(words);
  }
  if (point < header.points) {
    fail_at_line(in, lines.number(),
                 "the file ends after " + std::to_string(point) + " of " + detail::counted(header.points, "point"));
  }
}

CheckedPcd check_pcd(const Input& in) {
  CheckedPcd checked{parse_pcd_header(in), {}};
  const PcdHeader& header = checked.header;
  if (header.data == PcdData::ascii) {
    Lines lines(std::string_view(in.bytes).substr(header.body), header.body_line);
    lines.skipped() = header.skipped;
    read_pcd_text(in, header, lines, [&](const Words& words) {
      for (std::string_view word : words) (checked.text += word) += ' ';
      checked.text.back() = '\n';
    });
    checked.header.skipped = lines.skipped();
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
    // In compressed data, PCL expects no padding: a name makes it an ordinary field.
    fields += field.name == "_" && header.data == PcdData::compressed ? " padding" : " " + field.name;
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

namespace {

/// The word as a number, converted to the type of the field. Fails if the type cannot represent it.
double value_in(const Input& in, std::int64_t line, const PcdField& field, std::string_view word) {
  const double value = to_real(word).value();
  if (field.type != 'F') {
    const auto whole = static_cast<double>(whole_or_fail(in, line, word));
    const double values = std::scalbn(1.0, 8 * static_cast<int>(field.size)),
                 least = field.type == 'U' ? 0 : -values / 2;
    if (whole < least || whole >= least + values)
      fail_at_line(in, line, in_quotes(word) + " does not fit into field '" + field.name + "'");
    return whole;
  }
  if (field.size == 8) return value;
  if (word.starts_with('+')) word.remove_prefix(1);
  float rounded = 0;
  const auto [end, error] = detail::from_chars(word.data(), word.data() + word.size(), rounded);
  return error == std::errc{} ? rounded : static_cast<float>(value);  // outside the range of floats: infinity or zero
}

void take_text(const ByteStream& file, const PcdHeader& header, const TakePoint& take) {
  std::array<const PcdField*, 3> fields{};
  std::array<std::size_t, 3> columns{};
  std::size_t column = 0;
  for (const PcdField& field : header.fields) {
    if (const auto axis = axis_of(field)) fields[*axis] = &field, columns[*axis] = column;
    column += field.count;
  }
  Lines lines(file, header.body, header.body_line);
  read_pcd_text(file.head(), header, lines, [&](const std::vector<std::string_view>& words) {
    Vec3 point;
    for (std::size_t c = 0; c < 3; ++c) point[c] = value_in(file.head(), lines.number(), *fields[c], words[columns[c]]);
    take(point);
  });
}

/// Compressed data contains the values field by field. Three streams unpack it in parallel, one at each of x, y and z.
void take_compressed(const ByteStream& file, const PcdHeader& header, const PointRecords& records,
                     const TakePoint& take) {
  const auto sizes = pcd_sizes(file.head(), header);
  if (header.points == 0) return;
  const std::uint64_t begin = header.body + sizeof sizes;
  const auto unpacked = [&] { return LzfStream(file, begin, sizes[0], sizes[1]); };
  std::array<LzfStream, 3> columns{unpacked(), unpacked(), unpacked()};
  for (std::size_t c = 0; c < 3; ++c) columns[c].skip(records.at[c] * header.points);
  for (std::uint64_t i = 0; i < header.points; ++i) {
    Vec3 point;
    for (std::size_t c = 0; c < 3; ++c) {
      std::array<char, 8> bytes;
      columns[c].read(std::span(bytes).first(size_of(records.type[c])));
      point[c] = load_value(records.type[c], bytes.data(), records.is_swapped);
    }
    take(point);
  }
  const std::size_t last = std::ranges::max_element(records.at) - records.at.begin();
  columns[last].skip(header.points * (header.point_size - records.at[last] - size_of(records.type[last])));
  columns[last].finish();
}

}  // namespace

bool take_pcd_points(const ByteStream& file, const TakePoint& take) {
  const PcdHeader header = parse_pcd_header(file.head());
  if (header.data == PcdData::ascii)
    take_text(file, header, take);
  else
    take_compressed(file, header, records_of(file.head(), header), take);
  return has_normals(header);
}

namespace {

/// The type of a field; nullopt for integers of 8 bytes.
std::optional<PlyType> type_of(const PcdField& field) {
  constexpr PlyType whole[] = {PlyType::int8, PlyType::int16, PlyType::int32},
                    natural[] = {PlyType::uint8, PlyType::uint16, PlyType::uint32};
  if (field.type == 'F') return field.size == 4 ? PlyType::float32 : PlyType::float64;
  if (field.size == 8) return std::nullopt;
  return (field.type == 'I' ? whole : natural)[field.size / 2];
}

}  // namespace

std::optional<std::size_t> axis_of(const PcdField& field) {
  const auto axis = std::string("xyz").find(field.name);
  return field.name.size() == 1 && axis != std::string::npos ? std::optional(axis) : std::nullopt;
}

bool has_normals(const PcdHeader& header) {
  return std::ranges::count_if(header.fields, [](const PcdField& field) {
           return field.name.size() == 8 && field.name.starts_with("normal_");
         }) == 3;
}

PointRecords records_of(const Input& in, const PcdHeader& header) {
  PointRecords records{.begin = header.body, .count = header.points, .has_normals = has_normals(header)};
  records.is_swapped = std::endian::native == std::endian::big;
  for (const PcdField& field : header.fields) {
    if (const auto axis = axis_of(field)) {
      const auto type = type_of(field);
      if (!type) fail(in, "its coordinates are integers of 8 bytes; convert them to floats");
      records.at[*axis] = records.stride;
      records.type[*axis] = *type;
    }
    records.stride += field.size * field.count;
  }
  return records;
}

std::optional<PointRecords> pcd_records(const Input& in) {
  const PcdHeader header = parse_pcd_header(in);
  if (header.data != PcdData::binary) return std::nullopt;
  check_pcd_size(in, header);
  return records_of(in, header);
}

}  // namespace ahm::io
