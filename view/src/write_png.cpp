#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/view/picture.hpp"

#ifdef AHM_VIEW_HAS_PNG

#include <algorithm>
#include <charconv>

#include "ahm/io/image.hpp"
#include "check.hpp"
#include "pen.hpp"
#include "render.hpp"

namespace ahm::view {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double mark_tolerance = 0.02;  // of the scene's size: a polyline dips into what bulges
constexpr Colour white = {255, 255, 255}, ink = {25, 25, 30}, red = {225, 20, 30};

std::string shortest(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6).ptr;
  return {text.data(), end};
}

struct Arrow {
  Vector2d from, to;
  double width;

  void draw(Pen& pen, double grow, Colour colour) const {
    const Vector2d d = to - from;
    const double length = d.norm();
    if (length < 3 * width) return;  // seen end on
    const Vector2d along = d / length, across(-along.y(), along.x());
    const double head = std::min(4.5 * width, 0.6 * length);
    const Vector2d neck = to - head * along;
    pen.line(from, neck, width + 2 * grow, colour);
    pen.triangle(to, neck + 0.42 * head * across, neck - 0.42 * head * across, grow, colour);
  }
};

/// Arrows first in white and wider, then in ink: they stay visible on any colour.
void draw_arrows(Pen& pen, const std::vector<Arrow>& arrows, double unit) {
  for (const Arrow& arrow : arrows) arrow.draw(pen, 1.6 * unit, white);
  for (const Arrow& arrow : arrows) arrow.draw(pen, 0, ink);
}

/// Words likewise.
void draw_text(Pen& pen, const Vector2d& at, double height, double unit, std::string_view text) {
  pen.text(at, height, 5 * unit, text, white);
  pen.text(at, height, 2 * unit, text, ink);
}

void draw_letter(Pen& pen, const Arrow& arrow, double unit, std::string_view letter) {
  const Vector2d d = arrow.to - arrow.from;
  if (d.norm() < 6 * unit) return;
  const Vector2d at = arrow.to + 11 * unit * d.normalized() + Vector2d(-4 * unit, 4 * unit);
  draw_text(pen, at, 12 * unit, unit, letter);
}

/// What nothing hides of the curve and of the dots, in red on white.
void draw_marks(Rendering& rendering, const Scene& scene, const Camera& camera, double unit) {
  Pen pen(rendering.image);
  std::vector<Vector2d> pixels;  // two per visible piece
  for (std::size_t k = 0; k + 1 < scene.curve.size(); ++k) {
    if (std::binary_search(scene.curve_pieces.begin(), scene.curve_pieces.end(), static_cast<Index>(k + 1))) continue;
    const Vector3d a = camera.to_scene(scene.curve[k]), b = camera.to_scene(scene.curve[k + 1]);
    const int pieces = 1 + static_cast<int>(std::min((b - a).norm() / mark_tolerance, 200.0));
    for (int p = 0; p < pieces; ++p) {
      const Vector3d from = a + p * (b - a) / pieces, to = a + (p + 1) * (b - a) / pieces;
      if (!rendering.shows(camera, (from + to) / 2, mark_tolerance)) continue;
      for (const Vector3d& end : {from, to})
        pixels.push_back(camera.to_pixels(end, rendering.image.width, rendering.image.height).head<2>());
    }
  }
  for (const auto& [width, colour] : {std::pair{8 * unit, white}, std::pair{5 * unit, red}})
    for (std::size_t k = 0; k < pixels.size(); k += 2) pen.line(pixels[k], pixels[k + 1], width, colour);
  for (const Vec3& dot : scene.dots) {
    const Vector3d place = camera.to_scene(dot);
    if (!rendering.shows(camera, place, mark_tolerance)) continue;
    const Vector2d pixel = camera.to_pixels(place, rendering.image.width, rendering.image.height).head<2>();
    pen.disc(pixel, 8 * unit, white);
    pen.disc(pixel, 6 * unit, red);
  }
}

void draw_source(Image& image, const Scene& scene, const Camera& camera, double unit) {
  const Vector3d source = camera.to_scene(scene.source);
  if (camera.to_view(source).z() > -camera.near_plane) return;  // behind the camera
  const Vector3d centre = camera.to_pixels(source, image.width, image.height);
  Pen pen(image);
  std::vector<Arrow> arrows;
  if (scene.source_axes) {
    const double length = 70 * unit / centre.z();
    for (std::size_t k = 0; k < 2; ++k) {
      const Vector3d tip = source + length * as_vector((*scene.source_axes)[k]).normalized();
      arrows.push_back({centre.head<2>(), camera.to_pixels(tip, image.width, image.height).head<2>(), 3 * unit});
    }
    draw_arrows(pen, arrows, unit);
    for (std::size_t k = 0; k < 2; ++k) draw_letter(pen, arrows[k], unit, k == 0 ? "u" : "v");
  }
  pen.disc(centre.head<2>(), 10.5 * unit, white);
  pen.disc(centre.head<2>(), 8 * unit, red);
}

/// The width of one ring below the legend's wheel: |--| 0.05
void draw_scale(Pen& pen, const Legend& legend, double ring_width, double unit) {
  const double ring = legend.radius / legend.rings, y = legend.y + legend.radius + 16 * unit;
  const double left = legend.x - legend.radius, right = left + ring, tick = 5 * unit;
  for (const auto& [width, colour] : {std::pair{5 * unit, white}, std::pair{2 * unit, ink}}) {
    pen.line({left, y}, {right, y}, width, colour);
    for (const double x : {left, right}) pen.line({x, y - tick}, {x, y + tick}, width, colour);
  }
  draw_text(pen, {right + 9 * unit, y + 6.5 * unit}, 13 * unit, unit, shortest(ring_width));
}

void draw_legend_axes(Pen& pen, const Legend& legend, double unit) {
  const Vector2d centre(legend.x, legend.y);
  const double length = 0.72 * legend.radius;
  const Arrow u{centre, centre + Vector2d(length, 0), 2 * unit}, v{centre, centre + Vector2d(0, -length), 2 * unit};
  draw_arrows(pen, {u, v}, unit);
  draw_text(pen, u.to + Vector2d(0.28 * legend.radius + 12 * unit, 4 * unit), 12 * unit, unit, "u");
  draw_text(pen, v.to + Vector2d(-4 * unit, -0.28 * legend.radius - 12 * unit), 12 * unit, unit, "v");
  pen.disc(centre, 4 * unit, white);
  pen.disc(centre, 3 * unit, red);
}

}  // namespace

bool can_write_png() noexcept { return true; }

void write_png(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options) {
  check(scene, options);
  const std::vector<Index> shown = shown_points(scene);
  const Camera camera = choose_camera(scene, shown, options);
  const Paint paint = make_paint(scene, shown, options);
  const bool is_mapped = std::any_of(shown.begin(), shown.end(), [&](Index i) { return has_coordinate(scene, i); });

  const double unit = std::min(options.width, options.height) / 1200.0;  // marks keep their share of the picture
  Legend legend;
  if (is_mapped && unit > 0.25 && options.pattern != Pattern::cells) {
    legend.radius = 68 * unit;
    legend.x = legend.radius + 36 * unit;
    legend.y = options.height - legend.radius - 60 * unit;
    legend.rings = 4;
  }
  Rendering rendering = render(make_drawable(scene, shown, camera, paint), camera, paint.ring_width, options, legend);
  Image& image = rendering.image;
  Pen pen(image);
  if (legend.radius > 0) {
    draw_scale(pen, legend, paint.ring_width, unit);
    draw_legend_axes(pen, legend, unit);
  }
  draw_marks(rendering, scene, camera, std::max(unit, 0.35));
  // Of a curve or of many sources only what can be seen; a single source is what the picture is about.
  const bool is_single = scene.curve.empty() && scene.dots.empty();
  if (is_single || rendering.shows(camera, camera.to_scene(scene.source), mark_tolerance))
    draw_source(image, scene, camera, std::max(unit, 0.35));

  io::write_png(path, image);
}

}  // namespace ahm::view

#else

namespace ahm::view {

bool can_write_png() noexcept { return false; }

void write_png(const std::filesystem::path& path, const Scene&, const PictureOptions&) {
  throw Error(
      "cannot write " + path.string() +
      ": this build of libahm has no PNG pictures; install OSMesa and stb (Debian: libosmesa6-dev, libstb-dev) and "
      "configure again");
}

}  // namespace ahm::view

#endif
