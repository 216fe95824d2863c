#include "annotations.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <string>

#include "picture.hpp"

namespace ahm::render {
namespace {

using Eigen::Vector2d;

double distance_to_line(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d d = b - a;
  const double length = d.squaredNorm(), t = length > 0 ? std::clamp((p - a).dot(d) / length, 0.0, 1.0) : 0;
  return (p - a - t * d).norm();
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Strokes of the letters: points on a grid 4 wide and 6 high (y up from the baseline); '/' ends a stroke. Polylines with enough points
// look like curves at the sizes used.
constexpr std::string_view letters = "0123456789.-+euv";
constexpr std::array<std::string_view, letters.size()> strokes = {
    "20 11 02 04 15 26 35 44 42 31 20",           // 0
    "14 26 20",                                   // 1
    "04 15 26 35 44 43 00 40",                    // 2
    "05 16 26 35 44 33 23/33 42 41 30 10 01",     // 3
    "30 36 02 42",                                // 4
    "36 06 03 13 24 33 42 41 30 10 01",           // 5
    "36 16 04 02 01 10 30 41 42 33 13 02",        // 6
    "06 46 10",                                   // 7
    "23 14 05 16 36 45 34 12 01 10 30 41 32 23",  // 8
    "43 32 12 03 05 16 36 45 43 41 30 10",        // 9
    "00 00",                                      // .
    "03 33",                                      // -
    "03 43/21 25",                                // +
    "02 42 43 34 14 03 01 10 30",                 // e
    "04 01 10 20 42/44 40",                       // u
    "04 20 44",                                   // v
};

}  // namespace

/// Fills the region of negative signed distance; the edge is antialiased over half a pixel on each side.
template <class PaintAt, class Distance>
void Pen::fill(Vector2d low, Vector2d high, const PaintAt& color_at, const Distance& distance) {
  const auto clip = [](double x, int size) { return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(size))); };
  for (int y = clip(low.y() - 1, image_.height); y < clip(high.y() + 2, image_.height); ++y)
    for (int x = clip(low.x() - 1, image_.width); x < clip(high.x() + 2, image_.width); ++x) {
      const Vector2d place(x + 0.5, y + 0.5);
      const double cover = std::clamp(0.5 - distance(place), 0.0, 1.0);
      if (cover <= 0) continue;
      const Color color = color_at(place);
      std::uint8_t* p = image_.pixel(x, y);
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = static_cast<std::uint8_t>(std::lround(p[k] + cover * (static_cast<double>(color[k]) - p[k])));
    }
}

void Pen::disc(const Vector2d& center, double radius, Color color) {
  disc(center, radius, [=](const Vector2d&) { return color; });
}

void Pen::disc(const Vector2d& center, double radius, const ColorAt& color) {
  const Vector2d r(radius, radius);
  fill(center - r, center + r, color, [&](const Vector2d& p) { return (p - center).norm() - radius; });
}

void Pen::box(Vector2d low, Vector2d high, const ColorAt& color) {
  fill(low, high, color, [&](const Vector2d& p) { return (low - p).cwiseMax(p - high).maxCoeff(); });
}

void Pen::line(Vector2d from, Vector2d to, double width, Color color) {
  const Vector2d r(width, width);
  fill(
      from.cwiseMin(to) - r, from.cwiseMax(to) + r, [=](const Vector2d&) { return color; },
      [&](const Vector2d& p) { return distance_to_line(p, from, to) - width / 2; });
}

void Pen::triangle(Vector2d a, Vector2d b, Vector2d c, double rounding, Color color) {
  const Vector2d r(rounding, rounding);
  fill(
      a.cwiseMin(b).cwiseMin(c) - r, a.cwiseMax(b).cwiseMax(c) + r, [=](const Vector2d&) { return color; },
      [&](const Vector2d& p) {
        const double edge = std::min({distance_to_line(p, a, b), distance_to_line(p, b, c), distance_to_line(p, c, a)});
        const bool first = cross(b - a, p - a) > 0, second = cross(c - b, p - b) > 0, third = cross(a - c, p - c) > 0;
        return (first == second && second == third ? -edge : edge) - rounding;
      });
}

double Pen::text(Vector2d at, double height, double stroke, std::string_view text, Color color) {
  const double unit = height / 6;
  double x = 0;
  for (const char character : text) {
    const std::size_t letter = letters.find(character);
    if (letter == std::string_view::npos) {
      x += 4 * unit;
      continue;
    }
    const std::string_view path = strokes[letter];
    double advance = 0;
    for (std::size_t k = 0; k < path.size(); k += 3) {
      const auto point = [&](std::size_t i) {
        return Vector2d(at.x() + x + (path[i] - '0') * unit, at.y() - (path[i + 1] - '0') * unit);
      };
      advance = std::max(advance, (path[k] - '0') * unit);
      if (k + 2 < path.size() && path[k + 2] == ' ') line(point(k), point(k + 3), stroke, color);
    }
    x += advance + 2 * unit;
  }
  return x - 2 * unit;
}

namespace {

using Eigen::Vector2d;
using glsl::vec2;

constexpr float wheel_rings = 4;

std::string shortest(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6).ptr;
  return {text.data(), end};
}

Color as_color(glsl::vec3 light) {
  const auto byte = [](float x) { return glsl::to_srgb_byte(static_cast<std::uint16_t>(std::lround(65535 * x))); };
  return {byte(light.x), byte(light.y), byte(light.z)};
}

class Wheel {
 public:
  Wheel(Image& image, const Material& material)
      : pen_(image),
        material_(material),
        unit_(std::min(image.width, image.height) / 1200.0),
        radius_(68 * unit_),
        center_(radius_ + 36 * unit_, image.height - radius_ - 60 * unit_) {}

  void draw(double ring_width) {
    pen_.disc(center_, 1.12 * radius_, white);
    const auto step = static_cast<float>(wheel_rings / radius_);
    pen_.disc(center_, radius_, [&](const Vector2d& p) {
      const Vector2d d = p - center_;
      const vec2 uv = vec2(static_cast<float>(d.x()), static_cast<float>(-d.y())) * step;
      return as_color(glsl::map_color(static_cast<int>(material_.pattern), uv, vec2(step, 0), vec2(0, step),
                                      material_.sectors, material_.rings));
    });
    draw_scale(ring_width);
    draw_axes();
  }

 private:
  /// Draws the width of a ring below the wheel, as |--| 0.05
  void draw_scale(double ring_width) {
    const double y = center_.y() + radius_ + 16 * unit_, tick = 5 * unit_;
    const double left = center_.x() - radius_, right = left + radius_ / wheel_rings;
    for (const auto& [width, color] : {std::pair{5 * unit_, white}, std::pair{2 * unit_, ink}}) {
      pen_.line({left, y}, {right, y}, width, color);
      for (const double x : {left, right}) pen_.line({x, y - tick}, {x, y + tick}, width, color);
    }
    draw_text(pen_, {right + 9 * unit_, y + 6.5 * unit_}, 13 * unit_, unit_, shortest(ring_width));
  }

  void draw_axes() {
    const double length = 0.72 * radius_;
    const Arrow u{center_, center_ + Vector2d(length, 0), 2 * unit_},
        v{center_, center_ + Vector2d(0, -length), 2 * unit_};
    draw_arrows(pen_, {u, v}, unit_);
    draw_text(pen_, u.to + Vector2d(0.28 * radius_ + 12 * unit_, 4 * unit_), 12 * unit_, unit_, "u");
    draw_text(pen_, v.to + Vector2d(-4 * unit_, -0.28 * radius_ - 12 * unit_), 12 * unit_, unit_, "v");
    pen_.disc(center_, 4 * unit_, white);
    pen_.disc(center_, 3 * unit_, red);
  }

  Pen pen_;
  const Material& material_;
  double unit_, radius_;
  Vector2d center_;
};

/// Draws the color bar, with at most seven numbers at ring lines.
void draw_bar(Image& image, const Material& material, double ring_width) {
  const double unit = std::min(image.width, image.height) / 1200.0, rings = material.rings;
  const double left = 40 * unit, width = 26 * unit, height = 300 * unit, bottom = image.height - 50 * unit;
  Pen pen(image);
  const auto level = [&](double ring) { return bottom - height * ring / rings; };
  pen.box({left - 3 * unit, bottom - height - 3 * unit}, {left + width + 3 * unit, bottom + 3 * unit},
          [](const Vector2d&) { return white; });
  const auto step = static_cast<float>(rings / height);
  pen.box({left, bottom - height}, {left + width, bottom}, [&](const Vector2d& p) {
    const vec2 uv(static_cast<float>((bottom - p.y()) / height * rings), 0);
    return as_color(glsl::map_color(static_cast<int>(material.pattern), uv, vec2(0), vec2(step, 0), material.sectors,
                                    material.rings));
  });
  const int every = std::max(1, static_cast<int>(std::ceil(rings / 6)));
  for (int ring = 0; ring <= rings; ring += every) {
    pen.line({left + width, level(ring)}, {left + width + 7 * unit, level(ring)}, 2 * unit, ink);
    draw_text(pen, {left + width + 14 * unit, level(ring) + 6.5 * unit}, 13 * unit, unit, shortest(ring * ring_width));
  }
}

}  // namespace

void draw_legend(Image& image, const Material& material, double ring_width) {
  if (std::min(image.width, image.height) <= 300) return;
  if (material.pattern == Pattern::polar || material.pattern == Pattern::grid) Wheel(image, material).draw(ring_width);
  if (material.pattern == Pattern::distance && material.rings > 0) draw_bar(image, material, ring_width);
}

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Tolerances of the depth test, relative to the scene's size. A polyline cuts through a convex surface. In coarse or noisy clouds, discs
// around a point may be in front of it by twice their spacing; sheets closer than that cannot be distinguished.
constexpr double curve_tolerance = 0.02, cloud_tolerance = 0.06;

double dot_tolerance(const Scene& scene, double spacing) {
  if (scene.face_vertices.empty()) return std::clamp(2 * spacing, 0.004, cloud_tolerance);
  return std::clamp(spacing, 0.004, curve_tolerance);
}

void draw_arrow(Pen& pen, const Arrow& arrow, double grow, Color color) {
  const Vector2d d = arrow.to - arrow.from;
  const double length = d.norm();
  if (length < 3 * arrow.width) return;  // points along the line of sight
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

  /// Draws the curve in short pieces; each is either drawn or hidden.
  void draw_curve() {
    std::vector<Vector2d> pixels;  // two ends per visible piece
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
  double unit_;  ///< marks are scaled with the picture
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

}  // namespace ahm::render
