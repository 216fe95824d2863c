#include "film.hpp"

#include <array>

#include "ahm/util/mutex.hpp"
#include "ahm/util/parallel.hpp"

namespace ahm::render {
namespace {

struct Step {
  int x, y;
  float length;
};

/// Offsets of eight pixels on a circle.
std::array<Step, 8> circle(float radius, float turn) {
  std::array<Step, 8> steps;
  for (std::size_t k = 0; k < 8; ++k) {
    const float angle = 0.785398F * (static_cast<float>(k) + turn);
    steps[k] = {static_cast<int>(std::lround(radius * std::cos(angle))),
                static_cast<int>(std::lround(radius * std::sin(angle))), radius};
  }
  return steps;
}

/// Darkening of crevices by Boucheny's eye-dome lighting, with two radii.
class Crevices {
 public:
  Crevices(const Film& film, float focal)
      : film_(film), focal_(focal), fine_(circle(detail(), 0)), coarse_(circle(3 * detail(), 0.5F)) {}

  float light(int x, int y) const {
    const float nearness = film_.at(x, y).nearness;
    if (!(nearness > 0)) return 1;
    float sum = 0;
    for (const auto* steps : {&fine_, &coarse_})
      for (const Step& step : *steps) {
        const int column = std::clamp(x + step.x, 0, film_.width - 1),
                  row = std::clamp(y + step.y, 0, film_.height - 1);
        const float other = film_.at(column, row).nearness;
        // (depth - other depth) in pixels at this depth, divided by the distance in pixels
        if (other > nearness) sum += std::clamp((1 - nearness / other) * focal_ / step.length - 1, 0.0F, 4.0F);
      }
    return sum > 0 ? std::exp(-0.05F * sum) : 1;
  }

 private:
  float detail() const { return std::max(1.0F, static_cast<float>(film_.height) / 800); }

  const Film& film_;
  float focal_;
  std::array<Step, 8> fine_, coarse_;
};

}  // namespace

void fill_pinholes(Film& film, float gap, unsigned threads) {
  const std::array<Step, 8> steps = circle(1.5F, 0);
  std::vector<std::pair<std::size_t, Pixel>> filled;
  detail::Mutex mutex;
  detail::parallel_chunks(film.height, 16, threads, [&](Offset begin, Offset end) {
    std::vector<std::pair<std::size_t, Pixel>> found;
    for (int y = static_cast<int>(begin); y < end; ++y)
      for (int x = 0; x < film.width; ++x) {
        const Pixel& here = film.at(x, y);
        int nearer = 0;
        const Pixel* other = nullptr;
        for (const Step& step : steps) {
          if (x + step.x < 0 || x + step.x >= film.width || y + step.y < 0 || y + step.y >= film.height) continue;
          const Pixel& around = film.at(x + step.x, y + step.y);
          if (around.coverage < 65535) continue;
          if (here.nearness > 0 && 1 / here.nearness - 1 / around.nearness < gap && here.coverage == 65535) continue;
          ++nearer;
          other = &around;
        }
        if (nearer >= 7) found.emplace_back(&here - film.pixels.data(), *other);
      }
    const detail::Lock lock(mutex);
    filled.insert(filled.end(), found.begin(), found.end());
  });
  for (const auto& [place, pixel] : filled) film.pixels[place] = pixel;  // any order, because each pixel occurs once
}

Image develop(const Film& film, float focal, bool darken, unsigned threads) {
  Image image(film.width, film.height);
  const Crevices crevices(film, focal);
  detail::parallel_chunks(film.height, 16, threads, [&](Offset begin, Offset end) {
    for (int y = static_cast<int>(begin); y < end; ++y)
      for (int x = 0; x < film.width; ++x) {
        const Pixel& pixel = film.at(x, y);
        std::uint8_t* out = image.pixel(x, y);
        const float left = darken ? crevices.light(x, y) : 1;
        for (std::size_t c = 0; c < 3; ++c)
          out[c] = glsl::to_srgb_byte(static_cast<std::uint16_t>(
              std::lround(left * static_cast<float>(pixel.light[c])) + 65535 - pixel.coverage));
        out[3] = 255;
      }
  });
  return image;
}

namespace {

using Eigen::Vector3f;

/// Adds the intersection of the near plane with the edge from a (in front of the plane) to b (behind it).
std::uint32_t add_on_plane(Drawable& d, std::uint32_t a, std::uint32_t b, float t) {
  const auto between = [&](auto& array) { array.push_back(array[a] + t * (array[b] - array[a])); };
  between(d.positions), between(d.normals), between(d.values), between(d.known);
  return static_cast<std::uint32_t>(d.positions.size() - 1);
}

std::vector<Vector3f> project(const Drawable& drawable, const Lens& lens) {
  std::vector<Vector3f> pixels;
  if (!drawable.is_mesh()) return pixels;
  pixels.reserve(drawable.positions.size());
  for (const Vector3f& position : drawable.positions) {
    const Vector3f view = lens.to_view(position);
    pixels.push_back(-view.z() < lens.near_plane * 0.999F ? Vector3f(0, 0, 0) : lens.to_pixels(view));
  }
  return pixels;
}

/// Removes the parts of triangles behind the near plane.
Drawable clipped(Drawable d, const Lens& lens) {
  std::vector<std::uint32_t> kept;
  const auto depth = [&](std::uint32_t vertex) { return -lens.to_view(d.positions[vertex]).z(); };
  for (std::size_t t = 0; t < d.triangles.size(); t += 3) {
    std::vector<std::uint32_t> polygon;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = d.triangles[t + k], b = d.triangles[t + (k + 1) % 3];
      const float from = depth(a) - lens.near_plane, to = depth(b) - lens.near_plane;
      if (from >= 0) polygon.push_back(a);
      if (from >= 0 && to < 0) polygon.push_back(add_on_plane(d, a, b, from / (from - to)));
      if (from < 0 && to >= 0) polygon.push_back(add_on_plane(d, b, a, to / (to - from)));
    }
    for (std::size_t k = 2; k < polygon.size(); ++k) kept.insert(kept.end(), {polygon[0], polygon[k - 1], polygon[k]});
  }
  d.triangles = std::move(kept);
  return d;
}

bool reaches_behind(const Drawable& drawable, const Lens& lens) {
  return std::any_of(drawable.positions.begin(), drawable.positions.end(),
                     [&](const Vector3f& x) { return -lens.to_view(x).z() < lens.near_plane; });
}

}  // namespace

Layer::Layer(Drawable drawable, const Material& material, const Lens& lens, const Tiles& tiles)
    : drawable_(drawable.is_mesh() && reaches_behind(drawable, lens) ? clipped(std::move(drawable), lens)
                                                                     : std::move(drawable)),
      material_(material),
      pixels_(project(drawable_, lens)),
      bins_(tiles, drawable_.primitives(),
            [&](std::size_t primitive, Box& box) { return box_of(primitive, lens, box); }) {}

bool Layer::box_of(std::size_t primitive, const Lens& lens, Box& box) const {
  if (!drawable_.is_mesh()) {
    const Vector3f view = lens.to_view(drawable_.positions[primitive]);
    if (-view.z() < lens.near_plane) return false;
    const Vector3f p = lens.to_pixels(view);
    const float r = lens.focal * p.z() * drawn_radius(drawable_.radii[primitive], p.z(), lens);
    box = {p.x() - r, p.y() - r, p.x() + r, p.y() + r};
    return true;
  }
  const std::uint32_t* corner = &drawable_.triangles[3 * primitive];
  const Vector3f &a = pixels_[corner[0]], &b = pixels_[corner[1]], &c = pixels_[corner[2]];
  if (!(a.z() > 0 && b.z() > 0 && c.z() > 0)) return false;
  box = {std::min({a.x(), b.x(), c.x()}), std::min({a.y(), b.y(), c.y()}), std::max({a.x(), b.x(), c.x()}),
         std::max({a.y(), b.y(), c.y()})};
  return true;
}

}  // namespace ahm::render
