// This reader does not use a library. CGAL's reader accepts index 0 and an index one past the last vertex, reads
// "f 1<tab>2<tab>3" as a face with one corner, stops silently at an invalid corner, and rejects `l` lines. tinyobjloader reads
// "1,5" as 1, 1e400 as infinity, and 0.3 with an error in the last digit. Assimp and VTK have single precision.
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>

#include "ahm/util/text.hpp"
#include "formats/format.hpp"
#include "read/columns.hpp"
#include "read/text.hpp"

namespace ahm::io {
namespace {

/// Reads statements. A backslash at the end of a line continues a statement on the next line.
class Statements {
 public:
  explicit Statements(std::string_view text) : lines_(text) {}

  bool next() {
    if (!lines_.next_data('#')) return false;
    number_ = lines_.number();
    line_ = lines_.line();
    if (!line_.ends_with('\\')) return true;
    joined_.clear();
    while (line_.ends_with('\\')) {
      joined_ += line_.substr(0, line_.size() - 1);
      joined_ += ' ';
      line_ = lines_.next() ? lines_.line() : std::string_view{};
    }
    joined_ += line_;
    line_ = joined_;
    return true;
  }
  std::string_view text() const noexcept { return line_; }
  std::int64_t line() const noexcept { return number_; }
  SkippedLines& skipped() noexcept { return lines_.skipped(); }

 private:
  Lines lines_;
  std::string_view line_;
  std::string joined_;
  std::int64_t number_ = 0;
};

/// A corner "v", "v/vt", "v//vn" or "v/vt/vn". Numbers are absolute and 1-based; 0 if absent.
struct Corner {
  std::int64_t vertex = 0;
  std::int64_t normal = 0;
};

class ObjReader {
 public:
  explicit ObjReader(const Input& in) : in_(in), statements_(without_byte_order_mark(in.bytes)) {}

  Geometry read() {
    g_.format = "OBJ";
    while (statements_.next()) read_statement();
    if (g_.points.empty()) fail(in_, "the file contains no vertex ('v x y z')" + statements_.skipped().hint());
    if (largest_ > g_.points.size()) {
      fail_at_line(in_, largest_line_,
                   "a face has vertex number " + std::to_string(largest_) + ", but the file has only " +
                       detail::counted(g_.points.size(), "vertex"));
    }
    finish_normals();
    finish_colors();
    statements_.skipped().report(g_.warnings);
    return std::move(g_);
  }

 private:
  void read_statement() {
    std::string_view rest = statements_.text();
    const std::string_view keyword = next_word(rest);
    if (keyword == "v") {
      check_vertex_count(in_, g_.points.size() + 1);
      g_.points.push_back(read_vector(rest));
      read_extras(rest);
    } else if (keyword == "vn") {
      normals_.push_back(read_vector(rest));
    } else if (keyword == "f") {
      read_face(rest);
    } else if (!is_known(keyword)) {
      skip(keyword);
    }
  }

  /// Skips a statement of an extension of the format. A number, or a vertex or face without a blank ("v1.5"), is damage.
  void skip(std::string_view keyword) {
    const auto begins_number = [](std::string_view text) { return text.find_first_of("0123456789+-.,/") == 0; };
    const bool needed =
        begins_number(keyword) || (keyword.find_first_of("vf") == 0 && begins_number(keyword.substr(1)));
    if (needed || has_control_characters(statements_.text()))
      fail_at_line(in_, statements_.line(), in_quotes(keyword) + " is not an OBJ keyword; the file is damaged");
    statements_.skipped().add(statements_.line(), statements_.text());
  }

  /// Reads the numbers after x, y, z: a weight, or red, green, blue.
  void read_extras(std::string_view rest) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    Vec3 color{none, none, none};
    std::size_t count = 0;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest), ++count)
      if (count < 3) color[count] = to_real(word).value_or(none);
    extras_ = extras_ || count > 0;
    if (count == 3 && extra_.size() + 1 == g_.points.size()) extra_.push_back(color);
  }

  void finish_colors() {
    if (!extras_) return;
    auto colors = extra_.size() == g_.points.size() ? to_colors(extra_) : std::nullopt;
    if (colors)
      g_.colors = std::move(*colors);
    else
      g_.warnings.push_back({"vertex_extras", {}, {}});
  }

  Vec3 read_vector(std::string_view& rest) const {
    Vec3 result;
    for (double& value : result) {
      const std::string_view word = next_word(rest);
      if (word.empty())
        fail_at_line(in_, statements_.line(),
                     "expected 3 numbers, found " + std::to_string(&value - result.data()) + ": " +
                         in_quotes(statements_.text()));
      value = real_or_fail(in_, statements_.line(), word);
    }
    return result;
  }

  void read_face(std::string_view rest) {
    if (g_.face_begin.empty()) g_.face_begin.push_back(0);
    std::size_t corners = 0;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest), ++corners) {
      const Corner corner = read_corner(word);
      normals_match_ = normals_match_ && corner.normal == corner.vertex;
      g_.face_vertices.push_back(static_cast<Index>(corner.vertex - 1));
    }
    if (corners < 3) {
      fail_at_line(in_, statements_.line(),
                   "face " + std::to_string(g_.face_count()) + " must have at least 3 corners, found " +
                       std::to_string(corners) + "; the file may be cut short");
    }
    g_.face_begin.push_back(static_cast<Offset>(g_.face_vertices.size()));
  }

  Corner read_corner(std::string_view word) {
    std::array<std::string_view, 3> parts;
    std::string_view rest = word;
    for (std::string_view& part : parts) {
      part = rest.substr(0, rest.find('/'));
      rest.remove_prefix(std::min(rest.size(), part.size() + 1));
    }
    if (!rest.empty()) fail_at_line(in_, statements_.line(), in_quotes(word) + " is not a corner of a face");
    Corner corner{absolute(parts[0], g_.points.size(), word), 0};
    if (!parts[1].empty() && !to_whole(parts[1]))
      fail_at_line(in_, statements_.line(), in_quotes(word) + " is not a corner of a face");
    if (!parts[2].empty()) corner.normal = absolute(parts[2], normals_.size(), word);
    if (static_cast<std::uint64_t>(corner.vertex) > largest_) {
      largest_ = static_cast<std::uint64_t>(corner.vertex);
      largest_line_ = statements_.line();
    }
    return corner;
  }

  /// The absolute, 1-based number; -1 refers to the last of the `so_far` elements read.
  std::int64_t absolute(std::string_view part, std::size_t so_far, std::string_view word) const {
    const std::optional<std::int64_t> number = to_whole(part);
    const auto last = static_cast<std::int64_t>(so_far);
    if (!number || *number == 0 || *number < -last || *number > std::numeric_limits<Index>::max()) {
      fail_at_line(in_, statements_.line(),
                   in_quotes(word) + " is not a corner of a face: numbers start at 1, or count back from -1 to -" +
                       std::to_string(last));
    }
    return *number < 0 ? last + 1 + *number : *number;
  }

  /// OBJ files have normals per corner. They are kept only if every corner has equal numbers of vertex and normal.
  void finish_normals() {
    if (normals_.empty()) return;
    if (normals_match_ && !g_.face_begin.empty() && normals_.size() == g_.points.size()) {
      g_.normals = std::move(normals_);
    } else {
      g_.warnings.push_back({"normals_not_by_vertex", {}, {}});
    }
  }

  static bool is_known(std::string_view keyword) {
    using namespace std::string_view_literals;
    static constexpr std::array keywords = {
        "vt"sv,       "vp"sv,       "p"sv,      "l"sv,          "o"sv,         "g"sv,     "s"sv,
        "mg"sv,       "mtllib"sv,   "usemtl"sv, "usemap"sv,     "maplib"sv,    "bevel"sv, "lod"sv,
        "deg"sv,      "bmat"sv,     "step"sv,   "cstype"sv,     "curv"sv,      "curv2"sv, "surf"sv,
        "parm"sv,     "trim"sv,     "hole"sv,   "scrv"sv,       "sp"sv,        "end"sv,   "con"sv,
        "c_interp"sv, "d_interp"sv, "ctech"sv,  "shadow_obj"sv, "trace_obj"sv, "stech"sv};
    return std::ranges::find(keywords, keyword) != keywords.end();
  }

  const Input& in_;
  Statements statements_;
  Geometry g_;
  std::vector<Vec3> normals_;
  bool normals_match_ = true;
  bool extras_ = false;
  std::vector<Vec3> extra_;  ///< three numbers after x, y, z, up to the first vertex without them
  std::uint64_t largest_ = 0;
  std::int64_t largest_line_ = 0;
};

Geometry read(const Input& in) { return ObjReader(in).read(); }

}  // namespace

Format obj_format() { return {.extensions = {".obj"}, .read = read, .write_textured = write_textured_obj}; }

}  // namespace ahm::io
