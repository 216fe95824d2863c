#include "output/decal_output.hpp"

#include <cmath>
#include <utility>

#include "output/results.hpp"

namespace ahm::app {

DecalMesh::DecalMesh(SurfaceFaces faces, const Decal& decal, const Image& image)
    : faces_(std::move(faces)), behind_(faces_, [](std::size_t) { return true; }) {
  for (Index v : decal.face_vertices)
    for (std::size_t c : {0, 1}) corners_.push_back(decal.image_coordinates[2 * static_cast<std::size_t>(v) + c]);
  if (!behind_.empty()) parts_.push_back(behind_.view("surface"));
  io::MeshPart& part = parts_.emplace_back();
  part.name = "decal";
  part.points = decal.points, part.normals = decal.normals;
  part.faces = {decal.face_begin, decal.face_vertices};
  part.texture_coordinates = corners_;
  part.texture = &image;
  part.transparent = true;
}

Colors painted(const Input& input, const std::vector<double>& places, const Image& image) {
  Colors colors = input.geometry.colors;
  colors.resize(input.rows(), {200, 200, 200});
  const RowMap& rows = input.surface().rows();
  for (std::size_t r = 0; r < colors.size(); ++r) {
    const auto vertex = input.vertex_standing_for(Row(static_cast<Index>(r)));
    if (!vertex) continue;
    // Of equal points the first one is in the inverse.
    const auto k = static_cast<std::size_t>(rows.row(*vertex)->index);
    if (std::isnan(places[2 * k])) continue;
    const auto texel = image.sample(places[2 * k], places[2 * k + 1]);
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint8_t& color = colors[r][c];
      color = static_cast<std::uint8_t>(std::lround((1 - texel[3]) * color + texel[3] * 255 * texel[c]));
    }
  }
  return colors;
}

io::Table painted_table(const Input& input, const Colors& colors) {
  io::Table table = table_of(input.geometry, input.geometry.normals, colors);
  table.title = "colored by libahm";
  return table;
}

}  // namespace ahm::app
