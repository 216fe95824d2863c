/// \file
/// Decals as files: a piece of mesh with a texture above the surface, or painted points.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ahm/applications/decal.hpp"
#include "ahm/image.hpp"
#include "ahm/io/textured_mesh.hpp"
#include "ahm/io/write.hpp"
#include "input/open.hpp"
#include "output/texture_output.hpp"

namespace ahm::app {

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
