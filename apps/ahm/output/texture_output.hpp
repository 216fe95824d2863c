/// \file
/// Output of textured meshes and decals: a textured part of the mesh above the surface, or colored points.
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

/// Checks before the work that all files can be written, including those that belong to an .obj, and that none replaces `image`.
/// @param extensions  allowed extensions of --output
/// @param parts       names of the textured parts, each of which is a .png of an .obj
/// @throws IoError, InvalidArgument
void check_texture_output(const std::string& input, const OutputOptions& output,
                          const std::vector<std::string>& extensions, const std::vector<std::string>& parts,
                          const std::string& image);

/// The faces of the input unchanged, without normals; empty for a cloud.
SurfaceFaces given_faces(const io::Geometry& input);

/// All faces of the input, including those that --local left out, oriented consistently and with normals; empty for a cloud.
SurfaceFaces all_faces(const Input& input);

/// Values at the corners of the surface's faces, two per corner, extended to all faces of the input. NaN in faces that --local left out.
std::vector<double> at_given_corners(const Input& input, const std::vector<Vec2>& at);

/// A part of a textured mesh: some faces of a surface, with or without texture coordinates.
class FacesPart {
 public:
  /// @param keep         keep(f): whether the part contains face f
  /// @param coordinates  two texture coordinates per corner of all faces, or empty
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

/// The surface, and above it the decal with its texture.
class DecalMesh {
 public:
  /// @param faces         faces of the surface; none: only the decal
  /// @param decal, image  must outlive the mesh
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

/// The colors of the input (light gray if it has none), covered by the image. Points that --voxel replaced get the color of the
/// nearest kept point.
/// @param places  `image_coordinates_of_vertices`
Colors painted(const Input& input, const std::vector<double>& places, const Image& image);

/// A table of the points with these colors. All arguments must outlive the table.
io::Table painted_table(const Input& input, const Colors& colors);

}  // namespace ahm::app
