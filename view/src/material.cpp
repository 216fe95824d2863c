#include "material.hpp"

#include "ahm/maps/quality.hpp"

namespace ahm::view {
namespace {

using glsl::vec2;
using glsl::vec3;

vec3 map_color(const Material& material, const Fragment& f) {
  const vec2 uv(f.value.x, f.value.y);
  if (!f.known) return material.pattern == Pattern::none ? glsl::plain_color() : glsl::unknown_color();
  const vec3 color =
      glsl::map_color(static_cast<int>(material.pattern), uv, f.dx, f.dy, material.sectors, material.rings);
  if (material.pattern == Pattern::none || !(f.value.z < static_cast<float>(trusted_quality))) return color;
  return glsl::untrusted_color(color, f.pixel * material.pixel_size, material.pixel_size);
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
  const bool glossy = material.kind == Material::Kind::pattern;  // images keep their hues
  return glsl::clamp(glossy ? glsl::lit(color, f.normal, vec3(0, 0, 1)) : glsl::matte(color, f.normal), 0, 1);
}

}  // namespace ahm::view
