/// \file
/// Meshes with textures and colors to files.
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
  std::string name;                                          ///< of the object and its material; letters, digits and _
  std::span<const Vec3> points;                              ///< those that no face uses are not written
  std::span<const Vec3> normals = {};                        ///< empty or one per point
  std::span<const std::array<std::uint8_t, 3>> colors = {};  ///< empty or one per point; not beside a texture
  std::span<const Property> properties = {};                 ///< of the points, for .ply
  FaceList faces;                                            ///< polygons of points
  std::span<const double> texture_coordinates = {};  ///< empty or corners x 2; (0, 0) is the image's lower left corner
  const Image* texture = nullptr;                    ///< needs texture coordinates
  std::array<double, 3> color{0.75, 0.75, 0.75};     ///< without a texture and colors; red, green, blue in [0, 1]
  bool transparent = false;                          ///< the texture's opacity counts
};

/// Writes .obj (with .mtl and one .png per texture beside it) .glb (glTF 2.0, all in one file), or .ply without textures.
///
/// - OBJ: doubles, polygons, per-corner texture coordinates, colors behind the positions; a file NAME.obj comes with NAME.mtl and NAME_<part>.png.
///   It appears last, when all others are complete.
/// - PLY: a vertex for every pair of texture coordinates of a point, as doubles s and t (nan in parts without), the number of
///   the point as `point`; all parts in one, without textures, with the colors and properties that all of them have.
/// - GLB: triangles (polygons as fans), floats about the middle of the bounding box, which is the nodes' translation,
///   so that models far from the origin keep their shape. Colors as linear light.
/// @throws InvalidArgument (lengths, indices, a point or texture coordinate in use that is not finite; a texture, or a property of the
/// name of a column of its own, in a .ply; colors beside a texture), IoError
void write_textured(const std::filesystem::path& path, std::span<const MeshPart> parts);

}  // namespace ahm::io
