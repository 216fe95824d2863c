/// \file
/// Writes meshes with textures and colors.
///
/// \code
/// ahm::io::MeshPart part{.name = "atlas", .points = points, .faces = geometry.faces()};
/// part.texture_coordinates = uv;                       // two per corner
/// part.texture = &image;
/// ahm::io::write_textured("bunny.glb", std::array{part});
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "ahm/error.hpp"
#include "ahm/io/geometry.hpp"
#include "ahm/io/image.hpp"
#include "ahm/types.hpp"

namespace ahm::io {

/// A piece of a mesh with one material. Views only: the data must outlive the call.
struct MeshPart {
  std::string name;                                          ///< of object and material; letters, digits and _
  std::span<const Vec3> points;                              ///< points that no face uses are not written
  std::span<const Vec3> normals = {};                        ///< empty or one per point
  std::span<const std::array<std::uint8_t, 3>> colors = {};  ///< empty or one per point; not with a texture
  std::span<const Property> properties = {};                 ///< properties of the points, for .ply
  FaceList faces;                                            ///< polygons; their vertices are points
  std::span<const double> texture_coordinates = {};  ///< empty or corners x 2; (0, 0) is the image's lower left corner
  const Image* texture = nullptr;                    ///< requires texture coordinates
  std::array<double, 3> color{0.75, 0.75, 0.75};     ///< without texture and colors; red, green, blue in [0, 1]
  bool transparent = false;                          ///< use the opacity of the texture
};

/// Writes .obj (with .mtl and one .png per texture), .glb (glTF 2.0, a single file), or .ply without textures.
///
/// - OBJ: doubles, polygons, per-corner texture coordinates, colors after the positions. NAME.obj comes with NAME.mtl and
///   NAME_<part>.png, and appears last, when all other files are complete.
/// - PLY: one mesh of all parts, without textures. Each point has a vertex for each of its distinct texture coordinates. Columns:
///   texture coordinates s and t as doubles (nan in parts without them), the number of the point as `point`, and the colors and
///   properties that all parts have.
/// - GLB: triangles (polygons as fans). Positions are floats relative to the center of the bounding box, which is the nodes'
///   translation: models far from the origin keep their shape. Colors are linear.
/// @throws InvalidArgument (wrong lengths or indices; a used point or texture coordinate is not finite; a part has both colors
/// and a texture; in a .ply: a texture, or a property with the name of a built-in column), IoError
void write_textured(const std::filesystem::path& path, std::span<const MeshPart> parts);

}  // namespace ahm::io
