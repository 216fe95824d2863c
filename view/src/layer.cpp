#include "layer.hpp"

namespace ahm::view {
namespace {

using Eigen::Vector3f;

/// Adds the vertex where the edge from a (before the near plane) to b (behind it) meets the plane.
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

/// Cuts off what lies behind the near plane.
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

}  // namespace ahm::view
