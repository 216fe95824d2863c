#include <charconv>
#include <vector>

#include "write/mesh_part.hpp"

namespace ahm::io {
namespace {

std::size_t at(Offset i) { return static_cast<std::size_t>(i); }

/// " 0.1 2e-300 ...": the shortest decimals that read back to the same double.
std::string as_words(std::span<const double> values) {
  std::string words;
  for (double value : values) {
    char text[32];
    words += ' ';
    words.append(text, std::to_chars(text, text + sizeof text, value).ptr);
  }
  return words;
}

std::string material_of(const MeshPart& part, const std::string& texture) {
  std::string text = "newmtl " + part.name + "\nillum 1\n";
  const std::array<double, 3> white{1, 1, 1};
  text += "Kd" + as_words(part.texture ? white : part.color) + "\nKs 0 0 0\n";
  if (part.texture) text += "map_Kd " + texture + "\n";
  if (part.texture && part.transparent) text += "map_d " + texture + "\n";
  return text + "\n";
}

/// How many of each kind came before, since OBJ counts over the whole file.
struct Counts {
  std::size_t points = 0, textures = 0, normals = 0;
};

void write_part(AtomicFile& file, const MeshPart& part, Counts& counts) {
  const PartVertices vertices = vertices_of(part);
  file.write("o " + part.name + "\n");
  for (Index v : vertices.points) file.write("v" + as_words(part.points[v]) + "\n");
  for (std::size_t k = 0; k < vertices.textures.size(); k += 2)
    file.write("vt" + as_words(std::span(vertices.textures).subspan(k, 2)) + "\n");
  for (Index v : vertices.points)
    if (!part.normals.empty()) file.write("vn" + as_words(part.normals[v]) + "\n");
  file.write("usemtl " + part.name + "\n");
  std::string row;
  for (std::size_t f = 0; f + 1 < part.face_begin.size(); ++f) {
    row = "f";
    for (Offset c = part.face_begin[f]; c < part.face_begin[f + 1]; ++c) {
      const std::size_t point = at(vertices.point[c]) + 1;
      row += " " + std::to_string(counts.points + point);
      if (!vertices.textures.empty()) row += "/" + std::to_string(counts.textures + at(vertices.texture[c]) + 1);
      if (!part.normals.empty())
        row += (vertices.textures.empty() ? "//" : "/") + std::to_string(counts.normals + point);
    }
    file.write(row + "\n");
  }
  counts.points += vertices.points.size();
  counts.textures += vertices.textures.size() / 2;
  counts.normals += part.normals.empty() ? 0 : vertices.points.size();
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
  mtl.commit();
  obj.commit();
}

}  // namespace ahm::io
