#include "ahm/view/textured_picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ahm/error.hpp"
#include "camera.hpp"

namespace ahm::view {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int samples = 2;  ///< per pixel and direction

/// A corner of a triangle on its way to the screen.
struct Corner {
  Vector3d pixel;  ///< column, row, 1 / depth
  Vector3d normal;
  Vector2d texture{0, 0};
};

class Canvas {
 public:
  Canvas(int width, int height, const Camera& camera)
      : width_(samples * width), height_(samples * height), camera_(camera) {
    const auto count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    color_.assign(count, Eigen::Vector3f(1, 1, 1));
    nearness_.assign(count, 0.f);
  }

  /// False behind the camera.
  bool project(const Vec3& x, Corner& corner) const {
    const Vector3d view = camera_.to_view(camera_.to_scene(x));
    if (!(view.z() < -camera_.near_plane)) return false;
    const Vector3d pixel = camera_.to_pixels(camera_.to_scene(x), width_, height_);
    corner.pixel = {pixel.x(), pixel.y(), -1 / view.z()};
    return true;
  }

  /// `paint(texture place)`: colour and opacity.
  template <class Paint>
  void triangle(const std::array<Corner, 3>& t, bool transparent, const Paint& paint) {
    const Vector2d a = t[0].pixel.head<2>(), b = t[1].pixel.head<2>(), c = t[2].pixel.head<2>();
    const double area = cross(b - a, c - a);
    if (!(std::abs(area) > 1e-12)) return;
    const Vector2d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const int first = static_cast<int>(std::max(0.0, std::ceil(low.x() - 0.5))),
              last = static_cast<int>(std::min(width_ - 1.0, std::floor(high.x() - 0.5)));
    for (int y = static_cast<int>(std::max(0.0, std::ceil(low.y() - 0.5)));
         y <= std::min(height_ - 1.0, std::floor(high.y() - 0.5)); ++y)
      for (int x = first; x <= last; ++x) {
        const Vector2d p(x + 0.5, y + 0.5);
        Vector3d w(cross(b - p, c - p) / area, cross(c - p, a - p) / area, 0);
        w.z() = 1 - w.x() - w.y();
        if (!(w.minCoeff() >= 0)) continue;
        for (int k = 0; k < 3; ++k) w[k] *= t[k].pixel.z();  // perspective
        const double nearness = w.sum();
        if (!is_seen(x, y, nearness)) continue;
        w /= nearness;
        const Vector2d place = w[0] * t[0].texture + w[1] * t[1].texture + w[2] * t[2].texture;
        put(x, y, nearness, w[0] * t[0].normal + w[1] * t[1].normal + w[2] * t[2].normal, paint(place), transparent);
      }
  }

  void disc(const Corner& corner, double radius, const std::array<double, 4>& color) {
    const double r = radius * pixels_per_unit() * corner.pixel.z();
    for (int y = static_cast<int>(std::max(0.0, corner.pixel.y() - r));
         y < std::min<double>(height_, corner.pixel.y() + r); ++y)
      for (int x = static_cast<int>(std::max(0.0, corner.pixel.x() - r));
           x < std::min<double>(width_, corner.pixel.x() + r); ++x)
        if (std::hypot(x + 0.5 - corner.pixel.x(), y + 0.5 - corner.pixel.y()) <= r && is_seen(x, y, corner.pixel.z()))
          put(x, y, corner.pixel.z(), corner.normal, color, false);
  }

  Image image() const {
    Image result(width_ / samples, height_ / samples);
    for (int y = 0; y < result.height; ++y)
      for (int x = 0; x < result.width; ++x) {
        Eigen::Vector3f sum = Eigen::Vector3f::Zero();
        for (int k = 0; k < samples * samples; ++k)
          sum += color_[at(samples * x + k % samples, samples * y + k / samples)] / (samples * samples);
        for (int c = 0; c < 3; ++c)
          result.pixel(x, y)[c] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(sum[c], 0.f, 1.f)));
        result.pixel(x, y)[3] = 255;
      }
    return result;
  }

 private:
  static double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  double pixels_per_unit() const { return 0.5 * height_ / std::tan(Camera::field_of_view / 2) / camera_.scale; }
  bool is_seen(int x, int y, double nearness) const { return nearness > nearness_[at(x, y)]; }

  void put(int x, int y, double nearness, const Vector3d& normal, const std::array<double, 4>& color,
           bool transparent) {
    const double opacity = transparent ? color[3] : 1;
    if (opacity <= 0) return;
    // A light over the viewer's shoulder; both sides of a surface are lit.
    const Vector3d light = (camera_.back + 0.45 * camera_.up - 0.3 * camera_.right).normalized();
    double shade = 1;
    if (const double norm = normal.norm(); norm > 0) {
      const double facing = normal.dot(camera_.back) < 0 ? -1 : 1;
      shade = 0.4 + 0.6 * std::max(0.0, facing * normal.dot(light) / norm);
    }
    Eigen::Vector3f& pixel = color_[at(x, y)];
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>((1 - opacity) * pixel[c] + opacity * shade * color[c]);
    if (!transparent) nearness_[at(x, y)] = static_cast<float>(nearness);
  }

  int width_, height_;
  const Camera& camera_;
  std::vector<Eigen::Vector3f> color_;
  std::vector<float> nearness_;  ///< 1 / depth of what is seen
};

void draw(Canvas& canvas, const io::MeshPart& part) {
  const auto paint = [&](const Vector2d& place) -> std::array<double, 4> {
    if (!part.texture) return {part.color[0], part.color[1], part.color[2], 1};
    return part.texture->sample(place.x(), place.y());
  };
  for (std::size_t f = 0; f < part.faces.size(); ++f)
    for (Offset k = part.faces.begin[f] + 1; k + 1 < part.faces.begin[f + 1]; ++k) {
      const std::array<Offset, 3> fan{part.faces.begin[f], k, k + 1};
      std::array<Corner, 3> corners;
      std::array<Vector3d, 3> x;
      bool visible = true;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto corner = static_cast<std::size_t>(fan[c]);
        const auto vertex = static_cast<std::size_t>(part.faces.vertices[corner]);
        x[c] = as_vector(part.points[vertex]);
        visible = visible && canvas.project(part.points[vertex], corners[c]);
        if (!part.texture_coordinates.empty())
          corners[c].texture = {part.texture_coordinates[2 * corner], part.texture_coordinates[2 * corner + 1]};
        if (!part.normals.empty()) corners[c].normal = as_vector(part.normals[vertex]);
      }
      if (!visible) continue;
      const Vector3d flat = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
      for (Corner& corner : corners)
        if (part.normals.empty() || !corner.normal.allFinite()) corner.normal = flat;
      canvas.triangle(corners, part.transparent, paint);
    }
}

/// All points of the scene, those of textured parts and coloured points as mapped, for the camera.
class Gathered {
 public:
  explicit Gathered(const TexturedScene& textured) {
    for (const io::MeshPart& part : textured.parts) {
      const auto first = static_cast<Index>(points_.size());
      add(part.points, part.normals);
      known_.insert(known_.end(), part.points.size(), part.texture ? 0.0 : std::numeric_limits<double>::quiet_NaN());
      if (faces_.empty()) faces_.push_back(0);
      for (std::size_t f = 0; f < part.faces.size(); ++f) {
        for (Offset c = part.faces.begin[f]; c < part.faces.begin[f + 1]; ++c)
          vertices_.push_back(first + part.faces.vertices[c]);
        faces_.push_back(static_cast<Offset>(vertices_.size()));
      }
    }
    add(textured.points, textured.normals);
    known_.insert(known_.end(), textured.points.size(), 0.0);
    scene.points = points_, scene.normals = normals_, scene.u = known_, scene.v = known_;
    if (textured.points.empty()) scene.face_begin = faces_, scene.face_vertices = vertices_;
    scene.source = textured.towards;
  }
  Gathered(const Gathered&) = delete;

  Scene scene;

 private:
  void add(std::span<const Vec3> points, std::span<const Vec3> normals) {
    points_.insert(points_.end(), points.begin(), points.end());
    normals_.insert(normals_.end(), normals.begin(), normals.end());
    normals_.resize(points_.size(), Vec3{});
  }

  std::vector<Vec3> points_, normals_;
  std::vector<double> known_;
  std::vector<Offset> faces_;
  std::vector<Index> vertices_;
};

void check(const TexturedScene& scene, const PictureOptions& options) {
  if (std::min(options.width, options.height) < 16 || std::max(options.width, options.height) > 8192)
    throw InvalidArgument("options: a picture of " + std::to_string(options.width) + " x " +
                          std::to_string(options.height) + " pixels; give 16 to 8192 each");
  if (scene.colors.size() != scene.points.size() || scene.radii.size() != scene.points.size() ||
      (!scene.normals.empty() && scene.normals.size() != scene.points.size()))
    throw InvalidArgument("scene: " + std::to_string(scene.points.size()) + " points, " +
                          std::to_string(scene.colors.size()) + " colors, " + std::to_string(scene.radii.size()) +
                          " radii and " + std::to_string(scene.normals.size()) + " normals do not fit together");
}

}  // namespace

void write_textured_png(const std::filesystem::path& path, const TexturedScene& scene, const PictureOptions& options) {
  check(scene, options);
  const Gathered gathered(scene);
  const Camera camera = choose_camera(gathered.scene, shown_points(gathered.scene), options);
  Canvas canvas(options.width, options.height, camera);
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    Corner corner;
    if (!as_vector(scene.points[i]).allFinite() || !canvas.project(scene.points[i], corner)) continue;
    corner.normal = scene.normals.empty() || !as_vector(scene.normals[i]).allFinite() ? Vector3d::Zero().eval()
                                                                                      : as_vector(scene.normals[i]);
    const auto& c = scene.colors[i];
    canvas.disc(corner, scene.radii[i], {c[0] / 255.0, c[1] / 255.0, c[2] / 255.0, 1});
  }
  for (bool transparent : {false, true})
    for (const io::MeshPart& part : scene.parts)
      if (part.transparent == transparent) draw(canvas, part);
  io::write_png(path, canvas.image());
}

}  // namespace ahm::view
