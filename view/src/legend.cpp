#include "legend.hpp"

#include <array>
#include <charconv>
#include <string>

#include "marks.hpp"

namespace ahm::view {
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
  /// The width of one ring below the wheel: |--| 0.05
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

/// The bar, with about five numbers at its ring lines.
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

}  // namespace ahm::view
