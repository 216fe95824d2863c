#include "render.hpp"

#include <cmath>
#include <memory>

#include "ahm/util/parallel.hpp"
#include "layer.hpp"
#include "tile.hpp"

namespace ahm::view {

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

}  // namespace ahm::view
