#include <algorithm>

#include "ahm/io/image.hpp"
#include "ahm/view/picture.hpp"
#include "check.hpp"
#include "legend.hpp"
#include "marks.hpp"
#include "render.hpp"

namespace ahm::view {

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

}  // namespace ahm::view
