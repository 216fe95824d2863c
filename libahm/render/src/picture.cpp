#include "picture.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "ahm/error.hpp"
#include "ahm/io/formats.hpp"
#include "ahm/io/image.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "annotations.hpp"
#include "tile.hpp"

namespace ahm::render {
namespace {

void require(bool condition, const std::string& message) {
  if (!condition) throw InvalidArgument(message);
}

void check_direction(const std::optional<Vec3>& direction, const char* name) {
  if (!direction) return;
  const Vec3& d = *direction;
  require(is_finite(d) && std::hypot(d[0], d[1], d[2]) > 0,
          std::string(name) + ": must be finite and not zero; leave it empty for a default");
}

void check_faces(const Scene& scene) {
  if (scene.face_begin.empty()) {
    require(scene.face_vertices.empty(), "scene.face_vertices: must be empty if scene.face_begin is empty");
    return;
  }
  const auto corners = static_cast<Offset>(scene.face_vertices.size());
  require(
      scene.face_begin.front() == 0 && scene.face_begin.back() == corners,
      "scene.face_begin: must start with 0 and end with the size of scene.face_vertices, " + std::to_string(corners));
  // Messages for errors only: these loops run for every map of the viewer.
  for (std::size_t f = 1; f < scene.face_begin.size(); ++f)
    if (scene.face_begin[f - 1] > scene.face_begin[f])
      throw InvalidArgument("scene.face_begin[" + std::to_string(f) + "]: smaller than the entry before it");
  for (std::size_t k = 0; k < scene.face_vertices.size(); ++k) {
    const Index vertex = scene.face_vertices[k];
    if (vertex < 0 || static_cast<std::size_t>(vertex) >= scene.points.size())
      throw InvalidArgument("scene.face_vertices[" + std::to_string(k) + "] = " + std::to_string(vertex) +
                            ": there are " + detail::counted(scene.points.size(), "point"));
  }
}

void check_size(std::size_t size, std::size_t points, const char* name) {
  require(size == points, std::string("scene.") + name + ": " + detail::counted(size, "entry") + " for " +
                              detail::counted(points, "point") + "; give one per point");
}

/// Checks the lengths of the arrays. The pattern determines which are required; only cells have labels; others are optional.
void check_map(const Scene& scene, Pattern pattern) {
  const auto optional = [&](std::size_t size, const char* name) {
    if (size > 0) check_size(size, scene.points.size(), name);
  };
  const bool cells = pattern == Pattern::cells, coordinates = pattern == Pattern::polar || pattern == Pattern::grid;
  if (coordinates || !scene.u.empty() || !scene.v.empty()) {
    check_size(scene.u.size(), scene.points.size(), "u");
    check_size(scene.v.size(), scene.points.size(), "v");
  }
  require(!cells || scene.u.empty(), "scene.u: must be empty for cells, which have labels");
  require(cells || scene.labels.empty(), "scene.labels: must be empty unless the pattern is cells");
  if (cells) check_size(scene.labels.size(), scene.points.size(), "labels");
  const bool needs_distance = cells || (pattern == Pattern::distance && scene.u.empty());
  needs_distance ? check_size(scene.distance.size(), scene.points.size(), "distance")
                 : optional(scene.distance.size(), "distance");
  optional(scene.quality.size(), "quality");
  optional(scene.bounded.size(), "bounded");
  optional(scene.normals.size(), "normals");
  optional(scene.colors.size(), "colors");
  optional(scene.details.distance.size(), "details.distance");
  optional(scene.details.spread.size(), "details.spread");
  optional(scene.details.status.size(), "details.status");
}

}  // namespace

void check_picture(const PictureOptions& options) {
  for (const auto& [size, name] : {std::pair{options.width, "width"}, std::pair{options.height, "height"}})
    require(size >= 16 && size <= 8192,
            std::string("options.") + name + " = " + std::to_string(size) + ": must be between 16 and 8192 pixels");
  check_direction(options.view_direction, "options.view_direction");
  check_direction(options.up, "options.up");
}

void check(const Scene& scene, const PictureOptions& options) {
  check_map(scene, options.pattern);
  check_faces(scene);
  require(is_finite(scene.source), "scene.source: must be finite");
  for (const Vec3& dot : scene.dots) require(is_finite(dot), "scene.dots: must be finite");
  for (const Vec3& point : scene.curve) require(is_finite(point), "scene.curve: must be finite");
  Index least = 1;
  for (Index piece : scene.curve_pieces) {
    require(piece >= least && static_cast<std::size_t>(piece) < scene.curve.size(),
            "scene.curve_pieces: must ascend, between 1 and the number of points of the curve");
    least = piece + 1;
  }
  if (scene.source_axes)
    for (const Vec3& axis : *scene.source_axes) require(is_finite(axis), "scene.source_axes: must be finite");

  check_picture(options);
  require(options.sectors > 0 && options.sectors % 2 == 0 && options.sectors <= 720,
          "options.sectors = " + std::to_string(options.sectors) + ": must be even, and between 2 and 720");
  if (options.ring_width)
    require(std::isfinite(*options.ring_width) && *options.ring_width > 0,
            "options.ring_width = " + std::to_string(*options.ring_width) + ": must be finite and positive");
}

Film render(std::vector<Painted> things, const Camera& camera, const PictureOptions& options) {
  constexpr int factor = TileRenderer::factor;
  const Lens lens(camera, factor * options.width, factor * options.height);
  const Tiles tiles(factor * options.width, factor * options.height);
  float gap = 0;
  std::vector<Layer> layers;
  for (Painted& thing : things) {
    if (!thing.drawable.is_mesh()) gap = std::max(gap, 4 * typical_spacing(thing.drawable));
    layers.emplace_back(std::move(thing.drawable), thing.material, lens, tiles);
  }
  Film film(options.width, options.height);
  detail::parallel_chunks(tiles.count(), 16, options.threads, [&](Offset begin, Offset end) {
    const auto renderer = std::make_unique<TileRenderer>(layers, lens, tiles);
    for (Offset tile = begin; tile < end; ++tile) renderer->draw(static_cast<int>(tile), film);
  });
  if (gap > 0) fill_pinholes(film, gap, options.threads);
  return film;
}

Image develop(const Film& film, const PictureOptions& options, bool darken) {
  const double focal = 0.5 * options.height / std::tan(Camera::field_of_view / 2);
  return develop(film, static_cast<float>(focal), darken, options.threads);
}

bool shows(const Film& film, const Camera& camera, const Eigen::Vector3d& position, double tolerance) {
  const double depth = -camera.to_view(position).z();
  if (depth < camera.near_plane) return false;
  const Eigen::Vector3d pixel = camera.to_pixels(position, film.width, film.height);
  const int x = static_cast<int>(std::floor(pixel.x())), y = static_cast<int>(std::floor(pixel.y()));
  if (x < 0 || y < 0 || x >= film.width || y >= film.height) return false;
  const double nearness = film.at(x, y).nearness;
  return nearness * (depth - tolerance) < 1;
}

void write_picture(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options) {
  const std::string extension = io::lower_extension(path);
  if (extension == ".png") return write_png(path, scene, options);
  if (extension == ".html" || extension == ".htm") return write_html(path, scene, options);
  throw InvalidArgument("path: " + path.string() + " must end with .png or .html");
}

bool can_write_png() noexcept { return io::has_images(); }

Image draw_picture(const Scene& scene, const PictureOptions& options) {
  check(scene, options);
  const std::vector<Index> shown = shown_points(scene);
  const Camera camera = choose_camera(scene, shown, options);
  Material material;
  double ring_width = 1, spacing = 0;
  bool is_mapped = false;
  std::vector<Painted> things;
  {
    const Paint paint = make_paint(scene, shown, options);
    ring_width = paint.ring_width;
    is_mapped = std::any_of(paint.known.begin(), paint.known.end(), [](float known) { return known > 0; });
    material = {.pattern = options.pattern,
                .sectors = static_cast<float>(options.sectors),
                .rings = static_cast<float>(paint.rings),
                .pixel_size = 1200.0F / static_cast<float>(std::min(options.width, options.height))};
    things.push_back({make_drawable(scene, shown, camera, paint, options.threads), material});
    spacing = typical_spacing(things.front().drawable);
  }
  const Film film = render(std::move(things), camera, options);
  Image image = develop(film, options);
  if (is_mapped) draw_legend(image, material, ring_width);
  draw_marks(image, film, scene, camera, spacing);
  return image;
}

void write_png(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options) {
  io::write_png(path, draw_picture(scene, options));
}

}  // namespace ahm::render
