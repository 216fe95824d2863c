// A scene as arrays of floats, for the rasterizer and the browser.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "material.hpp"

namespace ahm::render {

inline constexpr std::size_t splat_ring = 6;  ///< number of neighbors that a disc reaches, so that discs overlap

/// The face and the corners of a drawn triangle.
struct TriangleOrigin {
  Index face;
  std::array<std::uint16_t, 3> corners;
  std::uint16_t sides;  ///< number of corners of the face
};

/// Vertices and triangles, or discs. Arrays have one entry per vertex or disc unless noted otherwise. Positions are in scene coordinates of
/// the camera.
struct Drawable {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  /// Interpolated values that the material converts to colors: (u, v, quality) as in `Paint`, texture coordinates, or a linear color.
  std::vector<Eigen::Vector3f> values;
  std::vector<float> known;              ///< 1, or 0 for vertices without a coordinate
  std::vector<float> radii;              ///< radii of the discs; clouds only
  std::vector<std::uint32_t> triangles;  ///< three per triangle; meshes only
  std::vector<Index> points;             ///< index of the point in the scene
  /// One per triangle; valid only if no triangle is torn.
  std::vector<TriangleOrigin> origins;
  /// Nearest neighbors of each point, filled up with the point itself; clouds only.
  std::vector<std::array<std::uint32_t, splat_ring>> rings;
  /// Gradients of the first two values in the plane of the disc, per unit of length; clouds only. Empty: constant values.
  std::vector<std::array<Eigen::Vector3f, 2>> gradients;
  /// Overlapping discs are blended if their values differ by less than this number times the radius.
  float values_per_length = 0;

  bool is_mesh() const { return radii.empty(); }
  std::size_t primitives() const { return is_mesh() ? triangles.size() / 3 : positions.size(); }
};

/// Converts faces to triangles. Vertices are duplicated at creases and where the map is torn (at its cut locus).
Drawable make_surface(const Scene& scene, const Camera& camera, const Paint& paint);

/// Converts points to discs. Their radii follow from the distances to the neighbors; missing normals are estimated.
Drawable make_splats(const Scene& scene, const std::vector<Index>& shown, const Camera& camera, const Paint& paint,
                     unsigned threads);

/// `make_surface` if the scene has faces, else `make_splats`.
Drawable make_drawable(const Scene& scene, const std::vector<Index>& shown, const Camera& camera, const Paint& paint,
                       unsigned threads);

/// Typical distance between vertices, scene units: the median radius of discs, or the mean edge length of a mesh.
float typical_spacing(const Drawable& drawable);

}  // namespace ahm::render
