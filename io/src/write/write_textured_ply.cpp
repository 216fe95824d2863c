#include <limits>
#include <vector>

#include "write/parts.hpp"
#include "write/writers.hpp"

namespace ahm::io {
namespace {

/// All parts in one, with a vertex for every pair of texture coordinates of a point.
struct OneMesh {
  std::vector<Vec3> points, normals;
  std::vector<double> s, t;
  std::vector<Index> point;
  std::vector<Offset> begin{0};
  std::vector<Index> corners;

  void add(const MeshPart& part, bool with_normals) {
    const PartVertices vertices = vertices_of(part);
    const bool textured = !vertices.textures.empty();
    const auto first = static_cast<Index>(points.size());
    const std::size_t count = textured ? vertices.texture_point.size() : vertices.points.size();
    for (std::size_t k = 0; k < count; ++k) {
      const Index v = vertices.points[textured ? vertices.texture_point[k] : static_cast<Index>(k)];
      points.push_back(part.points[v]);
      if (with_normals) normals.push_back(part.normals[v]);
      point.push_back(v);
      s.push_back(textured ? vertices.textures[2 * k] : std::numeric_limits<double>::quiet_NaN());
      t.push_back(textured ? vertices.textures[2 * k + 1] : std::numeric_limits<double>::quiet_NaN());
    }
    for (Index corner : textured ? vertices.texture : vertices.point) corners.push_back(first + corner);
    const Offset before = begin.back();
    for (std::size_t f = 0; f < part.faces.size(); ++f) begin.push_back(before + part.faces.begin[f + 1]);
  }
};

}  // namespace

void write_textured_ply(const std::filesystem::path& path, std::span<const MeshPart> parts) {
  OneMesh mesh;
  bool with_normals = true;
  for (const MeshPart& part : parts) {
    if (part.texture) throw InvalidArgument("a .ply file has no textures; write .obj or .glb");
    with_normals = with_normals && !part.normals.empty();
  }
  for (const MeshPart& part : parts) mesh.add(part, with_normals);
  Table table{.title = "textured mesh by libahm"};
  table.add({"x", "y", "z"}, mesh.points);
  if (with_normals) table.add({"nx", "ny", "nz"}, mesh.normals);
  table.add("s", mesh.s), table.add("t", mesh.t);
  table.add("point", mesh.point);
  table.faces = {mesh.begin, mesh.corners};
  write(path, table, ".ply");
}

}  // namespace ahm::io
