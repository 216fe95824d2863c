/// \file
/// Pictures of textured meshes and colored points, as a PNG file.
///
/// \code
/// ahm::render::write_textured_png("atlas.png", {.parts = parts, .towards = source});
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "ahm/io/textured_mesh.hpp"
#include "ahm/render/picture.hpp"

namespace ahm::render {

/// What is shown. The spans are only read, and only during the call.
struct TexturedScene {
  /// Meshes as they are written to files (`io::write_textured`). Transparent parts are laid over the others.
  std::span<const io::MeshPart> parts;
  /// Points, with a color each, and the radius of the disc that is drawn in world units; no radii: as far as the
  /// neighbours.
  std::span<const Vec3> points = {};
  std::span<const std::array<std::uint8_t, 3>> colors = {};
  std::span<const Vec3> normals = {};  ///< empty or one per point, either sign
  std::span<const double> radii = {};
  Vec3 towards{};  ///< what must be seen, if no view direction is given
};

/// Renders in memory, on the processor, and writes a PNG file; the file appears complete or not at all.
/// Of the options size, view direction and upwards count.
/// @throws InvalidArgument (sizes, lengths), InvalidGeometry (nothing to show), IoError
void write_textured_png(const std::filesystem::path& path, const TexturedScene& scene,
                        const PictureOptions& options = {});

}  // namespace ahm::render
