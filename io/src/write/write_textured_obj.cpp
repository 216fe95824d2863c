#include <vector>

#include "write/parts.hpp"
#include "write/writers.hpp"

namespace ahm::io {
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

/// How many of each kind came before, since OBJ counts over the whole file.
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

}  // namespace ahm::io
