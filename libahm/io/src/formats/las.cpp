// This reader does not use a library: Debian 12 has no PDAL, LASlib or liblas. A LAS file is a header of fixed layout and point
// records of fixed size (ASPRS LAS specification 1.4 R15). The reader checks both against the file size.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ahm/util/text.hpp"
#include "formats/format.hpp"
#include "little_endian.hpp"
#include "read/columns.hpp"
#include "read/point_stream.hpp"

namespace ahm::io {
namespace {

/// A point data record format: its minimum size, and the offsets of classification and color, bytes.
struct Record {
  std::size_t size, classification, color;  ///< color 0: no color
};

constexpr std::array<Record, 11> records = {{{20, 15, 0},
                                             {28, 15, 0},
                                             {26, 15, 20},
                                             {34, 15, 28},
                                             {57, 15, 0},
                                             {63, 15, 28},
                                             {30, 16, 0},
                                             {36, 16, 30},
                                             {38, 16, 30},
                                             {59, 16, 0},
                                             {67, 16, 30}}};

constexpr std::size_t intensity_at = 12;
constexpr unsigned first_of_whole_classes = 6;  ///< in lower formats, the upper three bits of the class are flags

struct LasHeader {
  unsigned minor = 0, format = 0;
  std::uint64_t begin = 0, stride = 0, points = 0;
  Vec3 scale{}, offset{};
};

LasHeader parse_fields(const Input& in) {
  constexpr std::array<std::size_t, 5> header_sizes = {227, 227, 227, 235, 375};
  if (!in.bytes.starts_with("LASF")) fail_at_byte(in, 0, "a LAS file begins with 'LASF'");
  if (in.bytes.size() < header_sizes[0]) fail_at_byte(in, in.bytes.size(), "the file ends within its header");
  const auto major = load_at<std::uint8_t>(in.bytes, 24);
  LasHeader header;
  header.minor = load_at<std::uint8_t>(in.bytes, 25);
  if (major != 1 || header.minor > 4)
    fail_at_byte(
        in, 24,
        "LAS " + std::to_string(major) + "." + std::to_string(header.minor) + " is not supported; 1.0 to 1.4 are");
  const std::size_t size = load_at<std::uint16_t>(in.bytes, 94);
  if (size < header_sizes[header.minor])
    fail_at_byte(
        in, 94,
        "a header of " + detail::counted(size, "byte") + " is too small for LAS 1." + std::to_string(header.minor));
  header.begin = load_at<std::uint32_t>(in.bytes, 96);
  if (header.begin < size || header.begin > in.size())
    fail_at_byte(in, 96,
                 "the points cannot begin at byte " + std::to_string(header.begin) + " of " +
                     std::to_string(in.size()) + "; the file is cut short or damaged");
  header.format = load_at<std::uint8_t>(in.bytes, 104);
  header.stride = load_at<std::uint16_t>(in.bytes, 105);
  header.points = load_at<std::uint32_t>(in.bytes, 107);
  if (header.minor == 4) {
    const auto all = load_at<std::uint64_t>(in.bytes, 247);
    if (header.points != 0 && header.points != all)
      fail_at_byte(
          in, 107,
          "the header has two numbers of points: " + std::to_string(header.points) + " and " + std::to_string(all));
    header.points = all;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    header.scale[c] = load_at<double>(in.bytes, 131 + 8 * c);
    header.offset[c] = load_at<double>(in.bytes, 155 + 8 * c);
    if (!std::isfinite(header.scale[c]) || header.scale[c] == 0 || !std::isfinite(header.offset[c]))
      fail_at_byte(in, 131 + 8 * c,
                   "scale and offset of a coordinate are " + std::to_string(header.scale[c]) + " and " +
                       std::to_string(header.offset[c]));
  }
  return header;
}

LasHeader parse_header(const Input& in) {
  const LasHeader header = parse_fields(in);
  constexpr unsigned compressed = 0xC0;  // LASzip sets these bits
  if ((header.format & compressed) != 0)
    fail_at_byte(in, 104,
                 "the points are compressed (LAZ); convert the file with 'pdal translate FILE.laz FILE.las' or laszip");
  if (header.format >= records.size())
    fail_at_byte(in, 104, "point format " + std::to_string(header.format) + " is not supported; 0 to 10 are");
  if (header.stride < records[header.format].size)
    fail_at_byte(in, 105,
                 "records of " + detail::counted(header.stride, "byte") + " are too small for point format " +
                     std::to_string(header.format));
  check_vertex_count(in, header.points);
  const std::uint64_t left = in.size() - header.begin;
  if (header.points > left / header.stride)
    fail_at_byte(in, header.begin,
                 detail::counted(header.points, "point") + " of " + detail::counted(header.stride, "byte") +
                     " do not fit into the " + detail::counted(left, "byte") + " that follow; the file is cut short");
  return header;
}

/// Reads the colors, unless all are zero: writers without colors store zeros.
void read_colors(const Input& in, const LasHeader& header, std::size_t at, Geometry& g) {
  std::vector<Vec3> values(header.points);
  bool any = false;
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      values[i][c] = load_at<std::uint16_t>(in.bytes, header.begin + i * header.stride + at + 2 * c);
      any = any || values[i][c] != 0;
    }
  if (auto colors = any ? to_colors(values, true) : std::nullopt) g.colors = std::move(*colors);
}

/// A value per point beyond its format, as described in the file.
struct ExtraValue {
  std::string name;
  PlyType type = PlyType::uint8;
  std::size_t at = 0;  ///< offset in the record, bytes
  double scale = 1, offset = 0;
  std::optional<double> no_data = {};  ///< stored where there is no value
};

/// One description of extra bytes, of 192 bytes: type, options, name, "no data", scale and offset, the last three for up to three values.
/// @param at  offset of its bytes in the record. Increased by their size
void describe(std::string_view text, std::size_t& at, std::vector<ExtraValue>& values) {
  constexpr std::size_t name_at = 4, no_data_at = 40, scale_at = 112, offset_at = 136;
  enum : unsigned { has_no_data = 1, has_scale = 8, has_offset = 16 };
  constexpr std::array types = {PlyType::uint8, PlyType::int8,   PlyType::uint16, PlyType::int16,   PlyType::uint32,
                                PlyType::int32, PlyType::uint64, PlyType::int64,  PlyType::float32, PlyType::float64};
  const unsigned number = load_at<std::uint8_t>(text, 2), options = load_at<std::uint8_t>(text, 3);
  constexpr unsigned most_values = 3;
  if (number == 0 || number > most_values * types.size()) {  // bytes without a type; `options` is their number
    at += options;
    return;
  }
  const PlyType type = types[(number - 1) % types.size()];
  const std::size_t count = (number - 1) / types.size() + 1;
  const bool swap = std::endian::native == std::endian::big;
  const PlyType wide = !is_whole(type) ? PlyType::float64 : number % 2 == 0 ? PlyType::int64 : PlyType::uint64;
  const std::string name(text.substr(name_at, std::min<std::size_t>(32, text.substr(name_at).find('\0'))));
  for (std::size_t k = 0; k < count; ++k, at += size_of(type)) {
    ExtraValue& value = values.emplace_back(ExtraValue{count == 1 ? name : name + '_' + std::to_string(k), type, at});
    if ((options & has_no_data) != 0) value.no_data = load_value(wide, text.data() + no_data_at + 8 * k, swap);
    if ((options & has_scale) != 0) value.scale = load_at<double>(text, scale_at + 8 * k);
    if ((options & has_offset) != 0) value.offset = load_at<double>(text, offset_at + 8 * k);
  }
}

/// The values that the variable length record "LASF_Spec" 4 describes.
/// @param at  offset of the first extra byte; changed to the offset of the first byte without a description
std::vector<ExtraValue> extra_values(const Input& in, const LasHeader& header, std::size_t& at) {
  constexpr std::size_t head = 54, description = 192, most = 4096;  // most: limits the search for equal names
  constexpr std::string_view user("LASF_Spec\0", 10);
  const std::string_view bytes = std::string_view(in.bytes).substr(0, header.begin);
  std::vector<ExtraValue> values;
  std::size_t record = load_at<std::uint16_t>(bytes, 94);
  for (auto left = load_at<std::uint32_t>(bytes, 100); left > 0 && bytes.size() - record >= head; --left) {
    const std::size_t begin = record + head, length = load_at<std::uint16_t>(bytes, record + 20);
    if (length > bytes.size() - begin) break;
    const bool describes =
        bytes.substr(record + 2, user.size()) == user && load_at<std::uint16_t>(bytes, record + 18) == 4;
    for (std::size_t k = 0; describes && k + description <= length; k += description) {
      std::size_t end = at;
      const std::size_t known = values.size();
      describe(bytes.substr(begin + k, description), end, values);
      if (end > header.stride || values.size() > most) {
        values.resize(known, {});
        return values;
      }
      at = end;
    }
    record = begin + length;
  }
  return values;
}

/// Reads the extra bytes of the points as properties. Integers that doubles do not represent are ignored with a warning.
void read_extra(const Input& in, const LasHeader& header, Geometry& g) {
  std::size_t at = records[header.format].size;
  for (const ExtraValue& value : extra_values(in, header, at)) {
    std::vector<double> numbers(header.points);
    bool exact = true;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const double stored = load_value(value.type, in.bytes.data() + header.begin + i * header.stride + value.at,
                                       std::endian::native == std::endian::big);
      exact = exact && (is_exact(value.type) || std::abs(stored) < least_inexact);
      numbers[i] =
          stored == value.no_data ? std::numeric_limits<double>::quiet_NaN() : stored * value.scale + value.offset;
    }
    if (exact)
      add_property(g, value.name, std::move(numbers));
    else
      g.warnings.push_back({"element_ignored", {}, {}, value.name});
  }
  if (at < header.stride) g.warnings.push_back({"bytes_ignored", {static_cast<double>(header.stride - at)}, {}});
}

Geometry read(const Input& in) {
  const LasHeader header = parse_header(in);
  const Record& record = records[header.format];
  Geometry g;
  g.format = "LAS 1." + std::to_string(header.minor) + ", point format " + std::to_string(header.format);
  g.points.resize(header.points);
  Property intensity{"intensity", std::vector<double>(header.points)};
  Property classification{"classification", std::vector<double>(header.points)};
  for (std::size_t i = 0; i < g.points.size(); ++i) {
    const std::size_t at = header.begin + i * header.stride;
    for (std::size_t c = 0; c < 3; ++c)
      g.points[i][c] = load_at<std::int32_t>(in.bytes, at + 4 * c) * header.scale[c] + header.offset[c];
    intensity.values[i] = load_at<std::uint16_t>(in.bytes, at + intensity_at);
    const unsigned number = load_at<std::uint8_t>(in.bytes, at + record.classification);
    classification.values[i] = header.format < first_of_whole_classes ? number & 31u : number;
  }
  for (Property* property : {&intensity, &classification}) g.properties.push_back(std::move(*property));
  if (record.color != 0) read_colors(in, header, record.color, g);
  read_extra(in, header, g);
  return g;
}

}  // namespace

std::optional<PointRecords> las_records(const Input& in) {
  const LasHeader header = parse_header(in);
  PointRecords records{
      .begin = header.begin, .count = header.points, .stride = static_cast<std::size_t>(header.stride)};
  records.at = {0, 4, 8};
  records.type.fill(PlyType::int32);
  records.is_swapped = std::endian::native == std::endian::big;
  records.is_scaled = true;
  records.scale = header.scale;
  records.offset = header.offset;
  return records;
}

Format las_format() { return {.extensions = {".las"}, .signatures = {"LASF"}, .read = read, .records = las_records}; }

}  // namespace ahm::io
