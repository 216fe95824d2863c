#include "ahm/io/textured_mesh.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "little_endian.hpp"
#include "write/mesh_part.hpp"

namespace ahm::io {
namespace {

std::size_t at(Offset i) { return static_cast<std::size_t>(i); }

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
  if (part.face_begin.empty() || part.face_begin.front() != 0 ||
      !std::is_sorted(part.face_begin.begin(), part.face_begin.end()))
    fail(part, "face_begin must rise from 0");
  check_length("face_vertices", part.face_vertices.size(), at(part.face_begin.back()));
  if (part.texture && part.texture_coordinates.empty() && !part.face_vertices.empty())
    fail(part, "a texture needs texture_coordinates");
  if (!part.texture_coordinates.empty())
    check_length("texture_coordinates", part.texture_coordinates.size(), 2 * part.face_vertices.size());
  for (std::size_t c = 0; c < part.face_vertices.size(); ++c) {
    const Index v = part.face_vertices[c];
    if (v < 0 || at(v) >= part.points.size())
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
  for (Index v : part.face_vertices) number[v] = 0;
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] == 0) {
      number[v] = static_cast<Index>(result.points.size());
      result.points.push_back(static_cast<Index>(v));
    }
  for (Index v : part.face_vertices) result.point.push_back(number[v]);
  if (part.texture_coordinates.empty()) return result;

  std::vector<Index> first(result.points.size(), -1), next;  // the pairs of a point, linked
  for (std::size_t c = 0; c < result.point.size(); ++c) {
    const double u = part.texture_coordinates[2 * c], v = part.texture_coordinates[2 * c + 1];
    Index pair = first[result.point[c]];
    while (pair >= 0 && (result.textures[2 * at(pair)] != u || result.textures[2 * at(pair) + 1] != v))
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
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".obj") return write_textured_obj(path, parts);
  if (extension == ".glb") return write_glb(path, parts);
  throw IoError(path.string() + ": textured meshes are written as .obj or .glb");
}

void write_colored_ply(const std::filesystem::path& path, std::span<const Vec3> points, std::span<const Vec3> normals,
                       std::span<const std::array<std::uint8_t, 3>> colors, std::span<const Offset> face_begin,
                       std::span<const Index> face_vertices) {
  if (colors.size() != points.size() || (!normals.empty() && normals.size() != points.size()))
    throw InvalidArgument("write_colored_ply: " + std::to_string(points.size()) + " points, " +
                          std::to_string(colors.size()) + " colours and " + std::to_string(normals.size()) +
                          " normals do not fit together");
  const std::size_t faces = face_begin.empty() ? 0 : face_begin.size() - 1;
  AtomicFile file(path);
  std::string row = "ply\nformat binary_little_endian 1.0\ncomment coloured by libahm\nelement vertex " +
                    std::to_string(points.size()) + "\n";
  for (const char* name : {"x", "y", "z"}) row += std::string("property double ") + name + "\n";
  for (const char* name : {"nx", "ny", "nz"})
    if (!normals.empty()) row += std::string("property double ") + name + "\n";
  for (const char* name : {"red", "green", "blue"}) row += std::string("property uchar ") + name + "\n";
  if (faces > 0) row += "element face " + std::to_string(faces) + "\nproperty list int int vertex_indices\n";
  file.write(row + "end_header\n");
  for (std::size_t i = 0; i < points.size(); ++i) {
    row.clear();
    for (double x : points[i]) append(row, x);
    for (std::size_t c = 0; c < 3 && !normals.empty(); ++c) append(row, normals[i][c]);
    for (std::uint8_t c : colors[i]) append(row, c);
    file.write(row);
  }
  for (std::size_t f = 0; f < faces; ++f) {
    row.clear();
    append(row, static_cast<std::int32_t>(face_begin[f + 1] - face_begin[f]));
    for (Offset c = face_begin[f]; c < face_begin[f + 1]; ++c) append(row, face_vertices[c]);
    file.write(row);
  }
  file.commit();
}

}  // namespace ahm::io
