// Points of PCD files that are text or compressed, one after the other.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include "read/lzf.hpp"
#include "read/pcd_records.hpp"

namespace ahm::io {
namespace {

/// As a number of the field's own type, which must hold it.
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
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), rounded);
  return error == std::errc{} ? rounded : static_cast<float>(value);  // beyond all floats: infinite or zero
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

/// The values of a field stand together, those of one field after those of another: the data is unpacked at three places at once.
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

}  // namespace ahm::io
