#include "direction.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "ahm/util/quantile.hpp"

namespace ahm::render {
namespace {

using Eigen::Vector3d;

constexpr std::size_t sample_size = 50'000;

/// Whether the picture shows a curve in one piece; otherwise it shows the source.
bool is_about_curve(const Scene& scene) { return !scene.curve.empty() && scene.curve_pieces.empty(); }

/// The source, or points along the curve.
std::vector<Vec3> places(const Scene& scene) {
  if (!is_about_curve(scene)) return {scene.source};
  constexpr std::size_t most = 16;
  const std::size_t count = std::min(most, scene.curve.size());
  std::vector<Vec3> result;
  for (std::size_t k = 0; k < count; ++k) result.push_back(scene.curve[k * scene.curve.size() / count]);
  return result;
}

/// The scene's normal of the point nearest to a position; zero if there is none.
Vector3d nearest_normal(const Scene& scene, const std::vector<Index>& shown, const Vec3& place) {
  Vector3d normal = Vector3d::Zero();
  if (scene.normals.empty()) return normal;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Index i : shown) {
    const auto k = static_cast<std::size_t>(i);
    const double distance = (as_vector(scene.points[k]) - as_vector(place)).stableNorm();
    if (distance >= nearest || !as_vector(scene.normals[k]).allFinite()) continue;
    nearest = distance;
    normal = as_vector(scene.normals[k]).normalized();
  }
  return normal;
}

/// The normal at the source: from its axes, or else of the nearest point; zero if there is none. For a curve: the mean normal.
Vector3d mean_normal(const Scene& scene, const std::vector<Index>& shown) {
  if (scene.source_axes && !is_about_curve(scene)) return as_vector((*scene.source_axes)[2]).normalized();
  Vector3d sum = Vector3d::Zero();
  for (const Vec3& place : places(scene)) sum += nearest_normal(scene, shown, place);
  return sum.norm() > 0 ? Vector3d(sum.normalized()) : sum;
}

/// A tube along the line of sight. Points inside it obstruct the view. Lengths in units of the scene's size.
struct Tube {
  double start, radius;
};

/// Number of sampled points that obstruct the view: those in tubes from the positions towards the camera.
std::size_t blockers(const Scene& scene, const std::vector<Index>& shown, const Camera& camera,
                     const Vector3d& direction, const Tube& tube) {
  const auto [start, radius] = tube;
  std::size_t count = 0;
  for (const Vec3& position : places(scene)) {
    const Vector3d place = camera.to_scene(position);
    const std::size_t stride = shown.size() / sample_size + 1;
    for (std::size_t k = 0; k < shown.size(); k += stride) {
      const Vector3d d = camera.to_scene(scene.points[shown[k]]) - place;
      const double along = d.dot(direction);
      if (along > start && (d - along * direction).squaredNorm() < radius * radius) ++count;
    }
  }
  return count;
}

/// A tube for clouds, with the distance from the source to its neighbors as radius, to distinguish front and back of a stem or a sheet.
Tube thin_tube(const Scene& scene, const std::vector<Index>& shown, const Camera& camera) {
  constexpr std::size_t around = 6;
  const Vector3d source = camera.to_scene(scene.source);
  std::vector<double> squares;
  for (const Index i : shown) {
    const double squared = (camera.to_scene(scene.points[static_cast<std::size_t>(i)]) - source).squaredNorm();
    if (squared > 0) squares.push_back(squared);
  }
  if (squares.empty()) return {};
  const std::size_t k = std::min(around, squares.size()) - 1;
  const double radius = std::sqrt(detail::value_at(squares, k));
  return {2 * radius, radius};
}

/// Computes the part of the map that is hidden behind unmapped parts, in 50ths, in perspective.
class Cover {
 public:
  Cover(const Scene& scene, const std::vector<Index>& shown, const Camera& camera) {
    if (!scene.face_vertices.empty()) {
      add_faces(scene, camera);
      return;
    }
    const std::size_t stride = shown.size() / sample_size + 1;
    for (std::size_t k = 0; k < shown.size(); k += stride)
      (has_coordinate(scene, shown[k]) ? mapped_ : others_).push_back(camera.to_scene(scene.points[shown[k]]));
  }

  std::size_t operator()(const Vector3d& direction) {
    if (mapped_.empty() || others_.empty()) return 0;
    nearest_.fill(-std::numeric_limits<double>::infinity());
    const Vector3d x = direction.unitOrthogonal(), y = direction.cross(x);
    for (const Vector3d& p : others_)
      if (double* there = cell(p, direction, x, y)) *there = std::max(*there, p.dot(direction));
    std::size_t behind = 0;
    for (const Vector3d& p : mapped_)
      if (const double* there = cell(p, direction, x, y)) behind += *there > p.dot(direction) + width ? 1 : 0;
    return 50 * behind / mapped_.size();
  }

 private:
  static constexpr std::size_t side = 64;
  static constexpr double width = 0.05;
  /// Points farther than this from the center of the scene do not hide the map.
  static constexpr double reach = 4, disc = std::numbers::pi * reach * reach;
  static constexpr double most_points = 1e6;

  struct FaceTriangle {
    Vector3d a, b, c;

    double area() const { return 0.5 * (b - a).cross(c - a).stableNorm(); }

    /// Adds points of a lattice with the step, in a square with half side `reach` around the center of the scene. Its lines are parallel
    /// to the side a c.
    void add_points(double step, std::vector<Vector3d>& points) const {
      const Vector3d side = c - a, along = side.stableNormalized();
      const Vector3d rise = (b - a) - (b - a).dot(along) * along, across = rise.stableNormalized();
      const double length = side.stableNorm(), height = rise.stableNorm();
      if (!std::isfinite(length + height)) return;
      const double rows = std::max(1.0, std::ceil(height / step)), columns = std::max(1.0, std::ceil(length / step));
      const auto [first_row, last_row] = within(a.dot(across), height, rows, rows);
      for (double i = first_row; i < last_row; ++i) {
        const Vector3d start = a + (i + third) / rows * (b - a);
        const auto [first, last] = within(start.dot(along), length, columns, std::ceil(columns * (1 - i / rows)));
        for (double j = first; j < last; ++j) points.emplace_back(start + (j + third) / columns * side);
      }
    }

   private:
    static constexpr double third = 1.0 / 3;

    /// The k from 0 up to `count` with |begin + (k + 1/3) length / parts| <= reach, as a half-open range.
    static std::pair<double, double> within(double begin, double length, double parts, double count) {
      if (!(length > 0)) return {0, std::min(count, 1.0)};
      const auto place = [&](double x) { return (x - begin) / length * parts - third; };
      return {std::max(0.0, std::ceil(place(-reach))), std::min(count, std::floor(place(reach)) + 1)};
    }
  };

  /// Adds points on faces: on mapped ones, and on those without a coordinate at any corner. The points are dense enough to hit every cell,
  /// unless that needs more than `most_points`.
  void add_faces(const Scene& scene, const Camera& camera) {
    const std::size_t faces = scene.face_begin.size() - 1, stride = faces / sample_size + 1;
    std::vector<Vector3d> corners;
    std::vector<FaceTriangle> mapped, others;
    double area = 0;
    for (std::size_t f = 0; f < faces; f += stride) {
      std::size_t known = 0;
      corners.clear();
      for (Offset k = scene.face_begin[f]; k < scene.face_begin[f + 1]; ++k) {
        const Index vertex = scene.face_vertices[static_cast<std::size_t>(k)];
        known += has_coordinate(scene, vertex) ? 1 : 0;
        corners.push_back(camera.to_scene(scene.points[static_cast<std::size_t>(vertex)]));
      }
      if (known > 0 && known < corners.size()) continue;
      for (std::size_t k = 2; k < corners.size(); ++k) {
        const FaceTriangle triangle{corners[0], corners[k - 1], corners[k]};
        area += std::min(triangle.area(), disc);
        (known > 0 ? mapped : others).push_back(triangle);
      }
    }
    const double step = std::max(width, std::sqrt(area / most_points));
    for (const FaceTriangle& triangle : mapped) triangle.add_points(step, mapped_);
    for (const FaceTriangle& triangle : others) triangle.add_points(step, others_);
  }
  /// The cell of a raster of the picture that contains the projection of p; null outside. Cells have the size `width` at the center of the
  /// scene.
  double* cell(const Vector3d& p, const Vector3d& direction, const Vector3d& x, const Vector3d& y) {
    const double away = 1 / std::tan(Camera::field_of_view / 2), depth = 1 - p.dot(direction) / away;
    if (depth < 0.1) return nullptr;
    const double column = p.dot(x) / depth / width + side / 2.0, row = p.dot(y) / depth / width + side / 2.0;
    if (!(column >= 0 && column < side && row >= 0 && row < side)) return nullptr;
    return &nearest_[static_cast<std::size_t>(row) * side + static_cast<std::size_t>(column)];
  }

  std::vector<Vector3d> mapped_, others_;
  std::array<double, side * side> nearest_{};
};

/// Of 200 directions on a sphere, the unobstructed one that is the most similar to a candidate; nullopt if all are obstructed.
std::optional<Vector3d> through_a_gap(const Scene& scene, const std::vector<Index>& shown, const Camera& camera,
                                      const std::vector<Vector3d>& candidates, const auto& is_behind) {
  const double spacing = 1.2 / std::sqrt(static_cast<double>(std::min(shown.size(), sample_size)));
  const Tube narrow{2 * std::max(spacing, 0.02), std::max(spacing, 0.02)};
  std::optional<Vector3d> best;
  double most_alike = -1;
  constexpr int count = 200;
  for (int k = 0; k < count; ++k) {  // on a spiral
    const double z = 1 - (2.0 * k + 1) / count, ring = std::sqrt(1 - z * z), angle = 2.39996322972865 * k;
    const Vector3d direction(ring * std::cos(angle), ring * std::sin(angle), z);
    double alike = -1;
    for (const Vector3d& candidate : candidates) alike = std::max(alike, direction.dot(candidate));
    if (alike <= most_alike || is_behind(direction) || blockers(scene, shown, camera, direction, narrow) > 0) continue;
    most_alike = alike;
    best = direction;
  }
  return best;
}

}  // namespace

Vector3d choose_direction(const Scene& scene, const std::vector<Index>& shown, const Camera& camera,
                          const Vector3d& up_axis, const Vector3d& extent) {
  const Vector3d up = up_axis.normalized();
  Vector3d side = extent.x() < extent.z() ? Vector3d(1, 0, 0) : Vector3d(0, 0, 1);  // across the longer horizontal side
  if (std::abs(up.z()) > 0.9) side = extent.x() < extent.y() ? Vector3d(1, 0, 0) : Vector3d(0, -1, 0);
  const Vector3d normal = mean_normal(scene, shown);
  if (!(normal.norm() > 0)) return (side + 0.4 * up.cross(side) + 0.6 * up).normalized();

  const bool is_level = std::abs(normal.dot(up)) > 0.9;  // tilt more: a vertical view shows no relief
  const Vector3d lean = is_level ? side : up, turn = is_level ? up.cross(side) : normal.cross(up).normalized();
  const double amount = is_level ? 0.9 : 0.3;
  // Best first. Both signs of the normal are candidates, because scans have normals of either sign.
  constexpr std::array<std::array<double, 2>, 7> tilts{
      {{1, 0.35}, {1, -0.35}, {0.5, 0.15}, {0.5, -0.15}, {2, 0}, {0, 0}, {-0.5, 0}}};
  std::vector<Vector3d> candidates;
  for (const double sign : {1.0, -1.0}) {
    const Vector3d level = sign * (normal - normal.dot(up) * up);
    const Vector3d usual = (level.normalized() + 0.4 * up + 0.3 * turn).normalized();  // slightly from above
    if (usual.dot(sign * normal) > 0.5) candidates.push_back(usual);
    for (const auto& [a, b] : tilts) candidates.push_back((sign * normal + a * amount * lean + b * turn).normalized());
  }
  Vector3d best = normal;
  constexpr Tube wide{0.08, 0.05};
  Cover cover(scene, shown, camera);
  const bool is_cloud = scene.face_vertices.empty();
  const Tube thin = is_cloud ? thin_tube(scene, shown, camera) : Tube{};
  const auto is_behind = [&](const Vector3d& direction) {
    return is_cloud && blockers(scene, shown, camera, direction, thin) > 2;
  };
  // Compared in this order: obstructions of the source, more than noise close to the source, hidden parts of the map.
  std::array<std::size_t, 3> fewest{std::numeric_limits<std::size_t>::max(), 0, 0};
  for (const Vector3d& direction : candidates) {
    const std::array count{blockers(scene, shown, camera, direction, wide), std::size_t{is_behind(direction)},
                           cover(direction)};
    if (count >= fewest) continue;
    fewest = count;
    best = direction;
  }
  return fewest[0] == 0 ? best : through_a_gap(scene, shown, camera, candidates, is_behind).value_or(best);
}

}  // namespace ahm::render
