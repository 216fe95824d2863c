#include "material.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ahm/maps/quality.hpp"

namespace ahm::render {
namespace {

using glsl::vec2;
using glsl::vec3;

vec3 map_color(const Material& material, const Fragment& f) {
  const vec2 uv(f.value.x, f.value.y);
  if (!f.known) return material.pattern == Pattern::none ? glsl::plain_color() : glsl::unknown_color();
  const vec3 color =
      glsl::map_color(static_cast<int>(material.pattern), uv, f.dx, f.dy, material.sectors, material.rings);
  if (material.pattern == Pattern::none) return color;
  const vec2 pixel = f.pixel * material.pixel_size;
  if (f.value.z < static_cast<float>(reliable_quality))
    return glsl::low_quality_color(color, pixel, material.pixel_size);
  return f.value.z > 0.5F * (1 + bounded_mark) ? glsl::bounded_color(color, pixel, material.pixel_size) : color;
}

}  // namespace

vec3 shade(const Material& material, Fragment& f) {
  vec3 color = f.value;
  if (material.kind == Material::Kind::pattern) color = map_color(material, f);
  if (material.kind == Material::Kind::texture) {
    const auto [red, green, blue, opacity] = material.image->sample(f.value.x, f.value.y);
    color = {glsl::from_srgb(static_cast<float>(red)), glsl::from_srgb(static_cast<float>(green)),
             glsl::from_srgb(static_cast<float>(blue))};
    f.opacity = material.transparent ? static_cast<float>(opacity) : 1;
  }
  const bool glossy = material.kind == Material::Kind::pattern;  // textures have no highlights
  return glsl::clamp(glossy ? glsl::lit(color, f.normal, vec3(0, 0, 1)) : glsl::matte(color, f.normal), 0, 1);
}

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t colors = 12;  // number of colors of `cell_color` in palette.glsl

struct Cell {
  Index label;
  Vector3d middle;
};

/// The cells in the order of their labels, each with the mean of its points.
std::vector<Cell> cells_of(const Scene& scene, const std::vector<Index>& shown) {
  std::vector<Index> order;
  for (const Index i : shown)
    if (has_coordinate(scene, i)) order.push_back(i);
  const auto label = [&](Index i) { return scene.labels[i]; };
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return label(a) < label(b); });
  std::vector<Cell> cells;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    Vector3d sum = Vector3d::Zero();
    for (; end < order.size() && label(order[end]) == label(order[begin]); ++end)
      sum += as_vector(scene.points[order[end]]);
    cells.push_back({label(order[begin]), sum / static_cast<double>(end - begin)});
  }
  return cells;
}

/// The color of each cell: the one with the most distant cells among those before.
std::vector<double> colors_of(const std::vector<Cell>& cells) {
  std::vector<double> result;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::array<double, colors> nearest;
    nearest.fill(std::numeric_limits<double>::infinity());
    for (std::size_t other = 0; other < c; ++other) {
      double& distance = nearest[result[other]];
      distance = std::min(distance, (cells[other].middle - cells[c].middle).stableNorm());
    }
    result.push_back(static_cast<double>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin()));
  }
  return result;
}

/// Largest distance of a point from the source, world units.
double largest_distance(const Scene& scene, const std::vector<Index>& shown) {
  double largest = 0;
  for (const Index i : shown)
    if (has_coordinate(scene, i)) largest = std::max(largest, distance_at(scene, i));
  return largest;
}

}  // namespace

Paint make_paint(const Scene& scene, const std::vector<Index>& shown, const PictureOptions& options) {
  const std::size_t n = scene.points.size();
  Paint paint{options.pattern,
              choose_ring_width(scene, shown, options),
              0,
              std::vector<Vector2d>(n, Vector2d::Zero()),
              std::vector<float>(n, 0),
              std::vector<float>(n, 1)};
  if (options.pattern == Pattern::none) return paint;
  if (options.pattern == Pattern::distance) paint.rings = largest_distance(scene, shown) / paint.ring_width;
  const bool is_cells = options.pattern == Pattern::cells;
  const std::vector<Cell> cells = is_cells ? cells_of(scene, shown) : std::vector<Cell>();
  const std::vector<double> color = colors_of(cells);
  for (const Index point : shown) {
    if (!has_coordinate(scene, point)) continue;
    const auto i = static_cast<std::size_t>(point);
    paint.known[i] = 1;
    if (!scene.quality.empty() && std::isfinite(scene.quality[i]))
      paint.quality[i] = static_cast<float>(scene.quality[i]);
    if (!scene.bounded.empty() && scene.bounded[i] == 1 && !(paint.quality[i] < static_cast<float>(reliable_quality)))
      paint.quality[i] = bounded_mark;
    if (options.pattern == Pattern::distance) {
      paint.uv[i] = {distance_at(scene, point) / paint.ring_width, 0};
    } else if (is_cells) {
      const auto cell = std::lower_bound(cells.begin(), cells.end(), scene.labels[i],
                                         [](const Cell& c, Index label) { return c.label < label; });
      paint.uv[i] = {color[cell - cells.begin()], scene.distance[i] / paint.ring_width};
    } else {
      paint.uv[i] = Vector2d(scene.u[i], scene.v[i]) / paint.ring_width;
    }
  }
  return paint;
}

}  // namespace ahm::render
