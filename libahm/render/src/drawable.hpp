// A scene turned into float arrays, as the rasteriser and a browser take them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "material.hpp"

namespace ahm::render {

inline constexpr std::size_t splat_ring = 6;  ///< neighbours a disc reaches, so that discs overlap

/// Where a drawn triangle is from.
struct TriangleOrigin {
  Index face;
  std::array<std::uint16_t, 3> corners;
  std::uint16_t sides;  ///< of the face
};

/// One entry per vertex in every array. Positions in the camera's scene coordinates.
struct Drawable {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  /// What is interpolated between vertices, for the material to paint by: (u, v, quality) as in `Paint`, a place on a
  /// texture, or a color in linear light.
  std::vector<Eigen::Vector3f> values;
  std::vector<float> known;              ///< 1, or 0 where there is no coordinate
  std::vector<float> radii;              ///< of the disc that stands for a point; clouds only
  std::vector<std::uint32_t> triangles;  ///< three per triangle; meshes only
  std::vector<Index> points;             ///< of the scene, that the vertices stand for
  /// One per triangle where the map is torn nowhere.
  std::vector<TriangleOrigin> origins;
  /// The points nearest to a point, itself where there are fewer; clouds only.
  std::vector<std::array<std::uint32_t, splat_ring>> rings;
  /// Change of the first two values per unit of length along the disc; clouds only, empty: they do not change.
  std::vector<std::array<Eigen::Vector3f, 2>> gradients;
  /// Discs that overlap are blended where their values differ by less than this many of their radii.
  float values_per_length = 0;

  bool is_mesh() const { return radii.empty(); }
  std::size_t primitives() const { return is_mesh() ? triangles.size() / 3 : positions.size(); }
};

/// The faces as triangles. Vertices are doubled where the surface has a crease or the map is torn (its cut locus).
Drawable make_surface(const Scene& scene, const Camera& camera, const Paint& paint);

/// The points as discs sized by the distance to their neighbours, normals estimated where none is given.
Drawable make_splats(const Scene& scene, const std::vector<Index>& shown, const Camera& camera, const Paint& paint,
                     unsigned threads);

/// One of the two.
Drawable make_drawable(const Scene& scene, const std::vector<Index>& shown, const Camera& camera, const Paint& paint,
                       unsigned threads);

/// Typical distance between vertices in scene units: the median radius of discs, the mean edge of a mesh.
float typical_spacing(const Drawable& drawable);

}  // namespace ahm::render
