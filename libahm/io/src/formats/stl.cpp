// STL files contain unconnected triangles; this reader welds them at exactly equal positions, to get a surface.
// It does not use Assimp, the only STL reader in Debian 12, which rounds coordinates to float.
#include <algorithm>
#include <utility>

#include "ahm/util/weld.hpp"
#include "formats/format.hpp"
#include "little_endian.hpp"
#include "read/text.hpp"

namespace ahm::io {
namespace {

constexpr std::size_t header_bytes = 84;  // a comment of 80 bytes, then the number of triangles
constexpr std::size_t triangle_bytes = 50;

bool begins_with_solid(const std::string& bytes) {
  std::string_view rest = without_byte_order_mark(std::string_view(bytes).substr(0, header_bytes));
  rest.remove_prefix(std::min(rest.size(), rest.find_first_not_of(" \t\r\n")));
  return equals_ignoring_case(rest.substr(0, 5), "solid");
}

bool is_binary(const Input& in) {
  if (in.bytes.size() < header_bytes) return false;
  // A binary header may begin with "solid", too. But only in binary files does the number of triangles match the file size.
  const std::uint64_t triangles = load_at<std::uint32_t>(in.bytes, 80);
  return header_bytes + triangles * triangle_bytes == in.bytes.size() || !begins_with_solid(in.bytes) ||
         in.bytes.find('\0') < header_bytes;
}

std::vector<Vec3> read_binary(const Input& in) {
  const std::uint64_t triangles = load_at<std::uint32_t>(in.bytes, 80);
  if (header_bytes + triangles * triangle_bytes > in.bytes.size())
    fail_at_byte(in, 80,
                 std::to_string(triangles) + " triangles do not fit into the " +
                     std::to_string(in.bytes.size() - header_bytes) + " bytes that follow; the file is cut short");
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

/// Every facet must have three vertices and an end. Otherwise a missing line would shift all later vertices.
std::vector<Vec3> read_text(const Input& in) {
  std::vector<Vec3> corners;
  std::vector<std::string_view> words;
  Lines lines(without_byte_order_mark(in.bytes));
  std::size_t in_facet = 0;
  bool open = false, ended = false;
  while (lines.next()) {
    split_words(lines.line(), words);
    if (words.empty()) continue;
    const auto begins_with = [&](std::string_view word) { return equals_ignoring_case(words[0], word); };
    if (begins_with("facet")) {
      if (open) fail_at_line(in, lines.number(), "a facet begins before the previous one has ended");
      open = true;
      in_facet = 0;
    } else if (begins_with("vertex")) {
      if (!open || words.size() != 4) fail_at_line(in, lines.number(), "expected a facet's 'vertex x y z'");
      corners.push_back({real_or_fail(in, lines.number(), words[1]), real_or_fail(in, lines.number(), words[2]),
                         real_or_fail(in, lines.number(), words[3])});
      ++in_facet;
    } else if (begins_with("endfacet")) {
      if (!open || in_facet != 3)
        fail_at_line(in, lines.number(), "the facet must have 3 vertices, found " + std::to_string(in_facet));
      open = false;
    } else if (begins_with("endsolid")) {
      ended = true;
    } else if (!begins_with("solid") && !begins_with("outer") && !begins_with("endloop")) {
      fail_at_line(in, lines.number(), "unknown word " + in_quotes(words[0]) + " in a text STL file");
    }
  }
  if (open || !ended) fail_at_line(in, lines.number(), "the file ends before 'endsolid'; it is cut short");
  return corners;
}

Geometry read(const Input& in) {
  Geometry g;
  const bool binary = is_binary(in);
  const std::vector<Vec3> corners = binary ? read_binary(in) : read_text(in);
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
