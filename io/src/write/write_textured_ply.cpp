#include <algorithm>
#include <iterator>
#include <limits>
#include <string_view>
#include <vector>

#include "write/parts.hpp"
#include "write/writers.hpp"

namespace ahm::io {
namespace {

/// What all parts have.
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

/// All parts in one, with a vertex for every pair of texture coordinates of a point.
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
      throw InvalidArgument("mesh part '" + part.name + "': a property is called " + property.name +
                            ", as a column of the .ply file; rename it");
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
