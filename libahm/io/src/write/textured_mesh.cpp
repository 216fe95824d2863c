#include "write/textured_mesh.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include "ahm/io/formats.hpp"
#include "formats/format.hpp"
#include "write/writers.hpp"

namespace ahm::io {
namespace {

[[noreturn]] void fail(const MeshPart& part, const std::string& what) {
  throw InvalidArgument("mesh part '" + part.name + "': " + what);
}

void check(const MeshPart& part) {
  const auto check_length = [&](const char* name, std::size_t size, std::size_t wanted) {
    if (size != wanted)
      fail(part, std::string(name) + " has length " + std::to_string(size) + ", not " + std::to_string(wanted));
  };
  if (part.name.empty() || !std::all_of(part.name.begin(), part.name.end(),
                                        [](unsigned char c) { return c == '_' || (c < 128 && std::isalnum(c)); }))
    fail(part, "its name must be letters, digits and _");
  if (!part.normals.empty()) check_length("normals", part.normals.size(), part.points.size());
  if (!part.colors.empty()) check_length("colors", part.colors.size(), part.points.size());
  if (!part.colors.empty() && part.texture) fail(part, "it has both colors and a texture; choose one");
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
      fail(part, "corner " + std::to_string(c) + " is vertex " + std::to_string(v) + ", outside [0, " +
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

  std::vector<Index> first(result.points.size(), -1), next;  // linked list of the pairs of each point
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

namespace {

/// " 0.1 2e-300 ...": the shortest decimals that read back to the same double.
std::string as_words(std::span<const double> values) {
  std::string words;
  for (double value : values) {
    words += ' ';
    append_decimals(words, value);
  }
  return words;
}

Vec3 fractions(const std::array<std::uint8_t, 3>& color) { return {color[0] / 255., color[1] / 255., color[2] / 255.}; }

std::string material_of(const MeshPart& part, const std::string& texture) {
  std::string text = "newmtl " + part.name + "\nillum 1\n";
  const std::array<double, 3> white{1, 1, 1};
  text += "Kd" + as_words(part.texture || !part.colors.empty() ? white : part.color) + "\nKs 0 0 0\n";
  if (part.texture) text += "map_Kd " + texture + "\n";
  if (part.texture && part.transparent) text += "map_d " + texture + "\n";
  return text + "\n";
}

/// Numbers of elements written so far; OBJ numbers elements across the whole file.
struct Counts {
  Offset points = 0, textures = 0, normals = 0;
};

void write_part(AtomicFile& file, const MeshPart& part, Counts& counts) {
  const PartVertices vertices = vertices_of(part);
  file.write("o " + part.name + "\n");
  for (Index v : vertices.points)
    file.write("v" + as_words(part.points[v]) + (part.colors.empty() ? "" : as_words(fractions(part.colors[v]))) +
               "\n");
  for (std::size_t k = 0; k < vertices.textures.size(); k += 2)
    file.write("vt" + as_words(std::span(vertices.textures).subspan(k, 2)) + "\n");
  for (Index v : vertices.points)
    if (!part.normals.empty()) file.write("vn" + as_words(part.normals[v]) + "\n");
  file.write("usemtl " + part.name + "\n");
  std::string row;
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    row = "f";
    for (Offset c = part.faces.begin[f]; c < part.faces.begin[f + 1]; ++c) {
      const Offset point = vertices.point[c] + Offset{1};
      row += " " + std::to_string(counts.points + point);
      if (!vertices.textures.empty()) row += "/" + std::to_string(counts.textures + vertices.texture[c] + 1);
      if (!part.normals.empty())
        row += (vertices.textures.empty() ? "//" : "/") + std::to_string(counts.normals + point);
    }
    file.write(row + "\n");
  }
  const auto points = static_cast<Offset>(vertices.points.size());
  counts.points += points;
  counts.textures += static_cast<Offset>(vertices.textures.size() / 2);
  counts.normals += part.normals.empty() ? 0 : points;
}

}  // namespace

void write_textured_obj(const std::filesystem::path& path, std::span<const MeshPart> parts) {
  AtomicFile obj(path);
  const std::string stem = path.stem().string();
  obj.write("# textured mesh by libahm\nmtllib " + stem + ".mtl\n");
  std::string materials = "# materials of " + path.filename().string() + "\n";
  Counts counts;
  for (const MeshPart& part : parts) {
    write_part(obj, part, counts);
    const std::string texture = stem + "_" + part.name + ".png";
    if (part.texture) write_png(path.parent_path() / texture, *part.texture);
    materials += material_of(part, texture);
  }
  AtomicFile mtl(path.parent_path() / (stem + ".mtl"));
  mtl.write(materials);
  obj.finish();
  mtl.finish();
  mtl.commit();
  obj.commit();
}

namespace {

/// Attributes that all parts have.
struct Common {
  bool normals = true, colors = true;
  std::vector<std::string> properties;

  explicit Common(std::span<const MeshPart> parts) {
    if (!parts.empty())
      for (const Property& property : parts.front().properties) properties.push_back(property.name);
    for (const MeshPart& part : parts) {
      normals = normals && !part.normals.empty();
      colors = colors && !part.colors.empty();
      std::erase_if(properties, [&](const std::string& name) { return find(part, name) == nullptr; });
    }
  }
  static const Property* find(const MeshPart& part, const std::string& name) {
    const auto at = std::find_if(part.properties.begin(), part.properties.end(),
                                 [&](const Property& property) { return property.name == name; });
    return at == part.properties.end() ? nullptr : &*at;
  }
};

/// One mesh of all parts, with one vertex per distinct pair of texture coordinates of a point.
struct OneMesh {
  std::vector<Vec3> points, normals;
  std::vector<std::array<std::uint8_t, 3>> colors;
  std::vector<Property> properties;
  std::vector<double> s, t;
  std::vector<Index> point;
  std::vector<Offset> begin{0};
  std::vector<Index> corners;

  void add(const MeshPart& part, const Common& common) {
    const PartVertices vertices = vertices_of(part);
    const bool textured = !vertices.textures.empty();
    const auto first = static_cast<Index>(points.size());
    const std::size_t count = textured ? vertices.texture_point.size() : vertices.points.size();
    for (std::size_t k = 0; k < count; ++k) {
      const Index v = vertices.points[textured ? vertices.texture_point[k] : static_cast<Index>(k)];
      points.push_back(part.points[v]);
      if (common.normals) normals.push_back(part.normals[v]);
      if (common.colors) colors.push_back(part.colors[v]);
      for (Property& property : properties) property.values.push_back(Common::find(part, property.name)->values[v]);
      point.push_back(v);
      s.push_back(textured ? vertices.textures[2 * k] : std::numeric_limits<double>::quiet_NaN());
      t.push_back(textured ? vertices.textures[2 * k + 1] : std::numeric_limits<double>::quiet_NaN());
    }
    for (Index corner : textured ? vertices.texture : vertices.point) corners.push_back(first + corner);
    const Offset before = begin.back();
    for (std::size_t f = 0; f < part.faces.size(); ++f) begin.push_back(before + part.faces.begin[f + 1]);
  }
};

void check_names(const MeshPart& part) {
  constexpr std::string_view own[] = {"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "s", "t", "point"};
  for (const Property& property : part.properties)
    if (std::ranges::find(own, property.name) != std::end(own))
      throw InvalidArgument("mesh part '" + part.name + "': the property " + property.name +
                            " has the name of a column of the .ply file; rename it");
}

}  // namespace

void write_textured_ply(const std::filesystem::path& path, std::span<const MeshPart> parts) {
  OneMesh mesh;
  for (const MeshPart& part : parts)
    if (part.texture) throw InvalidArgument("a .ply file has no textures; write .obj or .glb");
  for (const MeshPart& part : parts) check_names(part);
  const Common common(parts);
  for (const std::string& name : common.properties) mesh.properties.push_back({name, {}});
  for (const MeshPart& part : parts) mesh.add(part, common);
  Table table{.title = "textured mesh by libahm"};
  table.add({"x", "y", "z"}, mesh.points);
  if (common.normals) table.add({"nx", "ny", "nz"}, mesh.normals);
  if (common.colors) table.add({"red", "green", "blue"}, mesh.colors);
  table.add("s", mesh.s), table.add("t", mesh.t);
  table.add("point", mesh.point);
  for (const Property& property : mesh.properties) table.add(property.name, property.values);
  table.faces = {mesh.begin, mesh.corners};
  write(path, table, ".ply");
}

}  // namespace ahm::io
