#include "ahm/io/textured_mesh.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "ahm/io/formats.hpp"
#include "formats/format.hpp"
#include "write/parts.hpp"

namespace ahm::io {
namespace {

[[noreturn]] void fail(const MeshPart& part, const std::string& what) {
  throw InvalidArgument("mesh part '" + part.name + "': " + what);
}

void check(const MeshPart& part) {
  const auto check_length = [&](const char* name, std::size_t size, std::size_t wanted) {
    if (size != wanted)
      fail(part, std::string(name) + " has " + std::to_string(size) + " entries, not " + std::to_string(wanted));
  };
  if (part.name.empty() || !std::all_of(part.name.begin(), part.name.end(),
                                        [](unsigned char c) { return c == '_' || (c < 128 && std::isalnum(c)); }))
    fail(part, "its name must be letters, digits and _");
  if (!part.normals.empty()) check_length("normals", part.normals.size(), part.points.size());
  if (!part.colors.empty()) check_length("colors", part.colors.size(), part.points.size());
  if (!part.colors.empty() && part.texture) fail(part, "colors do not go beside a texture");
  for (const Property& property : part.properties)
    check_length(property.name.c_str(), property.values.size(), part.points.size());
  const auto& [begin, vertices] = part.faces;
  if (begin.empty() || begin.front() != 0 || !std::is_sorted(begin.begin(), begin.end()))
    fail(part, "faces.begin must rise from 0");
  check_length("faces.vertices", vertices.size(), static_cast<std::size_t>(begin.back()));
  if (part.texture && part.texture_coordinates.empty() && !vertices.empty())
    fail(part, "a texture needs texture_coordinates");
  if (!part.texture_coordinates.empty())
    check_length("texture_coordinates", part.texture_coordinates.size(), 2 * vertices.size());
  for (std::size_t c = 0; c < vertices.size(); ++c) {
    const Index v = vertices[c];
    if (v < 0 || static_cast<std::size_t>(v) >= part.points.size())
      fail(part, "corner " + std::to_string(c) + " names vertex " + std::to_string(v) + ", outside [0, " +
                     std::to_string(part.points.size()) + ")");
    for (double x : part.points[v])
      if (!std::isfinite(x)) fail(part, "point " + std::to_string(v) + " is not finite");
    for (std::size_t k = 0; k < 2 && !part.texture_coordinates.empty(); ++k)
      if (!std::isfinite(part.texture_coordinates[2 * c + k]))
        fail(part, "the texture coordinates of corner " + std::to_string(c) + " are not finite");
  }
}

}  // namespace

PartVertices vertices_of(const MeshPart& part) {
  PartVertices result;
  std::vector<Index> number(part.points.size(), -1);
  for (Index v : part.faces.vertices) number[v] = 0;
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] == 0) {
      number[v] = static_cast<Index>(result.points.size());
      result.points.push_back(static_cast<Index>(v));
    }
  for (Index v : part.faces.vertices) result.point.push_back(number[v]);
  if (part.texture_coordinates.empty()) return result;

  std::vector<Index> first(result.points.size(), -1), next;  // the pairs of a point, linked
  for (std::size_t c = 0; c < result.point.size(); ++c) {
    const double u = part.texture_coordinates[2 * c], v = part.texture_coordinates[2 * c + 1];
    Index pair = first[result.point[c]];
    while (pair >= 0 && (result.textures[2 * Offset{pair}] != u || result.textures[2 * Offset{pair} + 1] != v))
      pair = next[pair];
    if (pair < 0) {
      pair = static_cast<Index>(result.texture_point.size());
      result.textures.insert(result.textures.end(), {u, v});
      result.texture_point.push_back(result.point[c]);
      next.push_back(std::exchange(first[result.point[c]], pair));
    }
    result.texture.push_back(pair);
  }
  return result;
}

void write_textured(const std::filesystem::path& path, std::span<const MeshPart> parts) {
  for (const MeshPart& part : parts) check(part);
  const Format* format = find_format(lower_extension(path));
  if (format == nullptr || format->write_textured == nullptr)
    throw IoError(path.string() + ": textured meshes are written as " + list_of(extensions(Use::write_textured), "or"));
  format->write_textured(path, parts);
}

}  // namespace ahm::io
