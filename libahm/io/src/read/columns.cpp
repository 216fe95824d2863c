// There is no standard and no library for columns of numbers. Every line must have as many columns as the first one.
#include "read/columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "ahm/util/text.hpp"
#include "read/text.hpp"

namespace ahm::io {

enum class ColumnRole { unknown, normals, colors };

struct ColumnNames {
  std::array<std::size_t, 3> position;  ///< columns of x, y, z
  std::vector<std::pair<ColumnRole, std::array<std::size_t, 3>>> triples;
};

/// Whether the words include "x", "y" and "z", in any case.
bool names_position(const std::vector<std::string_view>& words);

/// Finds the columns x y z; nx ny nz; red green blue, r g b, or rf gf bf, in any case and order.
/// @throws IoError if one of x, y, z is missing, or one of these names appears twice
ColumnNames find_columns(const Input& in, std::int64_t line, const std::vector<std::string_view>& words);

std::optional<std::vector<Color>> to_colors(const std::vector<Vec3>& values, bool deep) {
  double largest = 0;
  bool positive = true, whole = true;
  for (const Vec3& color : values)
    for (const double x : color) {
      positive = positive && x >= 0;
      whole = whole && x == std::floor(x);
      largest = std::max(largest, x);
    }
  const bool fractions = largest <= 1;
  if (!positive || !(fractions || whole) || largest > (deep ? 65535 : 255)) return std::nullopt;
  const double scale = fractions ? 255 : largest <= 255 ? 1 : 255.0 / 65535;
  std::vector<Color> colors(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) colors[i][c] = static_cast<std::uint8_t>(std::lround(scale * values[i][c]));
  return colors;
}

namespace {

using Words = std::vector<std::string_view>;
using Names = std::array<std::string_view, 3>;

constexpr Names position = {"x", "y", "z"};
constexpr std::pair<ColumnRole, Names> others[] = {
    {ColumnRole::normals, {"nx", "ny", "nz"}},
    {ColumnRole::colors, {"red", "green", "blue"}},
    {ColumnRole::colors, {"r", "g", "b"}},
    {ColumnRole::colors, {"rf", "gf", "bf"}},
};

auto has_name(std::string_view name) {
  return [name](std::string_view word) { return equals_ignoring_case(word, name); };
}

std::optional<std::array<std::size_t, 3>> find(const Input& in, std::int64_t line, const Words& words,
                                               const Names& names) {
  std::array<std::size_t, 3> columns{};
  bool complete = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at = std::ranges::find_if(words, has_name(names[k]));
    if (std::ranges::count_if(words, has_name(names[k])) > 1)
      fail_at_line(in, line, "two columns are named '" + std::string(names[k]) + "'");
    complete = complete && at != words.end();
    columns[k] = static_cast<std::size_t>(at - words.begin());
  }
  return complete ? std::optional(columns) : std::nullopt;
}

}  // namespace

bool names_position(const Words& words) {
  return std::ranges::all_of(position, [&](auto name) { return std::ranges::any_of(words, has_name(name)); });
}

ColumnNames find_columns(const Input& in, std::int64_t line, const Words& words) {
  for (const std::string_view name : position)
    if (std::ranges::none_of(words, has_name(name)))
      fail_at_line(in, line, "no column is named '" + std::string(name) + "'");
  ColumnNames result{*find(in, line, words, position), {}};
  for (const auto& [role, names] : others) {
    const auto same = [role = role](const auto& triple) { return triple.first == role; };
    if (std::ranges::any_of(result.triples, same)) continue;
    if (const auto columns = find(in, line, words, names)) result.triples.emplace_back(role, *columns);
  }
  return result;
}

void add_property(Geometry& g, const std::string& name, std::vector<double> values) {
  std::string plain;
  for (const char c : name) {
    const bool fit = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    plain += fit ? c : '_';
  }
  if (plain.empty()) plain = "property";
  const auto taken = [&](const std::string& other) {
    return std::ranges::find(g.properties, other, &Property::name) != g.properties.end();
  };
  std::string own = plain;
  for (int number = 2; taken(own); ++number) own = plain + '_' + std::to_string(number);
  g.properties.push_back({std::move(own), std::move(values)});
}

namespace {

using Words = std::vector<std::string_view>;

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\"");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\"") - begin + 1);
}

/// Splits a line at a delimiter. The delimiter ' ' stands for any run of blanks and tabs.
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

/// Whether the delimiter separates the numbers: no column may contain two numbers, as in "1,5 2,5 3,5" with commas.
bool separates(std::string_view line, char delimiter, Words& words) {
  if (line.find(delimiter) == std::string_view::npos) return false;
  split(line, delimiter, words);
  return std::ranges::none_of(words, [](std::string_view column) {
    const std::string_view first = next_word(column), second = next_word(column);
    return to_real(first) && to_real(second);
  });
}

/// The delimiter of a line. Semicolons have priority, because commas are then decimal commas (an error).
char find_delimiter(std::string_view line, const ColumnDialect& dialect) {
  Words words;
  if (line.find(';') != std::string_view::npos) return ';';
  if (separates(line, ',', words)) return ',';
  return dialect.tabs_separate && line.find('\t') != std::string_view::npos ? '\t' : ' ';
}

/// Decides whether vectors are colors: all values are whole numbers up to 255, and one exceeds 1, unlike normals.
class LevelTest {
 public:
  void add(const Vec3& value) {
    all_levels_ = all_levels_ && std::ranges::all_of(value, is_level);
    too_long_ = too_long_ || *std::ranges::max_element(value) > 1;
  }
  bool are_levels() const { return all_levels_ && too_long_; }

 private:
  static bool is_level(double v) { return v >= 0 && v <= 255 && v == std::floor(v); }

  bool all_levels_ = true, too_long_ = false;
};

class ColumnReader {
 public:
  /// @param take  receives every point, and nothing is stored; null: everything is stored
  ColumnReader(const Input& in, Lines&& lines, const ColumnDialect& dialect, const TakePoint* take = nullptr)
      : in_(in), dialect_(dialect), take_(take), lines_(std::move(lines)) {}

  Geometry read() {
    read_rows();
    keep();
    return std::move(g_);
  }

  /// Reads all points and passes them to the callback. @return whether the points have normals
  bool take() {
    read_rows();
    return std::ranges::any_of(triples_, [](const Triple& t) { return t.role == ColumnRole::normals; });
  }

 private:
  void read_rows() {
    g_.format = dialect_.format;
    while (next_line()) {
      if (begins_block()) continue;
      if (columns_ == 0 && named_columns()) continue;
      read_row();
    }
    skip_title();
    if (count_ == 0)
      fail(in_,
           (names_line_ > 0 ? "the file contains no points below the column names" : "the file contains no points") +
               lines_.skipped().hint());
    if (left_.value_or(0) > 0)
      fail_at_line(in_, lines_.number(),
                   "the file ends before the announced number of points; missing: " + std::to_string(*left_));
    check_vertex_count(in_, count_);
    choose_roles();
  }

  /// Three columns that form a vector.
  struct Triple {
    ColumnRole role;
    std::array<std::size_t, 3> columns;
    LevelTest levels = {};
    std::vector<Vec3> values = {};
  };

  /// A named column that is not part of a vector.
  struct Other {
    std::size_t column;
    std::string name;
    std::vector<double> values = {};
    bool is_numbers = true;
  };

  /// Moves to the next line of data. Lines of names may be comments: // always, # if there is a name for every column.
  bool next_line() {
    while (lines_.next_filled()) {
      line_ = trimmed(without_comment(lines_.line(), '#'));
      if (line_.starts_with("//")) {
        line_.remove_prefix(2);
        if (!has_columns() && are_names(line_)) return true;
      } else if (const std::string_view whole = trimmed(lines_.line()); line_.empty() && whole.starts_with('#')) {
        if (!has_columns() && are_names(whole.substr(1))) keep_title(whole.substr(1));
      } else if (is_remark(line_) && !begins_with_empty_column()) {
        lines_.skipped().add(lines_.number(), line_);
      } else {
        return true;
      }
    }
    return false;
  }

  bool has_columns() const { return columns_ > 0; }

  bool are_names(std::string_view line) {
    split(line, find_delimiter(line, dialect_), words_);
    return names_position(words_);
  }

  /// Whether a line that begins with a semicolon is a row whose first column is empty, rather than a remark.
  bool begins_with_empty_column() const {
    return line_.starts_with(';') && (delimiter_ == ';' || line_.find(';', 1) != std::string_view::npos);
  }

  /// Whether the line is a single whole number: the number of points that follow.
  bool begins_block() {
    if (line_.find_first_of(" \t,;") != std::string_view::npos || (left_ ? *left_ > 0 : count_ > 0)) return false;
    const std::optional<std::int64_t> count = to_whole(line_);
    if (!count || *count < 0) return false;
    left_ = *count;
    return true;
  }

  /// Whether the line contains the names of the columns, or is a title.
  bool named_columns() {
    const char delimiter = find_delimiter(line_, dialect_);
    split(line_, delimiter, words_);
    const auto numbers = std::ranges::count_if(words_, is_like_number);
    const auto empty = std::ranges::count(words_, std::string_view{});
    if (numbers > 0 || !names_position(words_)) {
      const auto others = std::ssize(words_) - numbers - empty;
      const bool is_point = numbers >= 3 || others < std::max<std::ptrdiff_t>(numbers, 1);
      if (is_point || has_control_characters(line_)) return false;
      keep_title(line_);
      return true;
    }
    use_names(lines_.number(), delimiter);
    return true;
  }

  /// Assigns the columns with the names in `words_`.
  void use_names(std::int64_t line, char delimiter) {
    skip_title();
    const ColumnNames names = find_columns(in_, line, words_);
    columns_ = words_.size();
    position_ = names.position;
    for (const auto& [role, columns] : names.triples) triples_.push_back({role, columns});
    for (std::size_t column = 0; column < columns_; ++column)
      if (!is_taken(column)) others_.push_back({column, std::string(words_[column])});
    if (delimiter != ' ') delimiter_ = delimiter;
    names_line_ = line;
  }

  /// Keeps a line before the first point until the number of columns is known: only then can it be a title or the names.
  void keep_title(std::string_view line) {
    skip_title();
    title_ = line;
    title_line_ = lines_.number();
    title_is_comment_ = trimmed(lines_.line()).starts_with('#');
  }

  void skip_title() {
    if (title_line_ > 0 && !title_is_comment_) lines_.skipped().add(title_line_, title_);
    title_line_ = 0;
  }

  /// Uses the title as names, if it has as many columns as the first point. @throws IoError if it names no x, y, z
  bool title_names_columns() {
    if (title_line_ == 0) return false;
    const std::size_t columns = words_.size();
    split(title_, delimiter_, words_);
    const bool fits = words_.size() == columns && std::ranges::none_of(words_, is_like_number);
    const std::int64_t line = std::exchange(title_line_, fits ? 0 : title_line_);
    if (fits) use_names(line, delimiter_);
    split_row();
    return fits;
  }

  bool is_taken(std::size_t column) const {
    const auto holds = [&](const auto& columns) { return std::ranges::find(columns, column) != columns.end(); };
    return holds(position_) ||
           std::ranges::any_of(triples_, [&](const Triple& triple) { return holds(triple.columns); });
  }

  /// Reads the columns that are not part of a vector. Empty entries are NaN. Ignores columns with other contents than numbers.
  void read_others() {
    for (Other& other : others_) {
      if (!other.is_numbers) continue;
      const std::string_view word = words_[other.column];
      const std::optional<double> value = word.empty() ? std::numeric_limits<double>::quiet_NaN() : to_real(word);
      other.is_numbers = value.has_value();
      if (value && take_ == nullptr) other.values.push_back(*value);
    }
  }

  void read_row() {
    if (left_ && (*left_)-- == 0) fail_at_line(in_, lines_.number(), "more points than the announced number");
    if (delimiter_ == '\0') delimiter_ = find_delimiter(line_, dialect_);
    split_row();
    if (columns_ == 0 && !title_names_columns()) choose_columns();
    if (words_.size() != columns_)
      fail_at_line(in_, lines_.number(),
                   "expected " + detail::counted(columns_, "column") + ", " +
                       (names_line_ > 0 ? "the number of names in line " + std::to_string(names_line_)
                                        : "as in the lines before") +
                       ", found " + std::to_string(words_.size()));
    ++count_;
    const Vec3 point = vector(position_);
    for (Triple& triple : triples_) {
      const Vec3 value = vector(triple.columns);
      triple.levels.add(value);
      if (take_ == nullptr) triple.values.push_back(value);
    }
    read_others();
    const double intensity = intensity_ ? real_or_fail(in_, lines_.number(), words_[3]) : 0;
    if (take_ != nullptr) return (*take_)(point);
    g_.points.push_back(point);
    if (intensity_) intensity_->push_back(intensity);
  }

  void split_row() {
    split_at(line_, delimiter_);
    // Tabs at the ends of a line are empty columns where the number of columns requires them.
    if (columns_ > 0 && words_.size() != columns_ && (delimiter_ == ' ' || delimiter_ == '\t')) {
      const std::string_view whole = without_comment(lines_.line(), '#');
      if (std::ranges::count(whole, '\t') >= static_cast<std::ptrdiff_t>(columns_) - 1) split_at(whole, '\t');
    }
  }

  void split_at(std::string_view line, char delimiter) {
    split(line, delimiter, words_);
    const bool open_end = words_.size() > 3 && words_.back().empty();  // the line ends with a delimiter
    if (open_end && (columns_ == 0 || words_.size() == columns_ + 1)) words_.pop_back();
  }

  /// Determines the meaning of unnamed columns from their number. Columns without a meaning are kept.
  void choose_columns() {
    skip_title();
    columns_ = words_.size();
    if (columns_ < 3)
      fail_at_line(in_, lines_.number(), "expected at least three columns, found " + std::to_string(columns_));
    if (columns_ == 6 || columns_ == 9) triples_.push_back({ColumnRole::unknown, {3, 4, 5}});
    if (columns_ == 9) triples_.push_back({ColumnRole::unknown, {6, 7, 8}});
    if (dialect_.fourth_is_intensity && (columns_ == 4 || columns_ == 7)) intensity_.emplace();
    if (columns_ == 7 && intensity_) triples_.push_back({ColumnRole::colors, {4, 5, 6}});
    if (columns_ > 3 && triples_.empty() && !intensity_)
      for (std::size_t column = 3; column < columns_; ++column) others_.push_back({column, unnamed(column)});
  }

  static std::string unnamed(std::size_t column) { return "column_" + std::to_string(column + 1); }

  Vec3 vector(const std::array<std::size_t, 3>& columns) const {
    Vec3 result;
    for (std::size_t c = 0; c < 3; ++c) result[c] = real_or_fail(in_, lines_.number(), words_[columns[c]]);
    return result;
  }

  /// Unnamed vectors are normals, unless they can only be colors. Two vectors of the same kind have no meaning.
  void choose_roles() {
    for (Triple& triple : triples_)
      if (triple.role == ColumnRole::unknown) choose_role(triple);
    if (triples_.size() < 2 || triples_[0].role != triples_[1].role) return;
    for (const Triple& triple : triples_)
      for (std::size_t c = 0; c < 3; ++c) {
        Other& other = others_.emplace_back(Other{triple.columns[c], unnamed(triple.columns[c])});
        for (const Vec3& value : triple.values) other.values.push_back(value[c]);
      }
    triples_.clear();
  }

  void keep() {
    if (intensity_) g_.properties.push_back({"intensity", std::move(*intensity_)});
    for (Other& other : others_) {
      if (other.is_numbers)
        add_property(g_, other.name, std::move(other.values));
      else
        g_.warnings.push_back({"column_ignored", {}, {}, other.name});
    }
    if (names_line_ == 0 && std::ranges::any_of(others_, &Other::is_numbers))
      g_.warnings.push_back({"columns_unnamed", {4, static_cast<double>(columns_)}, {}});
    for (Triple& triple : triples_) {
      if (triple.role == ColumnRole::normals) {
        g_.normals = std::move(triple.values);
      } else if (auto colors = to_colors(triple.values)) {
        g_.colors = std::move(*colors);
      } else {
        g_.warnings.push_back({"colors_unknown", {}, {}});
      }
    }
    lines_.skipped().report(g_.warnings);
  }

  void choose_role(Triple& triple) {
    triple.role = triple.levels.are_levels() ? ColumnRole::colors : ColumnRole::normals;
    if (triple.role == ColumnRole::normals) return;
    const auto first = static_cast<double>(triple.columns[0] + 1);
    g_.warnings.push_back({"columns_as_colors", {first, first + 2}, {}});
  }

  const Input& in_;
  const ColumnDialect& dialect_;
  const TakePoint* take_;
  Lines lines_;
  Geometry g_;
  std::uint64_t count_ = 0;  ///< number of points
  std::string_view line_;
  Words words_;
  char delimiter_ = '\0';    ///< '\0': unknown so far
  std::size_t columns_ = 0;  ///< number of columns in every line; 0: unknown so far
  std::array<std::size_t, 3> position_ = {0, 1, 2};
  std::vector<Triple> triples_;
  std::optional<std::vector<double>> intensity_;
  std::vector<Other> others_;
  std::int64_t names_line_ = 0;  ///< number of the line with the names of the columns; 0: none
  std::string title_;            ///< a line before the first point that may be a title or the names of the columns
  std::int64_t title_line_ = 0;  ///< 0: none
  bool title_is_comment_ = false;
  std::optional<std::int64_t> left_;  ///< number of remaining points of the block; nullopt: not announced
};

}  // namespace

Geometry read_columns(const Input& in, const ColumnDialect& dialect) {
  return ColumnReader(in, Lines(without_byte_order_mark(in.bytes)), dialect).read();
}

bool take_columns(const ByteStream& file, const ColumnDialect& dialect, const TakePoint& take) {
  const Input& in = file.head();
  const std::size_t mark = in.bytes.size() - without_byte_order_mark(in.bytes).size();
  return ColumnReader(in, Lines(file, mark), dialect, &take).take();
}

}  // namespace ahm::io
