// The camera in single precision, for one size of picture.
#pragma once

#include <cmath>

#include "camera.hpp"

namespace ahm::view {

/// Pixels here are samples of the picture: x to the right, y down, centers at .5. Nearness is 1 / depth, which is linear
/// in the picture along any plane; larger is nearer, 0 is infinitely far.
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
  /// (x, y, nearness) of a place in camera coordinates before the near plane.
  Eigen::Vector3f to_pixels(const Eigen::Vector3f& view) const {
    const float nearness = -1 / view.z();
    return {center_x + focal * nearness * view.x(), center_y - focal * nearness * view.y(), nearness};
  }
};

}  // namespace ahm::view
