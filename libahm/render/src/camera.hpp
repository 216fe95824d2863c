// The camera, and its projection in single precision for one picture size.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "ahm/render/picture.hpp"

namespace ahm::render {

/// A position as an Eigen vector, without a copy.
inline Eigen::Map<const Eigen::Vector3d> as_vector(const Vec3& x) {
  return Eigen::Map<const Eigen::Vector3d>(x.data());
}

/// Scene coordinates, x -> (x - center) / scale, and a perspective camera in these coordinates. The conversion is in double precision,
/// because floats cannot represent a scan in UTM coordinates accurately.
struct Camera {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double scale = 1;

  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d right, up, back;  ///< orthonormal; back points from the target to the eye
  double distance = 1;              ///< from the eye to the target
  double near_plane = 0.01, far_plane = 100;

  static constexpr double field_of_view = 0.5;  ///< vertical, radians; small enough to preserve proportions

  Eigen::Vector3d eye() const { return target + distance * back; }
  Eigen::Vector3d to_scene(const Vec3& x) const { return (as_vector(x) - center) / scale; }
  /// Camera coordinates: x to the right, y up, z towards the viewer, origin at the eye.
  Eigen::Vector3d to_view(const Eigen::Vector3d& x) const;
  /// Pixel position (y down), and the size of one unit at that depth, pixels.
  Eigen::Vector3d to_pixels(const Eigen::Vector3d& x, int width, int height) const;
};

/// The points that a picture shows: finite points; if there are faces, only their corners.
/// @throws InvalidGeometry if there are none.
std::vector<Index> shown_points(const Scene& scene);

/// Whether the point has a coordinate.
bool has_coordinate(const Scene& scene, Index point);

/// Distance of a point from the source: the scene's, or else |(u, v)|. Requires a point with a coordinate.
double distance_at(const Scene& scene, Index point);

/// Chooses a camera that frames the mapped part, or the whole scene if nothing is mapped.
Camera choose_camera(const Scene& scene, const std::vector<Index>& shown, const PictureOptions& options);

/// The ring width of the options, or a round number that gives about 12 rings (4 per cell, 24 squares) on the visible part of the map.
double choose_ring_width(const Scene& scene, const std::vector<Index>& shown, const PictureOptions& options);

/// The projection. Its pixels are samples of the picture: x to the right, y down, centers at 0.5. The nearness is 1 / depth, which is a
/// linear function of x and y on every plane. Larger is nearer; 0 is infinitely far.
struct Lens {
  Eigen::Matrix3f axes;  ///< rows: right, up, back
  Eigen::Vector3f eye;
  float focal;  ///< pixels per unit of length at depth 1
  float center_x, center_y;
  float near_plane;

  Lens(const Camera& camera, int width, int height)
      : eye(camera.eye().cast<float>()),
        focal(static_cast<float>(0.5 * height / std::tan(Camera::field_of_view / 2))),
        center_x(0.5F * static_cast<float>(width)),
        center_y(0.5F * static_cast<float>(height)),
        near_plane(static_cast<float>(camera.near_plane)) {
    axes << camera.right.cast<float>().transpose(), camera.up.cast<float>().transpose(),
        camera.back.cast<float>().transpose();
  }

  /// Camera coordinates: x to the right, y up, z towards the viewer.
  Eigen::Vector3f to_view(const Eigen::Vector3f& x) const { return axes * (x - eye); }
  /// (x, y, nearness) of a position in camera coordinates, in front of the near plane.
  Eigen::Vector3f to_pixels(const Eigen::Vector3f& view) const {
    const float nearness = -1 / view.z();
    return {center_x + focal * nearness * view.x(), center_y - focal * nearness * view.y(), nearness};
  }
};

}  // namespace ahm::render
