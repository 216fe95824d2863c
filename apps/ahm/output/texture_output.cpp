#include "output/texture_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ahm/io/formats.hpp"
#include "output/output_paths.hpp"

namespace ahm::app {

void check_texture_output(const std::string& input, const OutputOptions& output,
                          const std::vector<std::string>& extensions, const std::vector<std::string>& parts,
                          const std::string& image) {
  check_ending({"--output", output.output}, extensions);
  if (!output.view.empty() && io::lower_extension(output.view) != ".png")
    throw InvalidArgument(fmt::format("--view {}: pictures of textures are .png files", output.view));
  if (!io::has_images())
    throw InvalidArgument("this build of ahm has no textures; build it with stb (Debian: libstb-dev)");
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
