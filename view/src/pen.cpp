#include "pen.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace ahm::view {
namespace {

using Eigen::Vector2d;

double distance_to_line(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d d = b - a;
  const double length = d.squaredNorm(), t = length > 0 ? std::clamp((p - a).dot(d) / length, 0.0, 1.0) : 0;
  return (p - a - t * d).norm();
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Strokes of a letter: points on a grid 4 wide and 6 high (y up from the base line), a stroke ends with '/'.
// Curves are given by enough points to look round at the sizes used.
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

/// Paints where the signed distance is negative, with half a pixel of soft edge.
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

}  // namespace ahm::view
