// A scene turned into float arrays, as a graphics card and a browser take them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "paint.hpp"

namespace ahm::view {

/// One entry per vertex in every array. Positions in the camera's scene coordinates.
struct Drawable {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector2f> uv;       ///< as in `Paint`
  std::vector<float> known;              ///< 1, or 0 where there is no coordinate
  std::vector<float> radii;              ///< of the disc that stands for a point; clouds only
  std::vector<std::uint32_t> triangles;  ///< three per triangle; meshes only

  bool is_mesh() const { return radii.empty(); }
};

/// The faces as triangles. Vertices are doubled where the surface has a crease or the map is torn (its cut locus).
Drawable make_surface(const Scene& scene, const Camera& camera, const Paint& paint);

/// The points as discs sized by the distance to their neighbours, normals estimated where none is given.
Drawable make_splats(const Scene& scene, const std::vector<Index>& shown, const Camera& camera, const Paint& paint);

/// One of the two.
Drawable make_drawable(const Scene& scene, const std::vector<Index>& shown, const Camera& camera, const Paint& paint);

}  // namespace ahm::view
