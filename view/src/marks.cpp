#include "marks.hpp"

#include <algorithm>

#include "render.hpp"

namespace ahm::view {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Of the scene's size: a polyline dips into what bulges. The discs around a point of a coarse or noisy cloud may stand twice
// as far before it as they are apart; surfaces nearer to each other than that are one to clouds.
constexpr double curve_tolerance = 0.02, cloud_tolerance = 0.06;

double dot_tolerance(const Scene& scene, double spacing) {
  if (scene.face_vertices.empty()) return std::clamp(2 * spacing, 0.004, cloud_tolerance);
  return std::clamp(spacing, 0.004, curve_tolerance);
}

void draw_arrow(Pen& pen, const Arrow& arrow, double grow, Color color) {
  const Vector2d d = arrow.to - arrow.from;
  const double length = d.norm();
  if (length < 3 * arrow.width) return;  // seen end on
  const Vector2d along = d / length, across(-along.y(), along.x());
  const double head = std::min(4.5 * arrow.width, 0.6 * length);
  const Vector2d neck = arrow.to - head * along;
  pen.line(arrow.from, neck, arrow.width + 2 * grow, color);
  pen.triangle(arrow.to, neck + 0.42 * head * across, neck - 0.42 * head * across, grow, color);
}

void draw_letter(Pen& pen, const Arrow& arrow, double unit, std::string_view letter) {
  const Vector2d d = arrow.to - arrow.from;
  if (d.norm() < 6 * unit) return;
  const Vector2d at = arrow.to + 11 * unit * d.normalized() + Vector2d(-4 * unit, 4 * unit);
  draw_text(pen, at, 12 * unit, unit, letter);
}

void draw_dot(Pen& pen, const Vector2d& at, double radius, double rim, Color color) {
  pen.disc(at, radius + rim, white);
  pen.disc(at, radius, color);
}

class Marks {
 public:
  Marks(Image& image, const Film& film, const Scene& scene, const Camera& camera, double spacing)
      : film_(film),
        scene_(scene),
        camera_(camera),
        pen_(image),
        unit_(std::max(std::min(image.width, image.height) / 1200.0, 0.35)),
        dot_tolerance_(dot_tolerance(scene, spacing)) {}

  void draw() {
    draw_curve();
    for (const Vec3& dot : scene_.dots) {
      const Vector3d place = camera_.to_scene(dot);
      if (shows(film_, camera_, place, dot_tolerance_)) draw_dot(pen_, pixel(place), 6 * unit_, 2 * unit_, red);
    }
    draw_source();
  }

 private:
  Vector2d pixel(const Vector3d& place) const { return camera_.to_pixels(place, film_.width, film_.height).head<2>(); }

  /// In pieces short enough that each is seen or hidden on the whole.
  void draw_curve() {
    std::vector<Vector2d> pixels;  // two per visible piece
    for (std::size_t k = 0; k + 1 < scene_.curve.size(); ++k) {
      const auto& pieces = scene_.curve_pieces;
      if (std::binary_search(pieces.begin(), pieces.end(), static_cast<Index>(k + 1))) continue;
      const Vector3d a = camera_.to_scene(scene_.curve[k]), b = camera_.to_scene(scene_.curve[k + 1]);
      const double length = std::max((b - a).norm() / curve_tolerance, (pixel(b) - pixel(a)).norm() / (3 * unit_));
      const int steps = 1 + static_cast<int>(std::min(length, 1000.0));
      for (int p = 0; p < steps; ++p) {
        const Vector3d from = a + p * (b - a) / steps, to = a + (p + 1) * (b - a) / steps;
        if (shows(film_, camera_, (from + to) / 2, curve_tolerance))
          pixels.insert(pixels.end(), {pixel(from), pixel(to)});
      }
    }
    for (const auto& [width, color] : {std::pair{8 * unit_, white}, std::pair{5 * unit_, red}})
      for (std::size_t k = 0; k < pixels.size(); k += 2) pen_.line(pixels[k], pixels[k + 1], width, color);
  }

  void draw_source() {
    const Vector3d source = camera_.to_scene(scene_.source);
    if (!shows(film_, camera_, source, dot_tolerance_)) return;
    const Vector2d center = pixel(source);
    if (scene_.source_axes) {
      const double length = 70 * unit_ / camera_.to_pixels(source, film_.width, film_.height).z();
      std::vector<Arrow> arrows;
      for (std::size_t k = 0; k < 2; ++k) {
        const Vector3d tip = source + length * as_vector((*scene_.source_axes)[k]).normalized();
        arrows.push_back({center, pixel(tip), 3 * unit_});
      }
      draw_arrows(pen_, arrows, unit_);
      for (std::size_t k = 0; k < 2; ++k) draw_letter(pen_, arrows[k], unit_, k == 0 ? "u" : "v");
    }
    draw_dot(pen_, center, 8 * unit_, 2.5 * unit_, red);
  }

  const Film& film_;
  const Scene& scene_;
  const Camera& camera_;
  Pen pen_;
  double unit_;  ///< marks keep their share of the picture
  double dot_tolerance_;
};

}  // namespace

void draw_arrows(Pen& pen, const std::vector<Arrow>& arrows, double unit) {
  for (const Arrow& arrow : arrows) draw_arrow(pen, arrow, 1.6 * unit, white);
  for (const Arrow& arrow : arrows) draw_arrow(pen, arrow, 0, ink);
}

void draw_text(Pen& pen, const Vector2d& at, double height, double unit, std::string_view text) {
  pen.text(at, height, 5 * unit, text, white);
  pen.text(at, height, 2 * unit, text, ink);
}

void draw_marks(Image& image, const Film& film, const Scene& scene, const Camera& camera, double spacing) {
  Marks(image, film, scene, camera, spacing).draw();
}

}  // namespace ahm::view
