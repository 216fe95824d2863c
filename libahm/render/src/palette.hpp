// The colors of palette.glsl. All are linear RGB.
#pragma once

#include <cstdint>

#include "glsl.hpp"

namespace ahm::render::glsl {

vec3 map_color(int pattern, vec2 uv, vec2 dx, vec2 dy, float sectors, float rings);
vec3 distance_color(float t);
vec3 plain_color();
vec3 unknown_color();
vec3 untrusted_color(vec3 color, vec2 pixel, float pixel_size);
vec3 matte(vec3 color, vec3 normal);
vec3 lit(vec3 color, vec3 normal, vec3 to_eye);

/// Light of a number of an sRGB picture, and the number of a light in 65535ths.
float from_srgb(float tone);
std::uint8_t to_srgb_byte(std::uint16_t light);

}  // namespace ahm::render::glsl
