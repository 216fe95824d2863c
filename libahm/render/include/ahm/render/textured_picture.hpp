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

/// The contents of a picture. The spans are only read, and only during the call.
struct TexturedScene {
  /// Meshes, as for `io::write_textured`. Transparent parts are drawn over the others.
  std::span<const io::MeshPart> parts;
  /// Points that are drawn as discs. Each has a color, and optionally a radius, world units. Without radii, discs reach to the neighbors.
  std::span<const Vec3> points = {};
  std::span<const std::array<std::uint8_t, 3>> colors = {};
  std::span<const Vec3> normals = {};  ///< empty or one per point, of either sign
  std::span<const double> radii = {};
  Vec3 towards{};  ///< position that the default view direction shows
};

/// Renders on the CPU and writes a PNG file, which appears complete or not at all.
/// @param options  uses the size, the view direction, the up direction and the number of threads
/// @throws InvalidArgument (sizes, lengths), InvalidGeometry (nothing to show), IoError
void write_textured_png(const std::filesystem::path& path, const TexturedScene& scene,
                        const PictureOptions& options = {});

}  // namespace ahm::render
