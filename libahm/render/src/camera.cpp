#include "camera.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/util/quantile.hpp"
#include "ahm/util/text.hpp"
#include "direction.hpp"

namespace ahm::render {
namespace {

using Eigen::Vector3d;

constexpr std::size_t framing_sample = 200'000;

struct Range {
  double low, high;
};

/// Smallest and largest value. On a side where the outer percent of the values is far away (outliers of a scan), limits the range.
Range robust_range(std::vector<double> values) {
  const auto quantile = [&](double q) {
    return detail::value_at(values, static_cast<std::size_t>(std::lround(q * static_cast<double>(values.size() - 1))));
  };
  const double low = quantile(0), trimmed_low = quantile(0.01), trimmed_high = quantile(0.99), high = quantile(1);
  const double slack = 0.15 * (trimmed_high - trimmed_low);
  return {low < trimmed_low - slack ? trimmed_low - slack : low,
          high > trimmed_high + slack ? trimmed_high + slack : high};
}

/// Box of the points without outliers.
Eigen::AlignedBox3d robust_box(const std::vector<Vector3d>& points) {
  Vector3d low, high;
  std::vector<double> values(points.size());
  for (int k = 0; k < 3; ++k) {
    std::ranges::transform(points, values.begin(), [k](const Vector3d& p) { return p[k]; });
    const Range range = robust_range(values);
    low[k] = range.low;
    high[k] = range.high;
  }
  return {low, high};
}

std::vector<Vector3d> positions(const Scene& scene, const std::vector<Index>& points) {
  std::vector<Vector3d> result;
  for (const Index i : points) result.push_back(as_vector(scene.points[i]));
  return result;
}

/// About `framing_sample` of the points.
std::vector<Index> sampled(const std::vector<Index>& points) {
  const std::size_t stride = points.size() / framing_sample + 1;
  std::vector<Index> sample;
  for (std::size_t k = 0; k < points.size(); k += stride) sample.push_back(points[k]);
  return sample;
}

/// The points that determine the framing: the mapped points, or all points if none is mapped. Also all points of a mesh that is mostly
/// mapped, to show the whole mesh.
/// @param is_local  set to whether the mapped points are less than half of all, or extend less than half as far
std::vector<Index> framed_points(const Scene& scene, const std::vector<Index>& shown, bool& is_local) {
  std::vector<Index> mapped;
  std::copy_if(shown.begin(), shown.end(), std::back_inserter(mapped),
               [&](Index i) { return has_coordinate(scene, i); });
  const auto extent = [&](const std::vector<Index>& points) {
    return robust_box(positions(scene, sampled(points))).diagonal().stableNorm();
  };
  const bool is_partial = !mapped.empty() && mapped.size() < shown.size();
  is_local = is_partial && (2 * mapped.size() < shown.size() || 2 * extent(mapped) < extent(shown));
  const bool all = mapped.empty() || (!is_local && !scene.face_vertices.empty());
  return sampled(all ? shown : mapped);
}

/// z for objects that are flat in z (terrain, rooms) and for scans that are tall in z (trees, masts), else y. The threshold is stricter
/// for meshes, because a figure with spread arms is flat in z, too.
Vector3d default_up(const Vector3d& extent, bool is_mesh) {
  const double flat = is_mesh ? 0.3 : 0.6, wide = std::max(extent.x(), extent.y());
  const bool lies = extent.z() < flat * std::min(extent.x(), extent.y()), stands = !is_mesh && extent.z() > 3 * wide;
  return lies || stands ? Vector3d(0, 0, 1) : Vector3d(0, 1, 0);
}

void orient(Camera& camera, const Vector3d& direction, const Vector3d& up) {
  camera.back = direction.normalized();
  Vector3d right = up.cross(camera.back);
  if (right.norm() < 1e-6 * up.norm())  // the view is along `up`: x to the right, as on paper
    right = Vector3d(std::abs(camera.back.y()) < 0.9 ? Vector3d(0, 1, 0) : Vector3d(0, 0, -1)).cross(camera.back);
  camera.right = right.normalized();
  camera.up = camera.back.cross(camera.right);
}

/// The value c at which the slopes (x - c) / (distance - z) of the points (x, z) extend as far to both sides: they are centered in the
/// picture.
double picture_center(const std::vector<Eigen::Vector2d>& points, double distance) {
  double low = 0, high = 0;
  for (const auto& p : points) low = std::min(low, p.x()), high = std::max(high, p.x());
  while (true) {
    const double middle = (low + high) / 2;
    if (high - low < 1e-6) return middle;
    double least = 0, greatest = 0;
    for (const auto& p : points) {
      const double slope = (p.x() - middle) / (distance - p.y());
      least = std::min(least, slope), greatest = std::max(greatest, slope);
    }
    (greatest + least > 0 ? low : high) = middle;
  }
}

/// Moves target and distance so that the points inside `box` (in camera axes, scene units) fill the picture: from the least distance at
/// which |x - c| margin / tan <= distance - z for all points, for a center c of each axis. No point comes nearer to the eye than a tenth of
/// the unit.
void fit(Camera& camera, const std::vector<Vector3d>& points, const Eigen::AlignedBox3d& box, double aspect,
         double margin) {
  const double tangent = std::tan(Camera::field_of_view / 2);
  Vector3d center = box.center();
  std::array<std::vector<Eigen::Vector2d>, 2> planes;
  constexpr double nearest = 0.1;
  camera.distance = 0;
  for (int k = 0; k < 2; ++k) {
    const double slope = margin / (k == 0 ? tangent * aspect : tangent);
    double right = -std::numeric_limits<double>::infinity(), left = right;
    for (const Vector3d& p : points) {
      const Vector3d q = p - center;
      planes[k].emplace_back(q[k], q.z());
      right = std::max(right, q.z() + slope * q[k]), left = std::max(left, q.z() - slope * q[k]);
    }
    camera.distance = std::max(camera.distance, (left + right) / 2);
  }
  for (const auto& p : planes[0]) camera.distance = std::max(camera.distance, p.y() + nearest);
  for (int k = 0; k < 2; ++k) center[k] += picture_center(planes[k], camera.distance);
  camera.target = center.x() * camera.right + center.y() * camera.up + center.z() * camera.back;
}

}  // namespace

Vector3d Camera::to_view(const Vector3d& x) const {
  const Vector3d d = x - target;
  return {d.dot(right), d.dot(up), d.dot(back) - distance};
}

Vector3d Camera::to_pixels(const Vector3d& x, int width, int height) const {
  const Vector3d v = to_view(x);
  const double pixels = 0.5 * height / std::tan(field_of_view / 2) / std::max(-v.z(), near_plane);
  return {0.5 * width + pixels * v.x(), 0.5 * height - pixels * v.y(), pixels};
}

bool has_coordinate(const Scene& scene, Index point) {
  const auto i = static_cast<std::size_t>(point);
  if (!scene.labels.empty()) return scene.labels[i] >= 0 && std::isfinite(scene.distance[i]);
  if (!scene.u.empty()) return std::isfinite(scene.u[i]) && std::isfinite(scene.v[i]);
  return !scene.distance.empty() && std::isfinite(scene.distance[i]);
}

double distance_at(const Scene& scene, Index point) {
  const auto i = static_cast<std::size_t>(point);
  if (!scene.distance.empty() && std::isfinite(scene.distance[i])) return scene.distance[i];
  return scene.u.empty() ? 0 : std::hypot(scene.u[i], scene.v[i]);
}

std::vector<Index> shown_points(const Scene& scene) {
  std::vector<bool> used(scene.points.size(), scene.face_vertices.empty());
  for (const Index vertex : scene.face_vertices) used[vertex] = true;
  std::vector<Index> shown;
  for (std::size_t i = 0; i < scene.points.size(); ++i)
    if (used[i] && as_vector(scene.points[i]).allFinite()) shown.push_back(static_cast<Index>(i));
  if (shown.empty())
    throw InvalidGeometry("scene.points: nothing to show, none of the " +
                          detail::counted(scene.points.size(), "point") + " is finite" +
                          (scene.face_vertices.empty() ? "" : " and part of a face"));
  return shown;
}

Camera choose_camera(const Scene& scene, const std::vector<Index>& shown, const PictureOptions& options) {
  bool is_local = false;
  const std::vector<Index> framed = framed_points(scene, shown, is_local);
  const Eigen::AlignedBox3d box = robust_box(positions(scene, framed));

  Camera camera;
  camera.center = box.center();
  camera.scale = box.diagonal().stableNorm() / 2;
  if (!(camera.scale > 0)) camera.scale = std::max(1.0, camera.center.stableNorm() * 1e-3);  // a single point

  const Vector3d up =
      options.up ? Vector3d(as_vector(*options.up)) : default_up(box.sizes(), !scene.face_vertices.empty());
  const Vector3d direction = options.view_direction ? Vector3d(as_vector(*options.view_direction))
                                                    : choose_direction(scene, shown, camera, up, box.sizes());
  orient(camera, direction, up);

  Eigen::Matrix3d axes;
  axes << camera.right, camera.up, camera.back;
  std::vector<Vector3d> points;
  for (const Index i : framed) points.push_back(axes.transpose() * camera.to_scene(scene.points[i]));
  const Eigen::AlignedBox3d view_box = robust_box(points);
  std::erase_if(points, [&](const Vector3d& p) { return !view_box.contains(p); });
  if (points.empty()) points.push_back(view_box.center());
  fit(camera, points, view_box, static_cast<double>(options.width) / options.height, is_local ? 1.35 : 1.08);

  double deepest = 0;
  for (const Index i : shown) deepest = std::max(deepest, -camera.to_view(camera.to_scene(scene.points[i])).z());
  camera.near_plane = 0.02 * camera.distance;
  camera.far_plane = std::clamp(1.1 * deepest, 2 * camera.distance, 1e4 * camera.distance);
  return camera;
}

double choose_ring_width(const Scene& scene, const std::vector<Index>& shown, const PictureOptions& options) {
  if (options.ring_width) return *options.ring_width;
  std::vector<double> first, second;
  for (const Index i : shown) {
    if (!has_coordinate(scene, i)) continue;
    const auto k = static_cast<std::size_t>(i);
    if (options.pattern == Pattern::polar) first.push_back(std::hypot(scene.u[k], scene.v[k]));
    if (options.pattern == Pattern::grid) first.push_back(scene.u[k]), second.push_back(scene.v[k]);
    if (options.pattern == Pattern::cells || options.pattern == Pattern::distance)
      first.push_back(distance_at(scene, i));
  }
  if (first.empty()) return 1;
  const Range range = robust_range(std::move(first));
  double exact = range.high / (options.pattern == Pattern::cells ? 4 : 12);
  if (!second.empty()) {
    const Range other = robust_range(std::move(second));
    exact = std::max(range.high - range.low, other.high - other.low) / 24;
  }
  if (!(exact > 0) || !std::isfinite(exact)) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(exact)));
  double best = power;
  for (const double step : {1.0, 2.0, 2.5, 5.0, 10.0})
    if (std::abs(std::log(step * power / exact)) < std::abs(std::log(best / exact))) best = step * power;
  return best;
}

}  // namespace ahm::render
