#include "output/texture_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "ahm/io/formats.hpp"
#include "output/output_paths.hpp"
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
    // The inverse map contains only the first of several equal points.
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

void check_texture_output(const std::string& input, const OutputOptions& output,
                          const std::vector<std::string>& extensions, const std::vector<std::string>& parts,
                          const std::string& image) {
  check_ending({"--output", output.output}, extensions);
  if (!output.view.empty() && io::lower_extension(output.view) != ".png")
    throw InvalidArgument(fmt::format("--view {}: pictures of textures must be .png files", output.view));
  if (!io::has_images())
    throw InvalidArgument("this build of ahm does not support textures; build it with stb (Debian: libstb-dev)");
  std::vector<OutputPath> outputs{{"--output", output.output}, {"--json", output.json}, {"--view", output.view}};
  if (io::lower_extension(output.output) == ".obj") {
    std::filesystem::path stem = output.output;
    stem.replace_extension();
    outputs.push_back({"--output", stem.string() + ".mtl"});
    for (const std::string& part : parts) outputs.push_back({"--output", stem.string() + "_" + part + ".png"});
  }
  check_outputs({input, image}, outputs, output.keep_existing);
}

SurfaceFaces given_faces(const io::Geometry& input) {
  SurfaceFaces faces;
  if (input.face_count() == 0) return faces;
  faces.points = input.points;
  faces.begin = input.face_begin;
  faces.corner_points = input.face_vertices;
  return faces;
}

SurfaceFaces all_faces(const Input& input) {
  if (!input.near) return surface_faces(input.surface());
  SurfaceFaces faces = given_faces(input.geometry);
  faces.normals = input.normals();
  const std::vector<std::uint8_t>& reversed = input.near->whole.reversed;
  for (std::size_t f = 0; f < reversed.size(); ++f)
    if (reversed[f])
      std::reverse(faces.corner_points.begin() + faces.begin[f] + 1, faces.corner_points.begin() + faces.begin[f + 1]);
  return faces;
}

std::vector<double> at_given_corners(const Input& input, const std::vector<Vec2>& at) {
  const io::Geometry& all = input.geometry;
  std::vector<double> result(2 * all.face_vertices.size(), NAN);
  const std::size_t faces = input.near ? input.near->faces.size() : all.face_count();
  auto from = at.begin();
  for (std::size_t f = 0; f < faces; ++f) {
    const std::size_t given = input.near ? static_cast<std::size_t>(input.near->faces[f]) : f;
    for (Offset c = all.face_begin[given]; c < all.face_begin[given + 1]; ++c, ++from)
      std::copy(from->begin(), from->end(), result.begin() + 2 * c);
  }
  return result;
}

}  // namespace ahm::app
