// This reader does not use a library. CGAL's scanner, the only one in Debian 12 that keeps doubles and polygons, parses vertices in
// the process's global C++ locale ("1.5" becomes 1 where decimals have commas), reads "0 0 1,5" as 0 0 1, cannot read "nan", and
// does not check the counts of the header.
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "ahm/util/text.hpp"
#include "formats/format.hpp"
#include "read/columns.hpp"
#include "read/text.hpp"

namespace ahm::io {
namespace {

/// Reads words across lines and skips comments.
class Words {
 public:
  Words(const Input& in, std::string_view text) : in_(in), lines_(text) {}

  std::string_view next(const char* expected) {
    for (std::string_view word = next_word(rest_);; word = next_word(rest_)) {
      if (!word.empty()) return word;
      if (!lines_.next_data('#')) fail_at_line(in_, lines_.number(), std::string("the file ends before ") + expected);
      rest_ = lines_.line();
    }
  }

  /// The remaining words of the line.
  std::string_view rest_of_line() noexcept { return std::exchange(rest_, {}); }
  bool at_end() { return rest_.empty() && !lines_.next_data('#'); }
  const SkippedLines& skipped() noexcept { return lines_.skipped(); }
  std::int64_t line() const noexcept { return lines_.number(); }
  std::size_t position() const noexcept { return lines_.position() - rest_.size(); }

 private:
  const Input& in_;
  Lines lines_;
  std::string_view rest_;
};

struct OffHeader {
  bool normals = false;
  bool colors = false;
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
};

/// Parses the keyword [ST][C][N]OFF in any case. Rejects nOFF and 4OFF, which have other dimensions.
void parse_keyword(const Input& in, std::int64_t line, std::string_view word, OffHeader& header) {
  const std::string_view ending = word.substr(word.size() - std::min<std::size_t>(word.size(), 3));
  const std::string_view prefix = word.substr(0, word.size() - ending.size());
  static constexpr std::array<std::string_view, 9> prefixes = {"", "n", "c", "cn", "nc", "st", "stn", "stc", "stcn"};
  const bool known = std::ranges::any_of(prefixes, [&](auto lower) { return equals_ignoring_case(prefix, lower); });
  if (!equals_ignoring_case(ending, "off") || !known || word == "nOFF") {
    fail_at_line(
        in, line,
        "expected 'OFF', 'NOFF' or 'COFF', found " + in_quotes(word) + "; convert the file to three-dimensional OFF");
  }
  header.normals = prefix.find_first_of("Nn") != std::string_view::npos;
  header.colors = prefix.find_first_of("Cc") != std::string_view::npos;
}

std::uint64_t parse_count(const Input& in, Words& words, const char* what) {
  const std::string_view word = words.next(what);
  const std::int64_t count = whole_or_fail(in, words.line(), word);
  if (count < 0) fail_at_line(in, words.line(), std::string(what) + " is negative: " + std::to_string(count));
  return static_cast<std::uint64_t>(count);
}

OffHeader parse_header(const Input& in, Words& words) {
  OffHeader header;
  std::string_view first = words.next("the keyword 'OFF'");
  if (!to_whole(first)) {  // some writers omit the keyword
    parse_keyword(in, words.line(), first, header);
    first = words.next("the number of vertices");
  }
  if (equals_ignoring_case(first, "binary"))
    fail_at_line(in, words.line(), "binary OFF is not supported; convert the file to text OFF or PLY");
  const std::int64_t vertices = whole_or_fail(in, words.line(), first);
  if (vertices < 0) fail_at_line(in, words.line(), "negative number of vertices " + std::to_string(vertices));
  header.vertices = static_cast<std::uint64_t>(vertices);
  header.faces = parse_count(in, words, "the number of faces");
  std::string_view edges = words.rest_of_line();
  if (const std::string_view word = next_word(edges); !word.empty()) whole_or_fail(in, words.line(), word);

  // The shortest vertex is "0 0 0" and a line end; the shortest face is "0" and a line end.
  const std::uint64_t left = in.bytes.size() - std::min(in.bytes.size(), words.position()) + 1;
  if (header.vertices > left / 6 || header.faces > left / 2) {
    fail_at_line(in, words.line(),
                 detail::counted(header.vertices, "vertex") + " and " + detail::counted(header.faces, "face") +
                     " do not fit into the " + detail::counted(left - 1, "byte") +
                     " that follow; the file is cut short");
  }
  check_vertex_count(in, header.vertices);
  return header;
}

/// Reads red, green and blue, starting with `word`; an opacity may follow. Fewer than three numbers are an index into a table of
/// colors, and are ignored.
void read_color(const Input& in, std::int64_t line, std::string_view word, std::string_view rest,
                std::vector<Vec3>& colors) {
  Vec3 color;
  for (double& level : color) {
    if (word.empty()) return;
    level = real_or_fail(in, line, word);
    word = next_word(rest);
  }
  colors.push_back(color);
}

/// Reads one line per vertex. Otherwise a missing number would shift all numbers after it.
void read_vertices(const Input& in, Words& words, const OffHeader& header, Geometry& g) {
  g.points.resize(header.vertices);
  if (header.normals) g.normals.resize(header.vertices);
  std::vector<Vec3> colors;
  for (std::size_t i = 0; i < header.vertices; ++i) {
    std::string_view word = words.next("all vertices are read");
    std::string_view rest = words.rest_of_line();
    for (std::size_t k = 0; k < (header.normals ? 6 : 3); ++k, word = next_word(rest)) {
      if (word.empty()) {
        fail_at_line(in, words.line(),
                     "vertex " + std::to_string(i) + " of " + std::to_string(header.vertices) + " must have " +
                         (header.normals ? "6" : "3") + " numbers, found " + std::to_string(k));
      }
      (k < 3 ? g.points[i][k] : g.normals[i][k - 3]) = real_or_fail(in, words.line(), word);
    }
    if (header.colors && colors.size() == i) read_color(in, words.line(), word, rest, colors);
  }
  if (!header.colors || header.vertices == 0) return;
  if (auto levels = colors.size() == header.vertices ? to_colors(colors) : std::nullopt)
    g.colors = std::move(*levels);
  else
    g.warnings.push_back({"colors_unknown", {}, {}});
}

void read_faces(const Input& in, Words& words, const OffHeader& header, Geometry& g) {
  if (header.faces == 0) return;
  g.face_begin.reserve(header.faces + 1);
  g.face_begin.push_back(0);
  for (std::size_t f = 0; f < header.faces; ++f) {
    const std::uint64_t corners = parse_count(in, words, "the number of corners of a face");
    for (std::uint64_t k = 0; k < corners; ++k) {
      const std::string_view word = words.next("all corners of a face are read");
      const std::int64_t vertex = whole_or_fail(in, words.line(), word);
      if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= header.vertices) {
        fail_at_line(in, words.line(),
                     "face " + std::to_string(f) + " has vertex number " + std::to_string(vertex) + ", but there are " +
                         detail::counted(header.vertices, "vertex") + ", counted from 0");
      }
      g.face_vertices.push_back(static_cast<Index>(vertex));
    }
    g.face_begin.push_back(static_cast<Offset>(g.face_vertices.size()));
    words.rest_of_line();  // skip an optional color
  }
}

Geometry read(const Input& in) {
  Words words(in, without_byte_order_mark(in.bytes));
  Geometry g;
  g.format = "OFF text";
  const OffHeader header = parse_header(in, words);
  read_vertices(in, words, header, g);
  read_faces(in, words, header, g);
  if (!words.at_end()) g.warnings.push_back({"data_after_faces", {}, {}});
  words.skipped().report(g.warnings);
  return g;
}

}  // namespace

Format off_format() { return {.extensions = {".off"}, .signatures = {"OFF", "COFF", "NOFF"}, .read = read}; }

}  // namespace ahm::io
