#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "drawable.hpp"

namespace ahm::render {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double crease_cosine = 0.7;  // edges with more than 45 degrees between their faces stay sharp

Vector3d area_vector(const std::vector<Vector3d>& points, const Triangle& t) {
  const auto& [a, b, c] = t;
  const auto at = [&](Index i) -> const Vector3d& { return points[i]; };
  return (at(b) - at(a)).cross(at(c) - at(a)) / 2;
}

/// Triangulates a polygon as a fan. Chooses the corner from which the triangles have the same orientation as the polygon, which
/// exists for most non-convex polygons.
void triangulate(const std::vector<Vector3d>& points, std::size_t face, std::span<const Index> polygon,
                 std::vector<Triangle>& triangles, std::vector<TriangleOrigin>& origins) {
  const std::size_t n = polygon.size();
  const auto fan = [&](std::size_t apex, std::size_t k) {
    return Triangle{polygon[apex], polygon[(apex + k) % n], polygon[(apex + k + 1) % n]};
  };
  std::size_t best = 0;
  if (n > 3) {
    Vector3d whole = Vector3d::Zero();
    for (std::size_t k = 1; k + 1 < n; ++k) whole += area_vector(points, fan(0, k));
    double best_area = -std::numeric_limits<double>::infinity();
    for (std::size_t apex = 0; apex < n; ++apex) {
      double smallest = std::numeric_limits<double>::infinity();
      for (std::size_t k = 1; k + 1 < n; ++k)
        smallest = std::min(smallest, area_vector(points, fan(apex, k)).dot(whole));
      if (!(smallest > best_area)) continue;
      best_area = smallest;
      best = apex;
    }
  }
  const auto corner = [n](std::size_t k) { return static_cast<std::uint16_t>(k % n); };
  for (std::size_t k = 1; k + 1 < n; ++k) {
    triangles.push_back(fan(best, k));
    origins.push_back({static_cast<Index>(face),
                       {corner(best), corner(best + k), corner(best + k + 1)},
                       static_cast<std::uint16_t>(n)});
  }
}

/// Builds the drawable of a mesh. Corners of a point with the same normal share a vertex.
class SurfaceBuilder {
 public:
  SurfaceBuilder(const Scene& scene, const Camera& camera, const Paint& paint)
      : paint_(paint), rings_per_length_(camera.scale / paint.ring_width) {
    const std::size_t n = scene.points.size();
    points_.reserve(n);
    for (std::size_t i = 0; i < n; ++i) points_.push_back(camera.to_scene(scene.points[i]));
    for (std::size_t f = 0; f + 1 < scene.face_begin.size(); ++f) {
      const auto begin = static_cast<std::size_t>(scene.face_begin[f]),
                 end = static_cast<std::size_t>(scene.face_begin[f + 1]);
      const std::span<const Index> polygon = scene.face_vertices.subspan(begin, end - begin);
      bool usable = polygon.size() >= 3;
      for (const Index i : polygon) usable = usable && points_[i].allFinite();
      if (usable) triangulate(points_, f, polygon, triangles_, origins_);
    }
  }

  Drawable build() {
    find_corners();
    out_.origins = std::move(origins_);
    shared_.resize(points_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      std::array<std::uint32_t, 3> vertex;
      for (std::size_t k = 0; k < 3; ++k) vertex[k] = shared_vertex(triangles_[t][k], corner_normal(t, k));
      if (is_torn(triangles_[t]))
        add_torn(vertex);
      else
        out_.triangles.insert(out_.triangles.end(), vertex.begin(), vertex.end());
    }
    return std::move(out_);
  }

 private:
  void find_corners() {
    areas_.reserve(triangles_.size());
    corner_begin_.assign(points_.size() + 1, 0);
    for (const Triangle& t : triangles_) {
      areas_.push_back(area_vector(points_, t));
      for (const Index i : t) ++corner_begin_[static_cast<std::size_t>(i) + 1];
    }
    for (std::size_t i = 0; i < points_.size(); ++i) corner_begin_[i + 1] += corner_begin_[i];
    triangle_of_corner_.resize(3 * triangles_.size());
    std::vector<std::size_t> next(corner_begin_.begin(), corner_begin_.end() - 1);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (const Index i : triangles_[t]) triangle_of_corner_[next[i]++] = t;
  }

  /// Area-weighted mean of the normals of triangles around the corner, without those beyond the crease angle from this triangle.
  Vector3d corner_normal(std::size_t triangle, std::size_t corner) const {
    const auto vertex = static_cast<std::size_t>(triangles_[triangle][corner]);
    const Vector3d own = areas_[triangle].normalized();
    Vector3d sum = Vector3d::Zero();
    for (std::size_t k = corner_begin_[vertex]; k < corner_begin_[vertex + 1]; ++k) {
      const Vector3d& area = areas_[triangle_of_corner_[k]];
      if (!(area.dot(own) < crease_cosine * area.norm())) sum += area;
    }
    return sum.norm() > 0 ? sum.normalized() : own;
  }

  std::uint32_t add(Index point, const Vector3d& position, const Vector3d& normal, const Vector3d& value, float known) {
    out_.points.push_back(point);
    out_.positions.push_back(position.cast<float>());
    out_.normals.push_back(normal.cast<float>());
    out_.values.push_back(value.cast<float>());
    out_.known.push_back(known);
    return static_cast<std::uint32_t>(out_.positions.size() - 1);
  }

  std::uint32_t shared_vertex(Index point, const Vector3d& normal) {
    const auto i = static_cast<std::size_t>(point);
    for (const std::uint32_t candidate : shared_[i])
      if ((out_.normals[candidate].cast<double>() - normal).norm() < 1e-3) return candidate;
    const Vector2d& uv = paint_.uv[i];
    shared_[i].push_back(add(point, points_[i], normal, {uv.x(), uv.y(), paint_.quality[i]}, paint_.known[i]));
    return shared_[i].back();
  }

  /// Whether the map jumps between two corners: their coordinates are much farther apart than the corners (and, around a source, in
  /// different directions). Geodesics arrive there from two sides. Interpolation would draw a bundle of stripes. For cells: whether
  /// the color changes.
  bool is_torn(const Triangle& t) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(t[k]), j = static_cast<std::size_t>(t[(k + 1) % 3]);
      const Vector2d &a = paint_.uv[i], &b = paint_.uv[j];
      if (paint_.known[i] == 0 || paint_.known[j] == 0) return false;
      if (paint_.pattern == Pattern::cells) {
        if (a.x() != b.x()) return true;
        continue;
      }
      const bool turns = paint_.pattern == Pattern::grid || a.dot(b) < 0.94 * a.norm() * b.norm();
      if (turns && (a - b).norm() > 3 * rings_per_length_ * (points_[i] - points_[j]).norm()) return true;
    }
    return false;
  }

  /// The distance from the source, the curve or the cell's source, which is continuous where the map jumps.
  double distance(const Vector2d& uv) const {
    if (paint_.pattern == Pattern::polar) return uv.norm();
    return paint_.pattern == Pattern::grid ? std::abs(uv.y()) : uv.y();
  }

  Vector2d with_distance(const Vector2d& uv, double distance) const {
    if (paint_.pattern == Pattern::polar) return distance * uv.normalized();
    return {uv.x(), paint_.pattern == Pattern::grid ? std::copysign(distance, uv.y()) : distance};
  }

  /// Adds a torn triangle in six parts. Each corner keeps its direction up to the middle of the triangle; the distance is interpolated.
  void add_torn(const std::array<std::uint32_t, 3>& vertex) {
    const auto mean = [&](std::initializer_list<std::size_t> corners, Vector3d& position, Vector3d& normal) {
      double sum = 0;
      position = normal = Vector3d::Zero();
      for (const std::size_t k : corners) {
        position += out_.positions[vertex[k]].cast<double>() / static_cast<double>(corners.size());
        normal += out_.normals[vertex[k]].cast<double>();
        sum += distance(out_.values[vertex[k]].head<2>().cast<double>()) / static_cast<double>(corners.size());
      }
      normal.normalize();
      return sum;
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3, previous = (k + 2) % 3;
      const Vector3d own = out_.values[vertex[k]].cast<double>();
      const auto part = [&](std::initializer_list<std::size_t> corners) {
        Vector3d position, normal;
        const double shared = mean(corners, position, normal);
        const Vector2d uv = with_distance(own.head<2>(), shared);
        return add(out_.points[vertex[k]], position, normal, {uv.x(), uv.y(), own.z()}, 1);
      };
      const std::uint32_t a = part({k, next}), center = part({0, 1, 2}), b = part({k, previous});
      out_.triangles.insert(out_.triangles.end(), {vertex[k], a, center, vertex[k], center, b});
    }
  }

  const Paint& paint_;
  double rings_per_length_;  ///< length of the gradient of an isometric map, rings per unit of length
  std::vector<Vector3d> points_;
  std::vector<Triangle> triangles_;
  std::vector<TriangleOrigin> origins_;
  std::vector<Vector3d> areas_;
  std::vector<std::size_t> corner_begin_, triangle_of_corner_;
  std::vector<std::vector<std::uint32_t>> shared_;
  Drawable out_;
};

}  // namespace

Drawable make_surface(const Scene& scene, const Camera& camera, const Paint& paint) {
  return SurfaceBuilder(scene, camera, paint).build();
}

Drawable make_drawable(const Scene& scene, const std::vector<Index>& shown, const Camera& camera, const Paint& paint,
                       unsigned threads) {
  return scene.face_vertices.empty() ? make_splats(scene, shown, camera, paint, threads)
                                     : make_surface(scene, camera, paint);
}

float typical_spacing(const Drawable& drawable) {
  if (drawable.positions.empty()) return 0;
  if (!drawable.is_mesh()) {
    std::vector<float> radii = drawable.radii;
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    return *middle;
  }
  double sum = 0;
  for (std::size_t k = 0; k < drawable.triangles.size(); k += 3)
    sum += (drawable.positions[drawable.triangles[k]] - drawable.positions[drawable.triangles[k + 1]]).norm();
  return drawable.triangles.empty() ? 0 : static_cast<float>(3 * sum / static_cast<double>(drawable.triangles.size()));
}

}  // namespace ahm::render
