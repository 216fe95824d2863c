/// \file
/// Textured meshes as files, and decals: a piece of mesh with a texture above the surface, or painted points.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ahm/applications/decal.hpp"
#include "ahm/image.hpp"
#include "ahm/io/textured_mesh.hpp"
#include "ahm/io/write.hpp"
#include "ahm/surface/surface_triangles.hpp"
#include "cli/options.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// Before the work: whether all files can be written, those beside an .obj included, and none is `image`.
/// @param extensions  that --output may have
/// @throws IoError, InvalidArgument
void check_texture_output(const std::string& input, const OutputOptions& output,
                          const std::vector<std::string>& extensions, const std::vector<std::string>& parts,
                          const std::string& image);

/// The faces as the input has them, without normals; empty for a cloud.
SurfaceFaces given_faces(const io::Geometry& input);

/// The faces of the input, oriented alike, with normals, also those that --local left out; empty for a cloud.
SurfaceFaces all_faces(const Input& input);

/// Numbers of the corners of the surface's faces, two each, as those of all faces of the input: NaN where --local left one out.
std::vector<double> at_given_corners(const Input& input, const std::vector<Vec2>& at);

/// Some faces of a surface, with or without texture coordinates, as a part of a textured mesh.
class FacesPart {
 public:
  /// @param keep         whether to take face f
  /// @param coordinates  of all corners of the faces, or empty
  template <class Keep>
  FacesPart(const SurfaceFaces& faces, const Keep& keep, const std::vector<double>& coordinates = {}) : faces_(faces) {
    for (std::size_t f = 0; f + 1 < faces.begin.size(); ++f) {
      if (!keep(f)) continue;
      for (Offset c = faces.begin[f]; c < faces.begin[f + 1]; ++c) {
        vertices_.push_back(faces.corner_points[c]);
        if (!coordinates.empty())
          coordinates_.insert(coordinates_.end(), coordinates.begin() + 2 * c, coordinates.begin() + 2 * c + 2);
      }
      begin_.push_back(static_cast<Offset>(vertices_.size()));
    }
  }
  bool empty() const { return vertices_.empty(); }
  io::MeshPart view(const std::string& name) const {
    io::MeshPart part;
    part.name = name;
    part.points = faces_.points, part.normals = faces_.normals;
    part.faces = {begin_, vertices_};
    part.texture_coordinates = coordinates_;
    return part;
  }

 private:
  const SurfaceFaces& faces_;
  std::vector<Offset> begin_{0};
  std::vector<Index> vertices_;
  std::vector<double> coordinates_;
};

/// The surface and, above it, the decal with its texture.
class DecalMesh {
 public:
  /// @param faces  of the surface; none: the decal alone
  /// @param decal, image  must outlive it
  DecalMesh(SurfaceFaces faces, const Decal& decal, const Image& image);
  DecalMesh(const DecalMesh&) = delete;
  const std::vector<io::MeshPart>& parts() const { return parts_; }

 private:
  SurfaceFaces faces_;
  FacesPart behind_;
  std::vector<double> corners_;
  std::vector<io::MeshPart> parts_;
};

using Colors = std::vector<std::array<std::uint8_t, 3>>;

/// The colors of the input, light gray where there are none, under the image. Points that --voxel replaced are colored as the
/// nearest one kept.
/// @param places  `image_coordinates_of_vertices`
Colors painted(const Input& input, const std::vector<double>& places, const Image& image);

/// The points with these colors. All has to outlive the table.
io::Table painted_table(const Input& input, const Colors& colors);

}  // namespace ahm::app
