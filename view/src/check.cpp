#include "check.hpp"

#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::view {
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
    require(scene.face_vertices.empty(), "scene.face_vertices: given without scene.face_begin");
    return;
  }
  const auto corners = static_cast<Offset>(scene.face_vertices.size());
  require(
      scene.face_begin.front() == 0 && scene.face_begin.back() == corners,
      "scene.face_begin: must start with 0 and end with the size of scene.face_vertices, " + std::to_string(corners));
  for (std::size_t f = 1; f < scene.face_begin.size(); ++f)
    require(scene.face_begin[f - 1] <= scene.face_begin[f],
            "scene.face_begin[" + std::to_string(f) + "]: smaller than the entry before it");
  for (std::size_t k = 0; k < scene.face_vertices.size(); ++k) {
    const Index vertex = scene.face_vertices[k];
    require(vertex >= 0 && static_cast<std::size_t>(vertex) < scene.points.size(),
            "scene.face_vertices[" + std::to_string(k) + "] = " + std::to_string(vertex) + ": there are " +
                std::to_string(scene.points.size()) + " points");
  }
}

void check_size(std::size_t size, std::size_t points, const char* name) {
  require(size == points, std::string("scene.") + name + ": " + std::to_string(size) + " entries for " +
                              std::to_string(points) + " points; give one per point");
}

/// What the pattern is painted by; the rest may be there or not, but for labels, which only cells have.
void check_map(const Scene& scene, Pattern pattern) {
  const auto optional = [&](std::size_t size, const char* name) {
    if (size > 0) check_size(size, scene.points.size(), name);
  };
  const bool cells = pattern == Pattern::cells, coordinates = pattern == Pattern::polar || pattern == Pattern::grid;
  if (coordinates || !scene.u.empty() || !scene.v.empty()) {
    check_size(scene.u.size(), scene.points.size(), "u");
    check_size(scene.v.size(), scene.points.size(), "v");
  }
  require(!cells || scene.u.empty(), "scene.u: given for cells, which are painted by labels");
  require(cells || scene.labels.empty(), "scene.labels: given for another pattern than cells");
  if (cells) check_size(scene.labels.size(), scene.points.size(), "labels");
  const bool needs_distance = cells || (pattern == Pattern::distance && scene.u.empty());
  needs_distance ? check_size(scene.distance.size(), scene.points.size(), "distance")
                 : optional(scene.distance.size(), "distance");
  optional(scene.quality.size(), "quality");
  optional(scene.normals.size(), "normals");
  optional(scene.colors.size(), "colors");
  optional(scene.told.distance.size(), "told.distance");
  optional(scene.told.spread.size(), "told.spread");
  optional(scene.told.status.size(), "told.status");
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

}  // namespace ahm::view
