// STL files contain unconnected triangles; this reader welds them at exactly equal positions, to get a surface.
// It does not use Assimp, the only STL reader in Debian 12, which rounds coordinates to float.
#include <algorithm>
#include <utility>

#include "ahm/util/text.hpp"
#include "ahm/util/weld.hpp"
#include "formats/format.hpp"
#include "little_endian.hpp"
#include "read/text.hpp"

namespace ahm::io {
namespace {

constexpr std::size_t header_bytes = 84;  // a comment of 80 bytes, then the number of triangles
constexpr std::size_t triangle_bytes = 50;

/// The header of a binary file may begin with "solid", and text with a comment. But only in binary files does the number of triangles
/// match the file size, and its bytes are hardly ever text.
bool is_binary(const Input& in) {
  if (in.bytes.size() < header_bytes) return false;
  const std::uint64_t triangles = load_at<std::uint32_t>(in.bytes, 80);
  return header_bytes + triangles * triangle_bytes == in.bytes.size() ||
         has_control_characters(std::string_view(in.bytes).substr(0, header_bytes));
}

std::vector<Vec3> read_binary(const Input& in) {
  const std::uint64_t triangles = load_at<std::uint32_t>(in.bytes, 80), left = in.bytes.size() - header_bytes;
  if (triangles == 0 && left >= triangle_bytes)
    fail_at_byte(in, 80,
                 "the header announces 0 triangles, but " + detail::counted(left, "byte") + " follow, enough for " +
                     std::to_string(left / triangle_bytes) + "; its writer was interrupted: export the file again");
  if (triangles > left / triangle_bytes)
    fail_at_byte(in, 80,
                 detail::counted(triangles, "triangle", "do") + " not fit into the " + detail::counted(left, "byte") +
                     " that follow; the file is cut short");
  std::vector<Vec3> corners;
  corners.reserve(3 * triangles);
  for (std::uint64_t t = 0; t < triangles; ++t)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t at = header_bytes + t * triangle_bytes + 12 + 12 * corner;
      corners.push_back(
          {load_at<float>(in.bytes, at), load_at<float>(in.bytes, at + 4), load_at<float>(in.bytes, at + 8)});
    }
  return corners;
}

/// Every facet must have three vertices and an end. Otherwise a missing line would shift all later vertices. Other words are skipped.
std::vector<Vec3> read_text(const Input& in, std::vector<Warning>& warnings) {
  std::vector<Vec3> corners;
  std::vector<std::string_view> words;
  Lines lines(without_byte_order_mark(in.bytes));
  std::size_t in_facet = 0;
  bool open = false, ended = false, skipped = false;  // skipped: the last line
  while (lines.next_data()) {
    split_words(lines.line(), words);
    skipped = false;
    const auto begins_with = [&](std::string_view word) { return equals_ignoring_case(words[0], word); };
    const auto ends = [&](std::string_view word) {  // "endsolid" or "end solid"
      return (begins_with("end") && words.size() > 1 && equals_ignoring_case(words[1], word)) ||
             equals_ignoring_case(words[0], "end" + std::string(word));
    };
    if (begins_with("facet")) {
      if (open) fail_at_line(in, lines.number(), "a facet begins before the previous one has ended");
      open = true;
      in_facet = 0;
    } else if (begins_with("vertex")) {
      if (!open || words.size() != 4) fail_at_line(in, lines.number(), "expected a facet's 'vertex x y z'");
      corners.push_back({real_or_fail(in, lines.number(), words[1]), real_or_fail(in, lines.number(), words[2]),
                         real_or_fail(in, lines.number(), words[3])});
      ++in_facet;
    } else if (ends("facet")) {
      if (!open || in_facet != 3)
        fail_at_line(in, lines.number(), "the facet must have 3 vertices, found " + std::to_string(in_facet));
      open = false;
    } else if (ends("solid")) {
      ended = true;
    } else if (!begins_with("solid") && !begins_with("outer") && !ends("loop")) {
      if (has_control_characters(lines.line()))
        fail_at_line(in, lines.number(), in_quotes(lines.line()) + " contains control characters; the file is damaged");
      lines.skipped().add(lines.number(), lines.line());
      skipped = true;
    }
  }
  if (open) fail_at_line(in, lines.number(), "the file ends within a facet; it is cut short");
  if (corners.empty()) fail(in, "it contains no triangles" + lines.skipped().hint());
  if (!ended && skipped) fail_at_line(in, lines.number(), "the file ends without 'endsolid'; it is cut short");
  if (!ended) warnings.push_back({"no_end", {}, {}, "endsolid"});
  lines.skipped().report(warnings);
  return corners;
}

Geometry read(const Input& in) {
  Geometry g;
  const bool binary = is_binary(in);
  const std::vector<Vec3> corners = binary ? read_binary(in) : read_text(in, g.warnings);
  g.format = binary ? "STL binary" : "STL text";
  check_vertex_count(in, corners.size());
  if (corners.empty()) fail(in, "it contains no triangles");
  detail::MergedPoints welded = detail::weld(corners);
  for (const Index corner : welded.first) g.points.push_back(corners[corner]);
  g.face_vertices = std::move(welded.number);
  for (std::size_t f = 0; 3 * f <= corners.size(); ++f) g.face_begin.push_back(static_cast<Offset>(3 * f));
  return g;
}

}  // namespace

Format stl_format() { return {.extensions = {".stl"}, .signatures = {"solid "}, .read = read}; }

}  // namespace ahm::io
