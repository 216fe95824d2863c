// Plain columns of numbers have no standard and no library; every line must have as many columns as the first one.
#include "read/columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "read/text.hpp"

namespace ahm::io {
namespace {

using Words = std::vector<std::string_view>;

/// Which column holds x, y, z and, when there are six, what the other three are.
struct Columns {
  std::size_t count = 0;  ///< in every line
  std::array<std::size_t, 6> of = {0, 1, 2, 3, 4, 5};
  bool six = false;
};

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\"");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\"") - begin + 1);
}

/// Between delimiters; a blank delimiter stands for any run of blanks and tabs.
void split(std::string_view line, char delimiter, Words& words) {
  if (delimiter == ' ') return split_words(line, words);
  words.clear();
  for (;;) {
    const std::size_t end = line.find(delimiter);
    words.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

void read_row(const Input& in, std::int64_t line, const Words& words, const Columns& columns, Geometry& g) {
  if (words.size() != columns.count) {
    fail_at_line(in, line,
                 std::to_string(words.size()) + " columns, but the lines before have " + std::to_string(columns.count));
  }
  std::array<double, 6> row{};
  for (std::size_t k = 0; k < (columns.six ? 6 : 3); ++k) row[k] = real_or_fail(in, line, words[columns.of[k]]);
  g.points.push_back({row[0], row[1], row[2]});
  if (columns.six) g.normals.push_back({row[3], row[4], row[5]});
}

/// Six columns are often x y z red green blue: whole numbers up to 255 cannot all be meant as normals when one
/// exceeds 1.
void tell_colors_from_normals(Geometry& g) {
  const auto is_level = [](double v) { return v >= 0 && v <= 255 && v == std::floor(v); };
  const auto all_levels = [&](const Vec3& n) { return std::ranges::all_of(n, is_level); };
  const auto too_long = [](const Vec3& n) { return *std::ranges::max_element(n) > 1; };
  if (!std::ranges::all_of(g.normals, all_levels) || !std::ranges::any_of(g.normals, too_long)) return;
  g.colors.reserve(g.normals.size());
  for (const Vec3& n : g.normals) {
    g.colors.push_back(
        {static_cast<std::uint8_t>(n[0]), static_cast<std::uint8_t>(n[1]), static_cast<std::uint8_t>(n[2])});
  }
  g.normals.clear();
  g.warnings.push_back({"columns_as_colors", {}, {}});
}

Geometry read_rows(const Input& in, Lines& lines, char delimiter, Columns columns, Geometry g) {
  Words words;
  do {
    split(lines.line(), delimiter, words);
    if (columns.count == 0) {
      columns.count = words.size();
      columns.six = words.size() == 6;
      if (words.size() < 3) {
        fail_at_line(in, lines.number(), "expected at least three columns, found " + std::to_string(words.size()));
      }
      if (words.size() > 3 && !columns.six) {
        g.warnings.push_back({"columns_ignored", {static_cast<double>(words.size())}, {}});
      }
    }
    read_row(in, lines.number(), words, columns, g);
  } while (lines.next_filled('#'));
  check_vertex_count(in, g.points.size());
  if (columns.six) tell_colors_from_normals(g);
  return g;
}

/// The delimiter that can be told from the first line; semicolon first, because commas may then be (refused) decimals.
char find_delimiter(std::string_view line) {
  for (char delimiter : {';', ',', '\t'}) {
    if (line.find(delimiter) != std::string_view::npos) return delimiter;
  }
  return ' ';
}

/// Columns by their names in the first line; nullopt when that line holds numbers.
std::optional<Columns> named_columns(const Input& in, std::int64_t line, const Words& words) {
  if (words.empty() || std::ranges::any_of(words, [](std::string_view w) { return to_real(w).has_value(); }))
    return std::nullopt;
  static constexpr std::array<std::string_view, 6> names = {"x", "y", "z", "nx", "ny", "nz"};
  Columns columns;
  columns.count = words.size();
  std::size_t found = 0;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto is_name = [&](std::string_view w) { return equals_ignoring_case(w, names[k]); };
    const auto at = std::ranges::find_if(words, is_name);
    if (std::ranges::count_if(words, is_name) > 1) {
      fail_at_line(in, line, "two columns are named '" + std::string(names[k]) + "'");
    }
    if (at == words.end() && k < 3) fail_at_line(in, line, "no column is named '" + std::string(names[k]) + "'");
    if (at == words.end()) continue;
    columns.of[k] = static_cast<std::size_t>(at - words.begin());
    ++found;
  }
  columns.six = found == names.size();
  return columns;
}

}  // namespace

Geometry read_blank_separated(const Input& in) {
  Lines lines(without_byte_order_mark(in.bytes));
  if (!lines.next_filled('#')) fail(in, "the file holds no point");
  Geometry g;
  g.format = "XYZ text";
  return read_rows(in, lines, ' ', {}, std::move(g));
}

Geometry read_delimited(const Input& in) {
  Lines lines(without_byte_order_mark(in.bytes));
  if (!lines.next_filled('#')) fail(in, "the file holds no point");
  Geometry g;
  g.format = "CSV text";
  const char delimiter = find_delimiter(lines.line());
  Words words;
  split(lines.line(), delimiter, words);
  const std::optional<Columns> columns = named_columns(in, lines.number(), words);
  if (columns && !lines.next_filled('#')) fail(in, "the file holds no point below the column names");
  return read_rows(in, lines, delimiter, columns.value_or(Columns{}), std::move(g));
}

}  // namespace ahm::io
