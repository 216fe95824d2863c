// The functions of palette.glsl. All colors are linear RGB.
#pragma once

#include <cstdint>

#include "glsl.hpp"

namespace ahm::render::glsl {

vec3 map_color(int pattern, vec2 uv, vec2 dx, vec2 dy, float sectors, float rings);
vec3 distance_color(float t);
vec3 plain_color();
vec3 unknown_color();
vec3 low_quality_color(vec3 color, vec2 pixel, float pixel_size);
vec3 bounded_color(vec3 color, vec2 pixel, float pixel_size);
vec3 matte(vec3 color, vec3 normal);
vec3 lit(vec3 color, vec3 normal, vec3 to_eye);

/// Conversion from sRGB to linear light, and from linear light in 65535ths to sRGB.
float from_srgb(float tone);
std::uint8_t to_srgb_byte(std::uint16_t light);

}  // namespace ahm::render::glsl
